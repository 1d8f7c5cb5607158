// Which part decides that a command is complete: an adapter reports only the drive's acknowledgement; the end of commands that take time is
// observed at the axis, by the engine alone. The adapter here answers everything with done at once.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

constexpr std::string_view scripted_page = R"({"family": "scripted", "number": 98, "title": "Scripted drive", "maker": "nobody",
    "description": "Does what a test says.", "source": "", "lines": ["can"], "address": {"type": "integer", "min": 1, "max": 9, "default": "1"},
    "channels": {"min": 1, "max": 1}, "modes": [1, 3, 6], "position_unit": "inc", "velocity_unit": "inc/s", "acceleration_unit": "inc/s^2",
    "options": [], "storage_classes": {"memory": "kept"},
    "parameters": [{"id": "P1", "name": "one", "group": "g", "type": "u16", "unit": null, "min": null, "max": null, "default": 0, "access": "RW",
                    "storage": "memory", "allowed": null, "description": "A value."}],
    "commands": [
      {"id": "blink", "name": "blink", "kind": "action", "sends": "B", "argument": null, "description": "."},
      {"id": "go", "name": "go", "kind": "action", "sends": "G", "argument": null, "description": ".", "completes": "target_reached"},
      {"id": "run_out", "name": "run_out", "kind": "action", "sends": "R", "argument": null, "description": ".", "completes": "standstill"},
      {"id": "energize", "name": "energize", "kind": "action", "sends": "E", "argument": null, "description": ".", "completes": "powered"},
      {"id": "reboot", "name": "reboot", "kind": "action", "sends": "X", "argument": null, "description": ".", "completes": "online_again"},
      {"id": "program", "name": "program", "kind": "action", "sends": "P", "argument": null, "description": ".", "completes": "reported"}],
    "errors": [{"code": 1, "kind": "fault", "name": "hot", "text": "It is hot", "cause": ".", "remedy": "."}]})";

/// The drive's feedback, and the answers of its adapter.
struct Script {
    AxisFeedback shows;
    bool online = true;
    Outcome answers = Outcome::done;  ///< to everything, at once
    std::vector<Command> received;
    std::vector<Result> later;  ///< reported with the next feedback
};
Script* script = nullptr;

class ScriptedAdapter final : public Adapter {
public:
    void configure(const LineSetup& setup, Instant now, Out&) override {
        drive_ = setup.drives.empty() ? no_drive : setup.drives.front().id;
        axis_ = setup.drives.empty() || setup.drives.front().axes.empty() ? no_axis : setup.drives.front().axes.front().id;
        next_ = now;
    }
    void on_line(bool up, Instant now, Out&) override { next_ = up ? now : never; }
    void on_command(const Command& command, Instant now, Out& out) override {
        script->received.push_back(command);
        if (std::holds_alternative<Move>(command.body) && script->answers != Outcome::refused) {  // a law of adapters
            script->shows.target_reached = false;
            script->shows.at = now;
            out.feedback.push_back({axis_, script->shows});
        }
        Result r;
        r.ticket = command.ticket;
        r.axis = command.axis;
        r.outcome = script->answers;
        if (!good(r)) r.reason = Reason::drive_refused, r.text = "no";
        out.results.push_back(r);
    }
    void on_frame(const Frame&, Instant, Out&) override {}
    void on_deadline(Instant now, Out& out) override {
        if (now < next_ || drive_ == no_drive) return;
        next_ = now + 20ms;
        if (script->online != online_)
            out.links.push_back({drive_, online_ = script->online, script->online ? 0u : 3u, {}, "so it is told"});
        if (!online_) return;
        script->shows.at = now;
        out.feedback.push_back({axis_, script->shows});
        out.results = std::exchange(script->later, {});
    }
    [[nodiscard]] Instant deadline() const override { return next_; }
    [[nodiscard]] AdapterCounters counters() const override { return {}; }

private:
    DriveId drive_ = no_drive;
    AxisId axis_ = no_axis;
    Instant next_ = never;
    bool online_ = false;
};

