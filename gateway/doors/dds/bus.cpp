// Bus: entities of Cyclone DDS, made and unmade. Configuration is built here: CYCLONEDDS_URI of the environment is not looked at.
// In: settings, samples. Out: samples, faults as text. Never waits for longer than a millisecond.
#include "gateway/doors/dds/bus.hpp"

#include <dds/dds.h>
#include <fmt/core.h>

#include <algorithm>
#include <memory>

namespace axisgate::dds {
namespace {
struct QosDelete {
    void operator()(dds_qos_t* q) const { dds_delete_qos(q); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDelete>;

struct Shape {
    const dds_topic_descriptor_t* type;
    const char* name;
};
const Shape& shape_of(Topic t) {
    static const std::array<Shape, topic_count> shapes{Shape{&axisgate_GatewayState_desc, "axisgate_GatewayState"},
                                                       Shape{&axisgate_AxisState_desc, "axisgate_AxisState"},
                                                       Shape{&axisgate_Event_desc, "axisgate_Event"},
                                                       Shape{&axisgate_AxisCommand_desc, "axisgate_AxisCommand"},
                                                       Shape{&axisgate_CommandResult_desc, "axisgate_CommandResult"},
                                                       Shape{&axisgate_ParameterWrite_desc, "axisgate_ParameterWrite"},
                                                       Shape{&axisgate_SetPoint_desc, "axisgate_SetPoint"}};
    return shapes.at(static_cast<std::size_t>(t));
}

/// The table of docs/handbook/fleet.md. Reliable writers give up after a millisecond: no reader holds the service thread.
Qos qos_of(Topic t) {
    Qos q(dds_create_qos());
    constexpr dds_duration_t patience = DDS_MSECS(1);
    const auto bounds = [&q](std::int32_t samples, std::int32_t instances, std::int32_t each) {
        dds_qset_resource_limits(q.get(), samples, instances, each);
    };
    dds_qset_writer_data_lifecycle(q.get(), true);
    switch (t) {
        case Topic::gateway_state:
        case Topic::axis_state:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_durability(q.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 1);
            dds_qset_deadline(q.get(), DDS_MSECS(lease_ms));
            dds_qset_liveliness(q.get(), DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(lease_ms));
            dds_qset_durability_service(q.get(), 0, DDS_HISTORY_KEEP_LAST, 1, 16384, 16384, 1);
            bounds(16384, 16384, 1);
            break;
        case Topic::event:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_durability(q.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 256);
            dds_qset_durability_service(q.get(), 0, DDS_HISTORY_KEEP_LAST, 256, 16384, 256, 256);
            bounds(16384, 256, 256);
            break;
        case Topic::axis_command:
        case Topic::parameter_write:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_ALL, 0);
            dds_qset_lifespan(q.get(), DDS_SECS(2));
            bounds(1024, 1024, 64);
            break;
        case Topic::command_result:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 64);
            bounds(65536, 16384, 64);
            break;
        case Topic::set_point:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 1);
            dds_qset_ownership(q.get(), DDS_OWNERSHIP_EXCLUSIVE);
            bounds(16384, 16384, 1);
            break;
    }
    return q;
}

std::string xml_text(const std::string& s) {
    std::string out;
    for (const char c : s) {
        if (c == '&') {
            out += "&amp;";
        } else if (c == '<') {
            out += "&lt;";
        } else if (c == '"') {
            out += "&quot;";
        } else {
            out += c;
        }
    }
    return out;
}

/// On the loopback interface participants find each other by their ports: it has no multicast that other machines would not see.
std::string configuration(const BusSettings& s) {
    const bool here = s.interface_name == "lo";
    return fmt::format(
        "<Domain><General><Interfaces><NetworkInterface name=\"{}\" multicast=\"{}\"/></Interfaces><AllowMulticast>{}</AllowMulticast>"
        "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>"
        "<LeaseDuration>{}ms</LeaseDuration>{}</Discovery></Domain>",
        xml_text(s.interface_name), here ? "false" : "default", here ? "false" : "default", here ? 99 : 9, lease_ms,
        here ? "<Peers><Peer Address=\"127.0.0.1\"/></Peers>" : "");
}

void on_data_available(dds_entity_t, void* bus) { static_cast<const Bus*>(bus)->on_data(); }

std::string failed(const char* what, dds_return_t code) { return fmt::format("DDS: {}: {}", what, dds_strretcode(code)); }
}  // namespace

