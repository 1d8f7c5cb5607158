// Triggers by level, edge, state and command; the rows before and behind them; bounds. The time is an argument.
#include <gtest/gtest.h>

#include "gateway/axis/image.hpp"
#include "gateway/services/recorder/capture.hpp"
#include "gateway/services/recorder/capture_document.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

const AxisId one{1}, two{2}, other{3};

PictureRecord published(std::int64_t position, std::uint16_t flags = 0, std::int64_t behind = 0) {
    PictureRecord p;
    p.current = true;
    p.position = position;
    p.demand = position + behind;
    p.demand_source = DemandSource::drive;
    p.flags = flags;
    return p;
}

CaptureWish wish(CaptureTrigger t, Duration before = 100ms, Duration after = 300ms) {
    CaptureWish w;
    w.axes = {one, two};
    w.before = before;
    w.after = after;
    w.trigger = t;
    return w;
}
CaptureTrigger level(CapturePoint point, std::int64_t at, bool rising = true) {
    return {CaptureTrigger::Kind::level, one, point, at, 0, rising};
}
/// 1 kHz from 1 s on: position 10 increments per ms.
void run(Capture& c, int ms, int from = 0) {
    for (int i = from; i < from + ms; ++i) {
        const Instant at(1s + i * 1ms);
        c.on_picture(one, published(i * 10), at);
        c.on_picture(two, published(-i * 10), at + 300us);
        c.on_picture(other, published(7), at);
        c.on_time(at, 0ms);
    }
}

TEST(Capture, ALevelTriggersAtTheInstantBetweenTwoRows) {
    Capture c(wish(level(CapturePoint::position, 5005)), Instant(1s));
    run(c, 400);
    EXPECT_EQ(c.state(), Capture::State::armed);
    EXPECT_LE(c.rows(0).size(), 102u);  // a ring of the time before
    run(c, 600, 400);
    ASSERT_EQ(c.state(), Capture::State::done);
    EXPECT_EQ(*c.triggered_at(), Instant(1s + 500ms + 500us));
    const auto& rows = c.rows(0);
    EXPECT_EQ(rows.front().at, Instant(1s + 400ms));  // the row that is valid at the begin
    EXPECT_EQ(rows.back().at, Instant(1s + 800ms));
    EXPECT_EQ(rows.size(), 401u);
    EXPECT_EQ(c.rows(1).front().position, -4000);
    EXPECT_NEAR(c.rate_hz(0), 1000, 1);
}

TEST(Capture, TheDirectionCounts) {
    Capture rising(wish(level(CapturePoint::position, 100, true)), Instant(1s)),
        falling(wish(level(CapturePoint::position, 100, false)), Instant(1s));
    for (auto* c : {&rising, &falling}) {
        c->on_picture(one, published(200), Instant(1s));  // already above it: no crossing
        c->on_picture(one, published(50), Instant(1s + 1ms));
    }
    EXPECT_EQ(rising.state(), Capture::State::armed);
    EXPECT_EQ(falling.state(), Capture::State::triggered);
    rising.on_picture(one, published(100), Instant(1s + 2ms));
    EXPECT_EQ(rising.state(), Capture::State::triggered);
}

TEST(Capture, OtherPointsStatesAndCommands) {
    Capture error(wish(level(CapturePoint::following_error, 30)), Instant(1s));
    error.on_picture(one, published(0), Instant(1s));
    PictureRecord unknown = published(0, 0, 40);
    unknown.demand_source = DemandSource::none;
    error.on_picture(one, unknown, Instant(1s + 1ms));
    EXPECT_EQ(error.state(), Capture::State::armed) << "nobody knows its demand";
    error.on_picture(one, published(0, 0, 10), Instant(1s + 2ms));
    error.on_picture(one, published(0, 0, 40), Instant(1s + 3ms));
    EXPECT_EQ(error.state(), Capture::State::triggered);

    Capture state(wish({CaptureTrigger::Kind::state, one, {}, 0, capture_state_named("fault"), true}), Instant(1s));
    state.on_picture(two, published(0, flag_fault), Instant(1s));
    state.on_picture(two, published(0), Instant(1s + 1ms));
    state.on_picture(two, published(0, flag_fault), Instant(1s + 2ms));
    state.on_picture(one, published(0, flag_moving), Instant(1s + 2ms));
    EXPECT_EQ(state.state(), Capture::State::armed) << "another axis, another flag";
    state.on_picture(one, published(0, flag_fault), Instant(1s + 3ms));
    EXPECT_EQ(*state.triggered_at(), Instant(1s + 3ms));

    Capture command(wish({CaptureTrigger::Kind::command, one, {}, 0, 0, true}), Instant(1s));
    command.on_command(two, Instant(1s + 1ms));
    EXPECT_EQ(command.state(), Capture::State::armed);
    command.on_command(one, Instant(1s + 5ms));
    command.on_command(one, Instant(1s + 6ms));
    EXPECT_EQ(*command.triggered_at(), Instant(1s + 5ms)) << "the first one";
}

