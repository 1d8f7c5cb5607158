// Recorded commands as steps of a recipe: commands of any door, jogs, parameter writes, simulated conditions, and commands that cannot be a
// step. read_recipe accepts the result.
#include <gtest/gtest.h>

#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "gateway/services/recipes/recipe_read.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
using namespace std::chrono_literals;
constexpr std::int64_t zero_ms = 1'767'323'045'000;  // the instant 0 of the fake clock

class RecordedSteps : public HttpTest {
protected:
    struct Tap final : FlightTap {
        FlightLog* log = nullptr;
        void take(const FlightRecord& r) override { log->add(r); }
        void take_site(std::shared_ptr<const SiteInput>, Instant) override {}
    } tap;
    Ticket last = 0;
    void SetUp() override { tap.log = &gateway.stretch; }
    AxisId feeder() { return gateway.axis("feeder"); }
    static Origin by(const char* who, Door door = http::clients) { return {door, std::make_shared<const std::string>(who)}; }
    Ticket give(CommandBody body, Duration at, const Origin& origin = by("anna")) {
        Command c;
        c.ticket = ++last;
        c.axis = feeder();
        c.body = std::move(body);
        c.origin = origin;
        tap.command(c, Instant(at));
        return c.ticket;
    }
    void moving(bool on, Duration at) {
        AxisPicture p;
        p.current = p.ever_seen = true;
        p.at = Instant(at);
        p.flags = on ? flag_moving : std::uint16_t{0};
        tap.picture(feeder(), p, Instant(at));
    }
    boost::json::object steps(Duration to, const std::string& more = "&axes=feeder") {
        const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(to).count();
        const auto a = call("GET", "/api/v1/recorder/steps?from=" + std::to_string(zero_ms) + "&to=" + std::to_string(zero_ms + ms) + more);
        EXPECT_EQ(a.status, 200u) << a.text;
        auto o = a.object();
        if (!o.at("steps").as_array().empty()) {
            std::vector<SiteFault> faults;
            EXPECT_TRUE(read_recipe({{"steps", o.at("steps")}}, nullptr, faults)) << a.text << (faults.empty() ? "" : faults[0].text);
        }
        return o;
    }
    static std::string text(const boost::json::object& o, const char* key = "steps") { return boost::json::serialize(o.at(key)); }
    static Move absolute(std::int64_t target) {
        Move m;
        m.target = target;
        m.velocity = 64000;
        return m;
    }
};

TEST_F(RecordedSteps, WhatWasDoneBecomesStepsThatWaitForWhatWasWaitedFor) {
    give(Enable{}, 1s);
    give(absolute(32000), 2s);
    moving(true, 2100ms);
    moving(false, 4s);
    give(absolute(0), 5s);
    moving(true, 5100ms);
    give(Halt{}, 6s);
    moving(false, 6100ms);
    EXPECT_EQ(text(steps(8s)), R"([{"enable":{"axis":"feeder"}},)"
                               R"({"command":{"axis":"feeder","command":"move_absolute","position":10,"velocity":20,"wait_s":10}},)"
                               R"({"command":{"axis":"feeder","command":"move_absolute","position":0,"velocity":20}},{"wait_s":1},)"
                               R"({"command":{"axis":"feeder","command":"halt"}}])");
}

TEST_F(RecordedSteps, AJogIsOneMoveForAsLongAsItWasHeld) {
    Move jog;
    jog.kind = Move::Kind::velocity;
    jog.target = -16000;
    jog.hold_ms = 500;
    give(jog, 1s);
    jog.renew_only = true;
    for (int i = 1; i < 10; ++i)
        give(jog, 1s + i * 200ms);
    give(Halt{}, 3s);
    EXPECT_EQ(text(steps(4s)), R"([{"command":{"axis":"feeder","command":"move_velocity","velocity":-5}},{"wait_s":2},)"
                               R"({"command":{"axis":"feeder","command":"halt"}}])");
    jog.renew_only = false;
    give(jog, 10s);  // and it is not renewed: it expires
    const auto o = steps(20s);
    const auto& all = o.at("steps").as_array();
    ASSERT_EQ(all.size(), 6u) << text(o);
    EXPECT_EQ(boost::json::serialize(all[4]), R"({"wait_s":5E-1})");
    EXPECT_EQ(boost::json::serialize(all[5]), R"({"command":{"axis":"feeder","command":"halt"}})");
}

