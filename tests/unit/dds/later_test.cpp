// A later version of the types, with one additional member each: both versions read each other's samples. Cyclone DDS is used directly,
// because the bus knows only the present types.
#include <dds/dds.h>
#include <gtest/gtest.h>

#include "gateway/doors/dds/door.hpp"
#include "tests/unit/http/fake_gateway.hpp"

#define axisgate_GatewayState later_GatewayState
#define axisgate_AxisState later_AxisState
#define axisgate_Event later_Event
#define axisgate_AxisCommand later_AxisCommand
#define axisgate_CommandResult later_CommandResult
#define axisgate_ParameterWrite later_ParameterWrite
#define axisgate_SetPoint later_SetPoint
#define axisgate_GatewayState_desc later_GatewayState_desc
#define axisgate_AxisState_desc later_AxisState_desc
#define axisgate_Event_desc later_Event_desc
#define axisgate_AxisCommand_desc later_AxisCommand_desc
#define axisgate_CommandResult_desc later_CommandResult_desc
#define axisgate_ParameterWrite_desc later_ParameterWrite_desc
#define axisgate_SetPoint_desc later_SetPoint_desc
#include "later.h"
#include "tests/unit/dds/own_domain.hpp"
#undef axisgate_GatewayState
#undef axisgate_AxisState
#undef axisgate_Event
#undef axisgate_AxisCommand
#undef axisgate_CommandResult
#undef axisgate_ParameterWrite
#undef axisgate_SetPoint
#undef axisgate_GatewayState_desc
#undef axisgate_AxisState_desc
#undef axisgate_Event_desc
#undef axisgate_AxisCommand_desc
#undef axisgate_CommandResult_desc
#undef axisgate_ParameterWrite_desc
#undef axisgate_SetPoint_desc

namespace axisgate::dds {
namespace {
using LaterGateway = http::test::FakeGateway;

TEST(LaterTypes, AreReadAndRead) {
    boost::asio::io_context context{1};
    LaterGateway gateway;
    gateway.set_picture("feeder", http::test::standing(6400));
    Instant now = at_ns(1'000'000'000);
    DoorSettings settings;
    settings.bus.domain = test::own_domain(1);
    settings.name = "hall";
    settings.instance = 7;
    DdsDoor door(
        context, gateway.ports(), [&now] { return now; }, std::move(settings));
    ASSERT_EQ(door.start(), "");

    const dds_entity_t participant = dds_create_participant(test::own_domain(1), nullptr, nullptr);
    ASSERT_GT(participant, 0);
    dds_qos_t* plant = dds_create_qos();
    dds_qset_partition1(plant, "plant");
    const dds_entity_t publisher = dds_create_publisher(participant, plant, nullptr),
                       subscriber = dds_create_subscriber(participant, plant, nullptr);
    dds_delete_qos(plant);
    dds_qos_t* reliable = dds_create_qos();
    dds_qset_reliability(reliable, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    const auto topic = [&](const dds_topic_descriptor_t& type, const char* name) {
        return dds_create_topic(participant, &type, name, reliable, nullptr);
    };
    const dds_entity_t writer = dds_create_writer(publisher, topic(later_AxisCommand_desc, "axisgate_AxisCommand"), reliable, nullptr);
    const dds_entity_t reader = dds_create_reader(subscriber, topic(later_AxisState_desc, "axisgate_AxisState"), reliable, nullptr);
    dds_delete_qos(reliable);
    ASSERT_GT(writer, 0);
    ASSERT_GT(reader, 0);

    later_AxisCommand c{};
    put_text(c.gateway, "hall");
    put_text(c.axis, "feeder");
    put_text(c.source, "later");
    put_text(c.id, "1");
    put_text(c.command, "move_absolute");
    double position = 2;
    c.position = &position;
    c.of_a_later_version = 4711;
    std::int64_t seen = 0, unknown = -1;
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while ((gateway.submitted.empty() || seen == 0) && std::chrono::steady_clock::now() < limit) {
        (void)dds_write(writer, &c);  // the same command: it is carried out once
        now += DdsDoor::turn;
        (void)context.run_for(DdsDoor::turn);
        context.restart();
        void* samples[1] = {};
        dds_sample_info_t info;
        if (dds_take(reader, samples, &info, 1, 1) == 1) {
            const auto& s = *static_cast<const later_AxisState*>(samples[0]);
            if (info.valid_data && std::string_view(s.axis) == "feeder") seen = s.position, unknown = s.of_a_later_version;
            (void)dds_return_loan(reader, samples, 1);
        }
    }
    EXPECT_EQ(seen, 6400);
    EXPECT_EQ(unknown, 0) << "what an earlier version does not have";
    ASSERT_EQ(gateway.submitted.size(), 1u);
    EXPECT_EQ(std::get<Move>(gateway.submitted[0].body).target, 6400);
    (void)dds_delete(participant);
    bool stopped = false;
    door.stop([&stopped] { stopped = true; });
    (void)context.run_for(std::chrono::seconds(1));
    EXPECT_TRUE(stopped);
}

}  // namespace
}  // namespace axisgate::dds
