// The matrix of loss of command is shown with its defaults, changed axis by axis, and rehearsed into a dated report.
#include <gtest/gtest.h>

#include "gateway/doors/enip/words.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
class FailSafeTest : public HttpTest {
protected:
    static void good(RehearsalCell& cell) {
        cell.motion = "velocity";
        cell.speed = 10;
        cell.taken = FailSafeAction::halt;
        cell.noticed_ms = 0.25;
        cell.reaction_ms = 3;
        cell.standstill_ms = 41.5;
        cell.watched_ms = 141.5;
        cell.travel = 0.3;
        cell.ended_by = "modbus_closed";
        cell.moved_again = false;
    }
};

TEST_F(FailSafeTest, EachCauseIsToldWithItsDefaults) {
    const auto a = call("GET", "/api/v1/fail_safe");
    ASSERT_EQ(a.status, 200);
    const auto& o = a.json.get_object();
    ASSERT_EQ(o.at("causes").get_array().size(), loss_causes().size());
    for (const auto& v : o.at("causes").get_array()) {
        const auto& cause = v.get_object();
        EXPECT_GT(cause.at("description").get_string().size(), 10u);
        const bool ends = cause.at("cause") == boost::json::value("gateway_ends");
        const bool unowned = cause.at("cause") == boost::json::value("motion_unowned");
        EXPECT_EQ(cause.at("default_endless").get_string(), ends || unowned ? "quick_stop" : "halt");
        EXPECT_EQ(cause.at("default_to_a_target").get_string(), ends ? "quick_stop" : "nothing");
    }
    const auto& row = o.at("axes").get_array().at(0).get_object();
    EXPECT_TRUE(row.at("fail_safe").get_object().at("line_lost").is_null());
    EXPECT_EQ(row.at("watchdog_ms_in_force").to_number<int>(), 5000);
}

TEST_F(FailSafeTest, TheDrivesOwnWatchdogIsShownAsItWasAcknowledged) {
    const AxisSpec& spec = gateway.site()->site.axes.at(0);
    const auto shown = [&] {
        const auto a = call("GET", "/api/v1/fail_safe/" + spec.name);
        return a.json.get_object().at("drive_watchdog").get_object();
    };
    EXPECT_TRUE(shown().at("available").as_bool());
    EXPECT_EQ(shown().at("description").as_string(), "Its own.");
    EXPECT_TRUE(shown().at("state").is_null()) << "nothing is known of it yet";
    DriveStatus& drive = gateway.drive_states[gateway.drive(spec.drive)];
    using State = DriveWatchdog::State;
    for (const auto& [state, word] : {std::pair{State::off, "off"}, {State::refused, "refused"}}) {
        drive.watchdog = {state, {}, {}};
        EXPECT_EQ(shown().at("state").as_string(), word);
        EXPECT_TRUE(shown().at("time_ms").is_null());
    }
    drive.watchdog = {State::armed, std::chrono::milliseconds(300), "disable"};
    EXPECT_EQ(shown().at("state").as_string(), "armed");
    EXPECT_EQ(shown().at("time_ms").to_number<int>(), 300);
    EXPECT_EQ(shown().at("action").as_string(), "disable");
}

TEST_F(FailSafeTest, TheLimitsThatTheDriveKeepsAreShownAsItAcknowledgedThem) {
    const AxisSpec spec = gateway.site()->site.axes.at(0);
    const auto shown = [&] { return call("GET", "/api/v1/fail_safe/" + spec.name).json.get_object().at("drive_limits").get_object(); };
    DriveStatus& drive = gateway.drive_states[gateway.drive(spec.drive)];
    using State = DriveLimits::State;
    drive.limits = {State::armed, {}};
    const auto limit = [&](const char* members) {
        const auto a = call("PATCH", "/api/v1/axes/" + spec.name, members);
        ASSERT_EQ(a.status, 200) << json_text(a.json);
    };
    limit(R"({"position_min": null, "position_max": null})");
    EXPECT_TRUE(shown().at("available").as_bool());
    EXPECT_FALSE(shown().at("wanted").as_bool());
    EXPECT_TRUE(shown().at("state").is_null()) << "another axis of the drive is limited, this one is not";
    EXPECT_EQ(shown().at("description").as_string(), "607Dh.");
    limit(R"({"position_max": 20})");
    EXPECT_TRUE(shown().at("wanted").as_bool());
    for (const auto& [state, word] : {std::pair{State::armed, "armed"}, {State::off, "off"}}) {
        drive.limits = {state, "not shown"};
        EXPECT_EQ(shown().at("state").as_string(), word);
        EXPECT_TRUE(shown().at("refusal").is_null());
    }
    drive.limits = {State::refused, "607Dh:02: no such object"};
    EXPECT_EQ(shown().at("state").as_string(), "refused");
    EXPECT_EQ(shown().at("refusal").as_string(), "607Dh:02: no such object");
    drive.limits = {};
    EXPECT_TRUE(shown().at("state").is_null()) << "nothing is known of it yet";
}

