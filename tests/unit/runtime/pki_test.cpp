// The certificate tool makes new files, leaves existing ones and refuses faults. DDS Security is tested with the whole program.
#include "gateway/runtime/pki.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "gateway/runtime/files.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;
constexpr std::int64_t at_s = 1'750'000'000;  // 2025-06-15 15:06:40 UTC

class PkiTest : public ::testing::Test {
protected:
    std::string folder = "/tmp/axisgate-pki-XXXXXX";
    void SetUp() override { ASSERT_NE(::mkdtemp(folder.data()), nullptr); }
    void TearDown() override { fs::remove_all(folder); }
    std::string text_of(const std::string& name) const {
        std::string fault;
        return read_file(folder + "/" + name, fault).value_or("");
    }
    PkiMade make(std::vector<std::string> names, const char* role = "gateway", std::int64_t days = 100) const {
        PkiOptions o;
        o.dir = folder;
        o.names = std::move(names);
        o.role = role;
        o.days = days;
        return make_pki(o, at_s);
    }
};

TEST_F(PkiTest, AnAuthorityIsMadeOnceAndMembersBesideIt) {
    const auto first = make({"hall-1"});
    EXPECT_EQ(first.fault, "");
    EXPECT_TRUE(first.authority);
    const std::string ca = text_of("ca-cert.pem");
    const auto more = make({"hall-2", "panel"});
    EXPECT_EQ(more.fault, "");
    EXPECT_FALSE(more.authority);
    EXPECT_EQ(more.folders, (std::vector<std::string>{folder + "/hall-2", folder + "/panel"}));
    EXPECT_EQ(text_of("ca-cert.pem"), ca);
    EXPECT_EQ(text_of("panel/identity-ca.pem"), ca);
    EXPECT_NE(text_of("hall-1/key.pem"), text_of("hall-2/key.pem"));
    for (const char* secret : {"ca-key.pem", "hall-1/key.pem"})
        EXPECT_EQ(fs::status(folder + "/" + secret).permissions() & (fs::perms::group_all | fs::perms::others_all), fs::perms::none)
            << secret;
    EXPECT_NE(text_of("hall-1/permissions.p7s").find("<not_before>2025-06-13T15:06:40</not_before>"), std::string::npos);
}

TEST_F(PkiTest, WhatIsThereIsLeftAlone) {
    ASSERT_EQ(make({"hall-1"}).fault, "");
    const std::string key = text_of("hall-1/key.pem");
    const auto again = make({"new", "hall-1"});
    EXPECT_NE(again.fault.find("is there already"), std::string::npos) << again.fault;
    EXPECT_EQ(again.folders.size(), 1u) << "what was made before it stays";
    EXPECT_EQ(text_of("hall-1/key.pem"), key);
    EXPECT_FALSE(fs::exists(folder + "/hall-1.new"));
}

TEST_F(PkiTest, NamesThatAreNoneAreRefusedBeforeAnythingIsMade) {
    for (const char* name : {"", "a/b", "..", "a b", "<x>"})
        EXPECT_NE(make({"good", name}).fault, "") << name;
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(PkiTest, AnotherKeyIsNoAuthority) {
    ASSERT_EQ(make({"a"}).fault, "");
    fs::copy_file(folder + "/a/key.pem", folder + "/ca-key.pem", fs::copy_options::overwrite_existing);
    EXPECT_NE(make({"b"}).fault.find("no pair"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder + "/b"));
}

TEST(Permissions, EachRoleMayWhatItNeeds) {
    const auto may = [](const char* role, const std::string& what, const char* topic) {
        const std::string text = permissions_document("x", role, "plant", 0, at_s);
        const auto from = text.find("<" + what + ">");
        const auto found = text.substr(from == std::string::npos ? text.size() : from, text.find("</" + what + ">") - from);
        return found.find(std::string("axisgate_") + topic + "<") != std::string::npos;
    };
    EXPECT_TRUE(may("gateway", "publish", "AxisState") && may("gateway", "publish", "AxisCommand") &&
                may("gateway", "subscribe", "SetPoint"));
    EXPECT_FALSE(may("gateway", "publish", "SetPoint"));
    EXPECT_TRUE(may("commander", "publish", "AxisCommand") && may("commander", "subscribe", "CommandResult"));
    EXPECT_FALSE(may("commander", "publish", "AxisState"));
    EXPECT_TRUE(may("viewer", "subscribe", "AxisState"));
    EXPECT_FALSE(may("viewer", "publish", "AxisCommand"));
    EXPECT_NE(permissions_document("x", "viewer", "north", 0, at_s).find("<partition>north</partition>"), std::string::npos);
}

}  // namespace
}  // namespace axisgate
