// Tests of the lease of one axis, in virtual time, with two clients.
#include "gateway/axis/authority.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {
using std::chrono::seconds;
const Instant t0 = Instant{} + seconds(1000);
const AuthorityClient panel{http::clients, "192.0.2.1 panel"}, plc{modbus::clients, "192.0.2.7"};

TEST(Authority, ClientIsItsStableNameElseItsPeerWithoutThePort) {
    const auto who = std::make_shared<const std::string>("[fd00::1]:5123");
    EXPECT_EQ(AuthorityClient::of({modbus::clients, who, {}}).name, "[fd00::1]");
    EXPECT_EQ(AuthorityClient::of({http::clients, who, std::make_shared<const std::string>("anna")}).name, "anna");
    EXPECT_EQ(AuthorityClient::of({http::clients, who, std::make_shared<const std::string>(std::string(200, 'x'))}).name.size(),
              AxisAuthority::name_most);
}

TEST(Authority, OthersAreRefusedByNameUntilTheLeaseEnds) {
    AxisAuthority a;
    EXPECT_TRUE(a.take(panel, seconds(30), false, t0).allowed);
    for (const int s : {0, 10, 29}) {
        const auto v = a.command(plc, AuthorityMode::free, seconds(30), t0 + seconds(s));
        EXPECT_FALSE(v.allowed);
        EXPECT_NE(v.text.find("http 192.0.2.1 panel"), std::string::npos) << v.text;
        EXPECT_FALSE(a.take(plc, seconds(30), false, t0 + seconds(s)).allowed);
        EXPECT_FALSE(a.release(plc, t0 + seconds(s)).allowed);
    }
    EXPECT_EQ(a.door(), http::clients);
    EXPECT_TRUE(a.command(plc, AuthorityMode::free, seconds(30), t0 + seconds(30)).allowed);
    EXPECT_EQ(a.expire(t0 + seconds(30)).change, AxisAuthority::Change::expired);
    EXPECT_EQ(a.door(), modbus::clients) << "free: who commanded last";
}

TEST(Authority, ModeLeaseTakesAndRenewsWithEachCommandAndNeverShortens) {
    AxisAuthority a;
    EXPECT_EQ(a.command(plc, AuthorityMode::lease, seconds(30), t0).change, AxisAuthority::Change::taken);
    EXPECT_EQ(a.command(plc, AuthorityMode::lease, seconds(30), t0 + seconds(20)).change, AxisAuthority::Change::none);
    EXPECT_FALSE(a.may(panel, t0 + seconds(49)).allowed);
    EXPECT_TRUE(a.may(panel, t0 + seconds(50)).allowed);
    EXPECT_TRUE(a.take(plc, seconds(3600), false, t0 + seconds(21)).allowed);
    (void)a.command(plc, AuthorityMode::lease, seconds(30), t0 + seconds(22));
    EXPECT_FALSE(a.may(panel, t0 + seconds(3000)).allowed);
}

TEST(Authority, TheDoorIsNoneAgainWhenTheHoldersLeaseHasEnded) {
    for (const bool released : {true, false}) {
        AxisAuthority a;
        EXPECT_EQ(a.door(), Door::none);
        (void)a.take(plc, seconds(30), false, t0);
        (void)a.command(plc, AuthorityMode::free, seconds(30), t0);
        EXPECT_EQ(a.door(), modbus::clients);
        if (released)
            (void)a.release(plc, t0 + seconds(1));
        else
            (void)a.expire(t0 + seconds(30));
        EXPECT_EQ(a.door(), Door::none);
        EXPECT_EQ(a.commander(), plc) << "who commanded last is still known";
        (void)a.take(panel, seconds(30), false, t0 + seconds(31));
        EXPECT_EQ(a.door(), http::clients);
        EXPECT_TRUE(a.release(panel, t0 + seconds(32)).allowed);
        EXPECT_EQ(a.door(), Door::none);
        EXPECT_EQ(a.command(plc, AuthorityMode::free, seconds(30), t0 + seconds(33)).change, AxisAuthority::Change::none);
        EXPECT_EQ(a.door(), modbus::clients);
    }
}

TEST(Authority, TakenOverHandedOverReleased) {
    AxisAuthority a;
    (void)a.take(plc, seconds(30), false, t0);
    EXPECT_EQ(a.take(panel, seconds(30), true, t0).change, AxisAuthority::Change::taken_over);
    EXPECT_FALSE(a.hand_over(plc, "http x", seconds(30), t0).allowed);
    EXPECT_FALSE(a.hand_over(panel, "", seconds(30), t0).allowed);
    EXPECT_TRUE(a.hand_over(panel, "modbus 192.0.2.7", seconds(30), t0).allowed);
    EXPECT_EQ(a.holder(), plc);
    EXPECT_EQ(a.release(plc, t0).change, AxisAuthority::Change::released);
    EXPECT_FALSE(a.held(t0));
}

TEST(Authority, HandedOverToAUserIsWhicheverClientOfHimComesFirst) {
    const AuthorityClient olga{http::clients, "olga page-1"}, second{http::clients, "olga page-2"}, other{http::clients, "olgas page-1"};
    AxisAuthority a;
    (void)a.take(panel, seconds(30), false, t0);
    ASSERT_TRUE(a.hand_over(panel, "http olga", seconds(30), t0).allowed);
    EXPECT_FALSE(a.may(panel, t0).allowed) << "given is given";
    EXPECT_FALSE(a.may(other, t0).allowed) << "another user whose name begins so";
    EXPECT_FALSE(a.may({modbus::clients, "olga page-1"}, t0).allowed);
    EXPECT_TRUE(a.may(olga, t0).allowed);
    EXPECT_TRUE(a.may(second, t0).allowed);
    EXPECT_TRUE(a.command(olga, AuthorityMode::free, seconds(30), t0).allowed);
    EXPECT_EQ(a.holder(), olga) << "from then on it is this client";
    EXPECT_FALSE(a.may(second, t0).allowed);
    EXPECT_FALSE(a.may({http::clients, "olga page-1 copy"}, t0).allowed) << "another client, whose name begins with that of the holder";
    EXPECT_FALSE(a.may(panel, t0 + seconds(29)).allowed);
    EXPECT_TRUE(a.may(panel, t0 + seconds(30)).allowed) << "its time is that of the hand-over: a command in free mode does not renew it";
    // A lease that was taken, not handed over, belongs to this client only.
    AxisAuthority b;
    (void)b.take({http::clients, "olga"}, seconds(30), false, t0);
    EXPECT_FALSE(b.may(olga, t0).allowed);
    // Taking and releasing count as use, too.
    for (const bool take : {false, true}) {
        AxisAuthority c;
        (void)c.take(panel, seconds(30), false, t0);
        (void)c.hand_over(panel, "olga", seconds(30), t0);
        if (take) {
            EXPECT_EQ(c.take(second, seconds(60), false, t0).change, AxisAuthority::Change::renewed);
            EXPECT_EQ(c.holder(), second);
            EXPECT_FALSE(c.may(olga, t0).allowed);
        } else {
            EXPECT_EQ(c.release(olga, t0).change, AxisAuthority::Change::released);
        }
    }
}
}  // namespace
}  // namespace axisgate