TEST_F(FailSafeTest, OneAxisIsChangedAsAWhole) {
    const std::string axis(gateway.site()->site.axes.at(0).name);
    const std::string path = "/api/v1/fail_safe/" + axis;
    auto a = call("PUT", path, R"({"modbus_closed": "quick_stop", "line_lost": "disable", "watchdog_ms": 250, "enip_idle": null})");
    ASSERT_EQ(a.status, 200) << json_text(a.json);
    EXPECT_EQ(gateway.site()->site.axes.at(0).fail_safe.of(LossCause::line_lost), FailSafeAction::disable);
    EXPECT_EQ(a.json.get_object().at("watchdog_ms_in_force").to_number<int>(), 250);
    a = call("PUT", path, R"({"enip_idle": "halt"})");
    ASSERT_EQ(a.status, 200) << json_text(a.json);
    const FailSafe& now = gateway.site()->site.axes.at(0).fail_safe;
    EXPECT_FALSE(now.of(LossCause::line_lost)) << "what is not named is the default again";
    EXPECT_EQ(now.of(enip::loss_idle), FailSafeAction::halt);
    EXPECT_EQ(call("GET", path).json.get_object().at("fail_safe").get_object().at("enip_idle"), boost::json::value("halt"));
}

TEST_F(FailSafeTest, WhatIsWrongIsSaidWithItsPlace) {
    const std::string axis(gateway.site()->site.axes.at(0).name);
    auto a = call("PUT", "/api/v1/fail_safe/" + axis, R"({"modbus_closed": "explode"})");
    EXPECT_EQ(a.status, 422);
    EXPECT_EQ(a.fault().at("pointer").get_string(), "/modbus_closed");
    a = call("PUT", "/api/v1/fail_safe/" + axis, R"({"the_dog_ate_it": "halt"})");
    EXPECT_EQ(a.status, 422);
    EXPECT_EQ(call("PUT", "/api/v1/fail_safe/nobody", R"({})").status, 404);
    EXPECT_EQ(call("GET", "/api/v1/fail_safe/nobody").status, 404);
}

TEST_F(FailSafeTest, ARehearsalBecomesADatedReport) {
    EXPECT_EQ(call("GET", "/api/v1/fail_safe/rehearsal").at("state"), "none");
    auto a = call("POST", "/api/v1/fail_safe/rehearsal", "{}");
    ASSERT_EQ(a.status, 202) << json_text(a.json);
    EXPECT_EQ(a.at("state"), "running");
    EXPECT_EQ(call("POST", "/api/v1/fail_safe/rehearsal", "{}").status, 409) << "one at a time";
    gateway.give_all(good);
    a = call("GET", "/api/v1/fail_safe/rehearsal");
    ASSERT_EQ(a.at("state"), "done");
    const auto& report = a.json.get_object().at("report").get_object();
    EXPECT_EQ(report.at("cells").get_array().size(), gateway.site()->site.axes.size() * (loss_causes().size() + 1))
        << "without set-points, with the gateway gone, and with another one after it";
    EXPECT_EQ(report.at("steps").get_array().size(), rehearsal_steps.size()) << "all of them where none is named";
    EXPECT_EQ(report.at("without_set_points").get_array().size(), gateway.site()->site.axes.size()) << "these drives follow none";
    EXPECT_EQ(report.at("without_figures").to_number<int>(), 0);
    const auto& cell = report.at("cells").get_array().at(0).get_object();
    EXPECT_EQ(cell.at("standstill_ms").to_number<double>(), 41.5);
    EXPECT_EQ(cell.at("ended_by").get_string(), "modbus_closed");
    EXPECT_FALSE(cell.at("moved_again").as_bool());
    EXPECT_EQ(cell.at("text").get_string(), "halt after 0.2 ms, at rest after 41.5 ms; it stayed when its client came back");
    EXPECT_EQ(gateway.documents("rehearsal").size(), 1u);
}