std::string Bus::open(const BusSettings& s, std::initializer_list<Topic> writes, std::initializer_list<Topic> reads) {
    close();
    domain_ = dds_create_domain(s.domain, configuration(s).c_str());
    if (domain_ == DDS_RETCODE_PRECONDITION_NOT_MET) domain_ = 0;  // this process is in it already
    if (domain_ < 0) {
        const auto code = domain_;
        domain_ = 0;
        return failed(fmt::format("domain {} on the interface {} cannot be joined", s.domain, s.interface_name).c_str(), code) +
               "; check [dds] interface (`ip link` lists them)";
    }
    participant_ = dds_create_participant(s.domain, nullptr, nullptr);
    if (participant_ < 0) {
        const auto code = participant_;
        close();
        return failed(fmt::format("domain {} on the interface {} cannot be joined", s.domain, s.interface_name).c_str(), code) +
               "; check [dds] interface (`ip link` lists them), and whether too many programs of this machine are in the domain";
    }
    const Qos group(dds_create_qos());
    dds_qset_partition1(group.get(), s.partition.c_str());
    publisher_ = dds_create_publisher(participant_, group.get(), nullptr);
    subscriber_ = dds_create_subscriber(participant_, group.get(), nullptr);
    if (publisher_ < 0 || subscriber_ < 0) {
        const auto code = std::min(publisher_, subscriber_);
        close();
        return failed("a partition cannot be opened", code);
    }
    for (std::size_t i = 0; i < topic_count; ++i) {
        const Topic t{static_cast<std::uint8_t>(i)};
        const auto among = [t](std::initializer_list<Topic> list) { return std::find(list.begin(), list.end(), t) != list.end(); };
        if (std::string fault = add(t, s, among(writes), among(reads)); !fault.empty()) {
            close();
            return fault;
        }
    }
    return {};
}

std::string Bus::add(Topic t, const BusSettings& s, bool writes, bool reads) {
    if (!writes && !reads) return {};
    const auto i = static_cast<std::size_t>(t);
    const Qos q = qos_of(t);
    const dds_entity_t topic = dds_create_topic(participant_, shape_of(t).type, shape_of(t).name, q.get(), nullptr);
    if (topic < 0)
        return failed(shape_of(t).name, topic) + fmt::format("; in domain {} somebody may use the name for another type", s.domain);
    if (writes) {
        writers_[i] = dds_create_writer(publisher_, topic, q.get(), nullptr);
        if (writers_[i] < 0) return failed(shape_of(t).name, writers_[i]);
    }
    if (reads) {
        dds_qset_ignorelocal(q.get(), DDS_IGNORELOCAL_PARTICIPANT);
        dds_listener_t* listener = dds_create_listener(this);
        dds_lset_data_available(listener, &on_data_available);
        readers_[i] = dds_create_reader(subscriber_, topic, q.get(), listener);
        dds_delete_listener(listener);
        if (readers_[i] < 0) return failed(shape_of(t).name, readers_[i]);
    }
    return {};
}

void Bus::close() {
    if (participant_ > 0) (void)dds_delete(participant_);  // and all that hangs on it; no listener runs after it
    if (domain_ > 0) (void)dds_delete(domain_);
    domain_ = participant_ = publisher_ = subscriber_ = 0;
    writers_.fill(0);
    readers_.fill(0);
}

bool Bus::write_raw(Topic t, const void* sample, bool ended) {
    const dds_entity_t writer = writers_[static_cast<std::size_t>(t)];
    if (writer <= 0) return false;
    return (ended ? dds_dispose(writer, sample) : dds_write(writer, sample)) == DDS_RETCODE_OK;
}

std::size_t Bus::take_raw(Topic t, std::size_t most, const std::function<void(const void*, const Seen&)>& each) {
    constexpr std::size_t batch = 64;
    const dds_entity_t reader = readers_[static_cast<std::size_t>(t)];
    if (reader <= 0) return 0;
    void* samples[batch] = {};
    dds_sample_info_t infos[batch];
    const auto got = dds_take(reader, samples, infos, batch, static_cast<std::uint32_t>(std::min(most, batch)));
    if (got <= 0) return 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i)
        each(samples[i], {infos[i].valid_data, infos[i].instance_state == DDS_IST_ALIVE, infos[i].publication_handle});
    (void)dds_return_loan(reader, samples, got);
    return static_cast<std::size_t>(got);
}

}  // namespace axisgate::dds