struct Done : testing::Test {
    Script now;
    Catalogue page = [] {
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(scripted_page, faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f;
        return std::move(parsed).value();
    }();
    Family family = [] {
        Family f = *families().entries.front().family;
        f.name = "scripted";
        f.served_by = nullptr;
        f.make_adapter = [](const Catalogue&, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<ScriptedAdapter>(); };
        f.uses_can = true;
        f.can_identifiers = nullptr;
        f.check_address = [](std::string_view) { return std::string(); };
        return f;
    }();
    std::unique_ptr<World> world;
    AxisId axis = no_axis;

    void start() {
        script = &now;
        now = {};
        now.shows.power = AxisFeedback::Power::on;
        now.shows.referenced = true;
        now.shows.target_reached = true;
        world = std::make_unique<World>(1, std::make_shared<Plant>(), Families{{{&family, &page}}});
        Site s;
        s.lines.push_back({"line", "can:sim", "scripted", 500'000, {}, {}});
        s.drives.push_back({"d", "line", "", "1", PresenceRule::device, {}});
        AxisSpec a;
        a.name = "a";
        a.drive = "d";
        a.number = 1;
        s.axes.push_back(a);
        axis = world->apply(std::move(s))->axis_ids.at(0);
        world->run_for(500ms);
        ASSERT_EQ(power_state_of(world->picture(axis).statusword), PowerState::operation_enabled);
    }
    static Action action(std::string name) {
        Action a;
        a.name = std::move(name);
        return a;
    }
    static Move move(std::int64_t target, Move::Kind kind = Move::Kind::absolute) {
        Move m;
        m.target = target;
        m.kind = kind;
        m.velocity = 100;
        return m;
    }
    Ticket give(CommandBody body, bool wait = true) { return world->command(axis, std::move(body), wait); }
    [[nodiscard]] std::string answer(Ticket t) const {
        const Result* r = world->result(t);
        return !r ? "" : std::string(name_of(r->outcome)) + (r->reason == Reason::none ? "" : " " + std::string(name_of(r->reason)));
    }
    using Change = void (*)(AxisFeedback&);
    struct Case {
        const char* what;
        CommandBody body;
        Change before;  ///< the state of the axis when the command arrives
        Change meanwhile;
        Change end;
    };
    static std::vector<Case> cases() {
        const Change none = [](AxisFeedback&) {};
        const Change under_way = [](AxisFeedback& f) { f.moving = true, f.target_reached = false; };
        const Change arrived = [](AxisFeedback& f) { f.moving = false, f.target_reached = true; };
        return {
            {"a move", move(500), none, under_way, arrived},
            {"a velocity move", move(500, Move::Kind::velocity), none, [](AxisFeedback& f) { f.moving = true, f.velocity = 100; },
             [](AxisFeedback& f) { f.velocity = 500; }},
            {"homing", Home{35}, none, [](AxisFeedback& f) { f.homing = f.moving = true, f.homing_attained = false; },
             [](AxisFeedback& f) { f.homing = f.moving = false, f.homing_attained = true; }},
            {"a halt", Halt{}, under_way, none, [](AxisFeedback& f) { f.moving = false; }},
            {"a quick stop", QuickStop{}, under_way, none, [](AxisFeedback& f) { f.moving = false; }},
            {"a reset", ResetFault{}, [](AxisFeedback& f) { f.fault = true, f.error_code = 1, f.power = AxisFeedback::Power::off; }, none,
             [](AxisFeedback& f) { f.fault = false, f.error_code = 0; }},
            {"target_reached", action("go"), none, under_way, arrived},
            {"standstill", action("run_out"), none, under_way, arrived},
            {"powered", action("energize"), [](AxisFeedback& f) { f.power = AxisFeedback::Power::off; }, none,
             [](AxisFeedback& f) { f.power = AxisFeedback::Power::on; }},
        };
    }
};

TEST_F(Done, WhatAnAdapterCallsDoneIsTheDrivesAcknowledgementUntilTheAxisShowsTheEnd) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.what);
        start();
        c.before(now.shows);
        world->run_for(100ms);
        const Ticket t = give(c.body);
        c.meanwhile(now.shows);
        world->run_for(2s);
        EXPECT_EQ(answer(t), "") << "the adapter has said done long ago";
        c.end(now.shows);
        world->run_for(500ms);
        EXPECT_EQ(answer(t), "done");
        EXPECT_EQ(world->results[t].size(), 1u);
        if (!std::holds_alternative<Action>(c.body))
            EXPECT_FALSE(now.received.back().until_done) << "no adapter is asked to watch what the axis shows";
    }
}