TEST_F(FailSafeTest, ACellWithoutFiguresIsCountedAndSaysWhy) {
    const std::string axis(gateway.site()->site.axes.at(0).name);
    ASSERT_EQ(call("POST", "/api/v1/fail_safe/rehearsal", R"({"axes": [")" + axis + R"("]})").status, 202);
    gateway.give_all([](RehearsalCell& cell) { cell.fault = "it does not move"; });
    const auto a = call("GET", "/api/v1/fail_safe/rehearsal");
    const auto& report = a.json.get_object().at("report").get_object();
    EXPECT_EQ(report.at("without_figures").to_number<std::size_t>(), loss_causes().size() + 1);
    EXPECT_EQ(report.at("cells").get_array().at(0).get_object().at("text").get_string(), "no figures: it does not move");
    EXPECT_EQ(call("POST", "/api/v1/fail_safe/rehearsal", R"({"axes": ["nobody"]})").status, 409);
    EXPECT_EQ(call("POST", "/api/v1/fail_safe/rehearsal", R"({"axes": "all"})").status, 422);
}

TEST_F(FailSafeTest, WhatHappensBesideTheLossIsChosen) {
    const std::string axis(gateway.site()->site.axes.at(0).name);
    const auto start = [&](const std::string& steps) {
        return call("POST", "/api/v1/fail_safe/rehearsal", R"({"axes": [")" + axis + R"("], "steps": )" + steps + "}");
    };
    ASSERT_EQ(start(R"(["second_client", "old_image"])").status, 202);
    gateway.give_all(good);
    ASSERT_EQ(gateway.wishes.size(), loss_causes().size()) << "no cell in which the gateway is started again";
    for (const RehearsalWish& wish : gateway.wishes) {
        EXPECT_TRUE(wish.steps.has(RehearsalStep::second_client) && wish.steps.has(RehearsalStep::old_image));
        EXPECT_FALSE(wish.steps.has(RehearsalStep::refused_commands) || wish.steps.has(RehearsalStep::gateway_restart) || wish.restart);
    }
    const auto played = call("GET", "/api/v1/fail_safe/rehearsal").json.get_object().at("report").get_object();
    EXPECT_EQ(json_text(played.at("steps")), R"(["second_client","old_image"])");
    gateway.wishes.clear();
    ASSERT_EQ(start(R"(["gateway_restart"])").status, 202);
    gateway.give_all(good);
    ASSERT_EQ(gateway.wishes.size(), loss_causes().size() + 1);
    EXPECT_TRUE(gateway.wishes.back().restart);
    const auto last = call("GET", "/api/v1/fail_safe/rehearsal").json.get_object().at("report").get_object().at("cells").get_array().back();
    EXPECT_EQ(last.get_object().at("cause").get_string(), "gateway_restarts");
    gateway.wishes.clear();
    ASSERT_EQ(start("[]").status, 202) << "the loss alone";
    gateway.give_all(good);
    EXPECT_EQ(gateway.wishes.size(), loss_causes().size());
    const auto no = start(R"(["second_client", "earthquake"])");
    EXPECT_EQ(no.status, 422);
    EXPECT_EQ(no.fault().at("pointer").get_string(), "/steps/1");
    EXPECT_EQ(start(R"("all")").status, 422);
}

TEST_F(FailSafeTest, WhatReallyEndedAMotionIsSaidInWords) {
    ASSERT_EQ(call("POST", "/api/v1/fail_safe/rehearsal", "{}").status, 202);
    gateway.give_all([](RehearsalCell& cell) {
        good(cell);
        cell.ended_by = cell.restart ? "drive" : "";
        if (cell.restart) cell.noticed_ms.reset();
        cell.moved_again = cell.restart ? std::nullopt : std::optional(true);
    });
    const auto report = call("GET", "/api/v1/fail_safe/rehearsal").json.get_object().at("report").get_object();
    const auto& cells = report.at("cells").get_array();
    EXPECT_TRUE(cells.front().get_object().at("ended_by").is_null());
    EXPECT_NE(cells.front().get_object().at("text").get_string().find("it moved again"), std::string::npos);
    EXPECT_TRUE(cells.back().get_object().at("moved_again").is_null());
    EXPECT_EQ(cells.back().get_object().at("text").get_string(),
              "the drive stops by itself after 3.0 ms, at rest after 41.5 ms; ended by drive");
}

TEST_F(FailSafeTest, TheOldestReportsMakeRoom) {
    for (std::size_t i = 0; i < Rehearsals::kept + 3; ++i) {
        gateway.now_ns += 1'000'000'000;
        ASSERT_EQ(call("POST", "/api/v1/fail_safe/rehearsal", "{}").status, 202);
        gateway.give_all(good);
    }
    EXPECT_EQ(gateway.documents("rehearsal").size(), Rehearsals::kept);
}

}  // namespace
}  // namespace axisgate::http::test
