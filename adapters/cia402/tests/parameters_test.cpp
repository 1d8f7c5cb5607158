// A drive with a manufacturer's description: the catalogue that is made from the file, the twin that is built from it, and the check of the
// drive's identity.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "adapters/cia402/parameters.hpp"
#include "adapters/cia402/tests/line_bench.hpp"

namespace axisgate::cia402_drive {
namespace {
using test::page;
DescriptionText file(const std::string& name) {
    std::ifstream in(AXISGATE_SOURCE_DIR "/adapters/cia402/tests/eds/" + name, std::ios::binary);
    return {name, {std::istreambuf_iterator<char>(in), {}}};
}
std::shared_ptr<const Catalogue> made(const DescriptionText& d) {
    const auto own = own_catalogue({page(), {}, &d});
    EXPECT_EQ(own.fault, "");
    return own.catalogue;
}
const Parameter* find(const Catalogue& c, std::string_view id) {
    const auto point = c.find(id);
    return point ? c.parameter(*point) : nullptr;
}

TEST(Described, WithoutADescriptionThePageIsTheDrives) {
    EXPECT_EQ(own_catalogue({page(), {}}).catalogue, nullptr);
    EXPECT_EQ(own_catalogue({page(), {}}).fault, "");
    EXPECT_FALSE(description_of(page()));
    EXPECT_EQ(expected_identity(page()).description, "");
}

TEST(Described, TheFileHasTheLastWordOnWhatThePageKnows) {
    const auto c = made(file("plain.eds"));
    ASSERT_TRUE(c);
    const auto* velocity = find(*c, "profile_velocity");
    ASSERT_TRUE(velocity);
    EXPECT_EQ(velocity->id, "6081h");
    EXPECT_EQ(velocity->min, 1);
    EXPECT_EQ(velocity->max, 250'000);
    EXPECT_EQ(velocity->factory_default, Value{std::int64_t{20'000}});
    EXPECT_EQ(velocity->unit, find(page(), "6081h")->unit) << "a file says no unit";
    const auto* polarity = find(page(), "6072h");
    ASSERT_TRUE(polarity);
    EXPECT_EQ(find(*c, "6072h"), nullptr) << "this drive has no such object";
    const auto* word = find(*c, "6040h");
    ASSERT_TRUE(word);
    EXPECT_FALSE(word->writable()) << "commands write it, whatever the file allows";
    EXPECT_EQ(find(*c, "60E3h:01[3]"), nullptr);
    EXPECT_TRUE(c->find("60E3h:01[2]")) << "as many elements as the file has";
    EXPECT_EQ(std::vector<std::int16_t>(c->modes().begin(), c->modes().end()), (std::vector<std::int16_t>{1, 3, 6, 8}));
}

TEST(Described, WhatThePageDoesNotKnowIsThereByTheFilesWords) {
    const auto c = made(file("plain.eds"));
    ASSERT_TRUE(c);
    const auto* gain = find(*c, "velocity_loop_gain_proportional");
    ASSERT_TRUE(gain);
    EXPECT_EQ(gain->id, "2010h:01");
    EXPECT_EQ(gain->type, ValueType::u16);
    EXPECT_EQ(gain->min, 1);
    EXPECT_EQ(gain->max, 5000);
    EXPECT_EQ(gain->factory_default, Value{std::int64_t{350}});
    EXPECT_EQ(gain->access, Access::read_write);
    EXPECT_EQ(c->check_write(*c->find("2010h:01"), Value{std::int64_t{5001}}).fault.empty(), false);
    const auto* temperature = find(*c, "2020h");
    ASSERT_TRUE(temperature);
    EXPECT_EQ(temperature->access, Access::read);
    EXPECT_EQ(find(*c, "2010h:00"), nullptr) << "the number of its subindices";
    const auto* mapping = find(*c, "1A00h:01");
    ASSERT_TRUE(mapping);
    EXPECT_FALSE(mapping->writable()) << "the gateway maps the PDOs";
    EXPECT_EQ(find(*c, "2030h"), nullptr) << "a domain is no value";
    EXPECT_EQ(find(*c, "2040h")->type, ValueType::bytes);
}

TEST(Described, TwoObjectsOfOneNameAreTold) {
    const auto c = made(file("compact.eds"));
    ASSERT_TRUE(c);
    EXPECT_TRUE(c->find("table_point1"));
    EXPECT_TRUE(c->find("2100h:20"));
    EXPECT_TRUE(find(*c, "2100h:20")->live) << "mapped to a PDO and written: a set-point";
    EXPECT_NE(find(*c, "2101h")->name, find(*c, "2102h")->name);
    EXPECT_THAT(find(*c, "2101h")->description, testing::HasSubstr("Drehmoment für Lauf"));
}

TEST(Described, ADcfsValuesAreBesideTheDefaults) {
    const auto c = made(file("by_tool.dcf"));
    ASSERT_TRUE(c);
    const std::string values = boost::json::serialize(c->document().at("configured"));
    EXPECT_THAT(values, testing::HasSubstr(R"({"parameter":"6083h","value":7000})"));
    EXPECT_THAT(values, testing::Not(testing::HasSubstr("1014h"))) << "the gateway sets it, and it hangs on the node number";
    EXPECT_FALSE(made(file("plain.eds"))->document().contains("configured"));
    EXPECT_FALSE(known(find(*c, "1014h")->factory_default)) << "it hangs on the node number";
}

TEST(Described, TheFileComesBackWhole) {
    for (const auto* name : {"plain.eds", "compact.eds", "by_tool.dcf"}) {
        const auto text = file(name);
        const auto eds = description_of(*made(text));
        ASSERT_TRUE(eds) << name;
        std::vector<canopen::FileFault> faults, notes;
        EXPECT_EQ(*eds, *canopen::read_eds(text.text, faults, notes)) << name;
    }
}

TEST(Described, AFileThatCannotBeReadIsAFaultOfTheSite) {
    const DescriptionText bad{"bad.eds", "[DeviceInfo]\nVendorName=x\n"};
    EXPECT_THAT(own_catalogue({page(), {}, &bad}).fault, testing::HasSubstr("bad.eds, line 0: no object is described"));
}

TEST(Described, AnOddRowIsReadAsFarAsItGoes) {
    DescriptionText odd = file("plain.eds");
    const auto at = odd.text.find("AccessType=const");
    ASSERT_NE(at, std::string::npos);
    odd.text.replace(at, 16, "AccessType=maybe");
    const auto own = own_catalogue({page(), {}, &odd});
    EXPECT_EQ(own.fault, "");
    EXPECT_EQ(own.catalogue->parameters().size(), made(file("plain.eds"))->parameters().size());
}

TEST(Described, TheIdentityOfAnotherDriveIsTold) {
    const auto expected = expected_identity(*made(file("plain.eds")));
    EXPECT_EQ(expected.description, "plain.eds");
    EXPECT_EQ(differs(expected, {0x1AB, 0x2001, 0x00030000}), "");
    EXPECT_EQ(differs(expected, {0x1AB, 0x2001, 0x00030007}), "") << "a lower revision of the same behaviour";
    EXPECT_EQ(differs(expected, {0x1AB, std::nullopt, std::nullopt}), "") << "it does not say";
    const auto text = differs(expected, {0x1AB, 0x2002, 0x00040000});
    EXPECT_THAT(text, testing::HasSubstr("product 2002h, not 2001h, revision 40000h, not 30000h"));
    EXPECT_EQ(differs({}, {1, 2, 3}), "");
}

}  // namespace
}  // namespace axisgate::cia402_drive