TEST(Capture, ARowStandsWhereTheDriveHasSaidIt) {
    Capture c(wish({}), Instant(1s));
    PictureRecord late = published(1);
    late.age = 4ms;
    c.on_picture(one, late, Instant(1s + 10ms));
    c.on_picture(one, late, Instant(1s + 10ms));  // the same report
    ASSERT_EQ(c.rows(0).size(), 1u);
    EXPECT_EQ(c.rows(0)[0].at, Instant(1s + 6ms));
    PictureRecord old = published(2);
    old.current = false;
    c.on_picture(one, old, Instant(1s + 11ms));
    EXPECT_EQ(c.rows(0).size(), 1u) << "nothing is known of it";
    c.on_picture(one, published(3), Instant(1s + 400ms));
    EXPECT_EQ(c.rows(0).size(), 1u) << "behind its end";
    c.on_time(Instant(1s + 300ms), 100ms);
    EXPECT_EQ(c.state(), Capture::State::triggered) << "records come late";
    c.on_time(Instant(1s + 400ms), 100ms);
    EXPECT_EQ(c.state(), Capture::State::done);
}

TEST(Capture, WaitsNoLongerThanItWasTold) {
    Capture c(wish(level(CapturePoint::position, 1'000'000)), Instant(1s));
    run(c, 1000);
    c.on_time(Instant(60s), 0ms);
    EXPECT_EQ(c.state(), Capture::State::armed);
    c.on_time(Instant(61s), 0ms);
    EXPECT_EQ(c.state(), Capture::State::cancelled);
    EXPECT_EQ(c.why(), "the trigger did not come within 60 s");
    const auto rows = c.rows();
    run(c, 10, 1000);
    EXPECT_EQ(c.rows(), rows) << "over is over";
}

TEST(Capture, IsBounded) {
    auto w = wish({}, 0s, 120s);
    Capture c(w, Instant(1s));
    for (int i = 0; i < 130'000; ++i)
        c.on_picture(one, published(i), Instant(1s + i * 500us));
    EXPECT_EQ(c.state(), Capture::State::done);
    EXPECT_EQ(c.rows(), Capture::most_rows);
    EXPECT_NE(c.why(), "");
    w.trigger = level(CapturePoint::position, -1);
    w.before = 120s;
    Capture armed(w, Instant(1s));
    for (int i = 0; i < 130'000; ++i)
        armed.on_picture(one, published(i), Instant(1s + i * 500us));
    EXPECT_EQ(armed.state(), Capture::State::armed);
    EXPECT_EQ(armed.rows(), Capture::most_rows);
    EXPECT_EQ(armed.rows(0).back().position, 129'999);
    w.axes = {one, two};
    w.before = 0s, w.period = 1ms;
    EXPECT_EQ(w.rows(), 2u * 120'001);
}

TEST(Capture, ItsDocumentIsInUnitsFromItsTrigger) {
    Capture c(wish(level(CapturePoint::position, 5000), 2ms, 2ms), Instant(1s));
    run(c, 600);
    const CaptureOrder o{"tuned", "anna", c.wish(), {{"feeder", "mm", 100}, {"slide, 2", "mm", 10}}, "can0"};
    const auto s = capture_summary(o, c, 0);
    EXPECT_EQ(s.at("state").as_string(), "done");
    EXPECT_EQ(s.at("trigger").as_object().at("level").as_double(), 50);
    const auto columns = capture_columns(o, c);
    const auto& feeder = columns.at(0).as_object();
    ASSERT_EQ(feeder.at("seconds").as_array().size(), 5u);
    EXPECT_EQ(feeder.at("seconds").as_array().at(0).as_double(), -0.002);
    EXPECT_EQ(feeder.at("position").as_array().at(2).as_double(), 50);
    const std::string csv = capture_csv(columns);
    EXPECT_TRUE(
        csv.starts_with("seconds,axis,unit,position,velocity,demand,following_error,statusword\r\n-0.002,feeder,mm,49.8,0,49.8,0,0\r\n"))
        << csv;
    EXPECT_NE(csv.find(",\"slide, 2\",mm,"), std::string::npos);
    boost::json::array damaged = columns;
    damaged.at(0).as_object().at("position").as_array().pop_back();
    EXPECT_EQ(capture_csv(damaged).find("feeder"), std::string::npos) << "columns of different lengths";
}

}  // namespace
}  // namespace axisgate