TEST_F(RecordedSteps, PanelsParametersAndRehearsalsAreSteps) {
    ProcessData d;
    d.target_position = 6400;
    d.controlword = 0x1F;
    give(d, 1s, by("192.0.2.7", modbus::clients));
    give(d, 2s, by("192.0.2.7", modbus::clients));  // the repetition has no effect
    const auto point = gateway.site()->site.axes.empty() ? std::nullopt : find_axis(gateway, "feeder")->catalogue->find("AC");
    ASSERT_TRUE(point);
    give(WriteParameter{*point, Value{std::int64_t{20000}}}, 3s);
    const auto drive = gateway.site()->drive_ids.at(0);
    tap.hand(drive, {{"stall", Value{true}}}, by("anna"), Instant(4s));
    tap.hand(drive, {{"stall", Value{false}}}, by("anna"), Instant(7s));
    const auto all = text(steps(9s));
    EXPECT_NE(all.find(R"({"write_register":{"unit":1,"address":34,"value":6400},"comment":"modbus 192.0.2.7"})"), std::string::npos)
        << all;
    EXPECT_NE(all.find(R"("address":32,"value":31)"), std::string::npos) << all;
    EXPECT_EQ(all.find(R"("address":34)"), all.rfind(R"("address":34)")) << all;
    EXPECT_NE(all.find(R"({"set_parameter":{"axis":"feeder","parameter":"AC","value":20000}})"), std::string::npos) << all;
    EXPECT_NE(all.find(R"({"simulate":{"axis":"feeder","input":"stall","value":true}},{"wait_s":3},)"
                       R"({"simulate":{"axis":"feeder","input":"stall","value":false}})"),
              std::string::npos)
        << all;
}

TEST_F(RecordedSteps, WhatIsNoStepIsNamedAndWhatWasNotByHandIsNone) {
    Result no;
    no.ticket = give(absolute(1), 1s);
    no.axis = feeder();
    no.outcome = Outcome::refused;
    no.text = "not enabled";
    tap.result(no, Instant(1001ms));
    give(Native{}, 2s);
    give(ReadParameter{}, 2s);
    give(Enable{}, 3s, by("recipe warm-up by anna"));
    give(Halt{}, 4s, by("", Door::internal));
    const auto o = steps(5s);
    EXPECT_EQ(text(o), "[]");
    EXPECT_EQ(text(o, "left_out"),
              R"(["feeder: move_absolute was refused: not enabled","feeder: a message in the drive's own language has no step"])");
    for (int i = 0; i < 600; ++i)
        give(Enable{}, 6s + i * 1ms);
    EXPECT_EQ(steps(9s).at("steps").as_array().size(), most_recipe_steps);
    EXPECT_EQ(call("GET", "/api/v1/recorder/steps?axes=nobody").status, 404u);
    EXPECT_EQ(call("GET", "/api/v1/recorder/steps?from=x").status, 400u);
    for (const auto* times : {"from=0&to=9223372036854", "from=9223372036854&to=9223372036854", "from=9223372036854&to=0"})
        EXPECT_EQ(call("GET", std::string("/api/v1/recorder/steps?axes=feeder&") + times).status, 200u) << times;
    EXPECT_EQ(call("GET", "/api/v1/recorder/steps?to=9223372036855").status, 400u) << "no time has that many milliseconds";
}

}  // namespace
}  // namespace axisgate::http::test