TEST_F(Done, WithoutAWaitWhatTakesTimeIsAcceptedAndNeverDone) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.what);
        start();
        c.before(now.shows);
        world->run_for(100ms);
        const Ticket t = give(c.body, false);
        c.meanwhile(now.shows);
        world->run_for(1s);
        EXPECT_EQ(answer(t), std::holds_alternative<ResetFault>(c.body) ? "done" : "accepted") << "a reset is its acknowledgement";
        EXPECT_EQ(world->results[t].size(), 1u);
    }
}

TEST_F(Done, WhatIsRefusedIsNotWatched) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.what);
        start();
        c.before(now.shows);
        world->run_for(100ms);
        now.answers = Outcome::refused;
        const Ticket t = give(c.body);
        EXPECT_EQ(answer(t), "refused drive_refused");
        c.end(now.shows);
        world->run_for(1s);
        EXPECT_EQ(world->results[t].size(), 1u);
    }
}

TEST_F(Done, AFaultOrSilenceEndsTheWatchAsFailed) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.what);
        const bool resets = std::holds_alternative<ResetFault>(c.body), stops = is_urgent(c.body);
        start();
        c.before(now.shows);
        world->run_for(100ms);
        const Ticket faulty = give(c.body);
        c.meanwhile(now.shows);
        world->run_for(500ms);
        now.shows.fault = true;
        now.shows.error_code = 1;
        if (!stops) now.shows.moving = now.shows.homing = false;
        world->run_for(4s);
        if (!stops) EXPECT_EQ(answer(faulty), resets ? "failed wrong_state" : "failed interrupted");

        start();
        c.before(now.shows);
        world->run_for(100ms);
        const Ticket unreceived = give(c.body);
        c.meanwhile(now.shows);
        world->run_for(100ms);
        now.online = false;
        world->run_for(1s);
        EXPECT_EQ(answer(unreceived), "failed no_answer");
    }
}

TEST_F(Done, AcknowledgedIsDoneAtOnce) {
    start();
    EXPECT_EQ(answer(give(action("blink"))), "done");
    EXPECT_EQ(answer(give(action("blink"), false)), "done");
    now.answers = Outcome::accepted;
    EXPECT_EQ(answer(give(action("blink"))), "done") << "the catalogue says by what it is complete, not the adapter's word";
}

TEST_F(Done, ReportedIsTheAdaptersToSay) {
    start();
    now.answers = Outcome::accepted;
    EXPECT_EQ(answer(give(action("program"), false)), "accepted");
    EXPECT_FALSE(now.received.back().until_done);
    now.answers = Outcome::done;
    EXPECT_EQ(answer(give(action("program"))), "done");
    EXPECT_TRUE(now.received.back().until_done) << "who is to tell the end must know that somebody waits for it";
}

TEST_F(Done, OnlineAgainIsSilenceAndThenAnAnswer) {
    start();
    const Ticket t = give(action("reboot"));
    world->run_for(2s);
    EXPECT_EQ(answer(t), "") << "it has not gone yet";
    now.online = false;
    world->run_for(2s);
    EXPECT_EQ(answer(t), "") << "its silence is the first half of it";
    now.online = true;
    world->run_for(1s);
    EXPECT_EQ(answer(t), "done");
    EXPECT_EQ(answer(give(action("reboot"), false)), "accepted");
}

TEST_F(Done, AMotionThatStandsShortOfItsTargetIsInterruptedUnlessItsTargetIsShownSoon) {
    for (const char* what : {"move", "go"}) {
        for (const bool arrives : {false, true}) {
            SCOPED_TRACE(std::string(what) + (arrives ? ", arrives" : ""));
            start();
            const Ticket t = std::string_view(what) == "move" ? give(move(500)) : give(action("go"));
            now.shows.moving = true;
            now.shows.target_reached = false;
            world->run_for(500ms);
            now.shows.moving = false;
            world->run_for(2s);
            EXPECT_EQ(answer(t), "") << "a drive may show its target behind the standstill";
            now.shows.target_reached = arrives;
            world->run_for(1s);
            EXPECT_EQ(answer(t), arrives ? "done" : "failed interrupted");
        }
    }
}

}  // namespace
}  // namespace axisgate::test
