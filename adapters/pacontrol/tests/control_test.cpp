// The adapter finds a control, brings it into ONLINE, gives it back, references and moves its axes: what goes over the line, in which
// order.
#include "adapters/pacontrol/tests/fake_bench.hpp"

namespace axisgate::pacontrol::test {
namespace {

// --- presence --------------------------------------------------------------------------------------------------------------------

TEST(PacontrolPresence, FindsTheControlAndReadsEveryAxis) {
    Bench b(4);
    b.control.axes[2].position = 12.345;
    b.control.axes[1].referenced = false;
    b.start();
    ASSERT_FALSE(b.links.empty());
    EXPECT_TRUE(b.links.back().online);
    for (std::uint16_t i = 0; i < 4; ++i) {
        EXPECT_EQ(b.feedback(i).power, AxisFeedback::Power::off);
        EXPECT_FALSE(b.feedback(i).moving);
        EXPECT_EQ(b.feedback(i).referenced, i != 1);
    }
    EXPECT_EQ(b.feedback(2).position, 12345);
    EXPECT_TRUE(b.reported().size() == 1 && b.reported()[0] == "190B;0;0;0") << "nothing is changed by being found";
}

TEST(PacontrolPresence, AddressIsTheWordCom1) {
    EXPECT_EQ(check_address("com1"), "");
    for (const char* bad : {"", "1", "COM1", "com2", "no such address\n"}) {
        EXPECT_NE(check_address(bad).find("write com1"), std::string::npos) << bad;
        EXPECT_EQ(check_address(bad).find('\n'), std::string::npos);
    }
}

TEST(PacontrolPresence, ASecondDriveOnTheLineIsToldThatItsPlaceIsTaken) {
    Bench b(1);
    DriveSetup d = b.setup.drives[0];
    d.id = DriveId{1};
    d.name = "other";
    d.axes = {{AxisId{7}, 1}};
    b.setup.drives.push_back(d);
    b.start();
    const auto it = std::ranges::find(b.links, DriveId{1}, &DriveLink::drive);
    ASSERT_NE(it, b.links.end());
    EXPECT_FALSE(it->online);
    EXPECT_NE(it->text.find("pac"), std::string::npos);
    EXPECT_EQ(b.ask(Enable{}, false, 7).reason, Reason::line_down);
}

TEST(PacontrolPresence, AbsentFoundAgainAndPausesGrow) {
    Bench b(1);
    b.control.silent = true;
    b.start(30s);
    EXPECT_FALSE(b.links.back().online);
    EXPECT_EQ(b.links.back().retry_pause, 5s);
    EXPECT_EQ(b.ask(Enable{}).reason, Reason::no_answer);
    const auto before = b.sent.size();
    b.run(20s);
    EXPECT_LE(b.sent.size() - before, 5u);
    b.control.silent = false;
    EXPECT_TRUE(b.run_until([&] { return b.links.back().online; }, 6s));
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
}

TEST(PacontrolPresence, LearnsWhichCheckTheControlWants) {
    for (const auto form : {CheckForm::text, CheckForm::with_etx}) {
        Bench b(1);
        b.control.demands = form;
        b.start();
        ASSERT_TRUE(b.links.back().online);
        b.mark();
        EXPECT_TRUE(good(b.ask(ReadParameter{Bench::point("N[2]")})));
        EXPECT_EQ(b.sent.back().text.empty(), false);
        for (std::size_t i = b.mark_at; i < b.sent.size(); ++i) {
            if (b.sent[i].text == "EOT") continue;
            EXPECT_EQ(b.sent[i].check, std::to_string(check_of(b.sent[i].text, form)));
        }
    }
    Bench zero(1, 0, {}, {{"check", "zero"}});
    zero.start();
    EXPECT_TRUE(zero.links.back().online);
    for (const auto& s : zero.sent)
        EXPECT_TRUE(s.text == "EOT" || s.check == "0");
    Bench compute(1, 0, {}, {{"check", "compute"}});
    compute.control.demands = CheckForm::with_etx;
    compute.start();
    for (const auto& s : compute.sent)
        EXPECT_EQ(s.check, std::to_string(check_of(s.text, CheckForm::text))) << "compute does not change its mind";
}

TEST(PacontrolPresence, BothReplyFormsAreTakenAndStrictNamesTheOther) {
    for (const auto form : {CheckForm::text, CheckForm::with_etx, CheckForm::zero}) {
        Bench b(1);
        b.control.reply_check = form;
        b.start();
        EXPECT_TRUE(b.links.back().online);
        EXPECT_EQ(b.adapter.counters().garbled, 0u);
    }
    Bench b(1, 0, {}, {{"strict", "on"}});
    b.control.reply_check = CheckForm::text;
    b.start();
    EXPECT_FALSE(b.links.back().online);
    EXPECT_GT(b.adapter.counters().garbled, 0u);
    EXPECT_NE(b.notice_text("protocol").find("leaves the ETX out"), std::string::npos) << b.notice_text("protocol");
}

TEST(PacontrolPresence, WrongOptionsAreToldAndDoNotStopIt) {
    Bench b(1, 0, {{"when", "later"}, {"reference_order", "1;2"}, {"when_timeout_ms", "1"}}, {{"check", "crc"}, {"strict", "maybe"}});
    b.start();
    EXPECT_EQ(b.notices_of("setup"), 5u);
    EXPECT_TRUE(b.links.back().online);
}

TEST(PacontrolPresence, AnAxisThatTheControlDoesNotHaveIsTold) {
    Bench b(6);
    b.start();
    EXPECT_EQ(b.notices_of("setup"), 2u);
    const Result r = b.enable(5);
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_NE(r.text.find("20h"), std::string::npos);
    EXPECT_EQ(b.enable(3).outcome, Outcome::accepted);
}

TEST(PacontrolPresence, AxesComeAndGoWithoutDisturbingTheOthers) {
    Enabled b(2);
    const Ticket go = b.command(absolute(20000), true, 0);
    b.run(300ms);
    b.setup.drives[0].axes.pop_back();
    b.configure();
    b.setup.drives[0].axes.push_back({AxisId{9}, 3});
    b.configure();
    EXPECT_EQ(b.answer(go).outcome, Outcome::done);
    EXPECT_EQ(b.ask(Enable{}, false, 1).reason, Reason::line_down);
    EXPECT_EQ(b.ask(Enable{}, false, 9).outcome, Outcome::accepted);
}

TEST(PacontrolPresence, AnAxisThatIsTakenOutWhileItRunsIsStopped) {
    Enabled b(2);
    (void)b.command(absolute(20000), false, 1);
    b.run(300ms);
    b.mark();
    b.setup.drives[0].axes.pop_back();
    b.configure();
    b.run(300ms);
    EXPECT_EQ(b.reported(), (Lines{"0A9A;2;1;0"})) << "nobody could stop it any more";
}

// --- ONLINE ----------------------------------------------------------------------------------------------------------------------

TEST(PacontrolOnline, EnableStartsItOnceAndDisableGivesItBack) {
    Bench b(2);
    b.start();
    b.mark();
    EXPECT_EQ(b.ask(Enable{}, true, 0).outcome, Outcome::done);
    EXPECT_EQ(b.reported(), (Lines{"0603;0;0;0", "0A9A;1;1;0", "0A97;1;0;0"}));
    EXPECT_EQ(b.feedback(0).power, AxisFeedback::Power::on);
    EXPECT_EQ(b.feedback(1).power, AxisFeedback::Power::off) << "only the axis that was enabled";
    b.mark();
    EXPECT_EQ(b.enable(1).outcome, Outcome::accepted);
    EXPECT_EQ(b.reported(), (Lines{"0A9A;2;1;0", "0A97;2;0;0"}));
    b.mark();
    EXPECT_EQ(b.ask(Disable{}, false, 0).outcome, Outcome::accepted);
    b.run(1s);
    EXPECT_EQ(b.reported(), (Lines{"0A9A;1;1;0", "0A98;1;0;0"})) << "the other axis still needs ONLINE";
    EXPECT_EQ(b.ask(Disable{}, true, 1).outcome, Outcome::done);
    b.run(1s);
    EXPECT_EQ(b.reported(), (Lines{"0A9A;1;1;0", "0A98;1;0;0", "0A9A;2;1;0", "0A98;2;0;0", "0A81;0;0;0"}));
    EXPECT_EQ(b.control.mode, 1);
    EXPECT_EQ(b.notices_of("mode"), 0u) << "what the gateway did itself is no surprise";
}

TEST(PacontrolOnline, NothingIsGivenBackThatWouldHavePowerThere) {
    for (const double enable_mode : {1.0, 0.0}) {
        Bench b(2);
        b.control.axis_parameters[2 << 8 | 0x32] = enable_mode;  // 1: operational again out of ONLINE [L722]
        b.start();
        b.run(1s);
        EXPECT_EQ(b.enable(1).outcome, Outcome::accepted);
        b.mark();
        EXPECT_EQ(b.ask(Disable{}, true, 1).outcome, Outcome::done);
        b.run(2s);
        EXPECT_EQ(b.control.mode, enable_mode == 1 ? 31 : 1);
        if (enable_mode != 1) continue;
        EXPECT_EQ(b.reported(), (Lines{"0A9A;2;1;0", "0A98;2;0;0"}));
        EXPECT_TRUE(good(b.action("online.give_back"))) << "who says so gets it";
        EXPECT_EQ(b.control.mode, 1);
    }
}

TEST(PacontrolOnline, NorForAParameterThatWaits) {
    Bench b(2, 0, {{"when", "wait"}, {"when_timeout_ms", "3000"}});
    b.control.axis_parameters[2 << 8 | 0x32] = 1;
    b.start();
    b.run(1s);
    EXPECT_EQ(b.enable(1).outcome, Outcome::accepted);
    EXPECT_EQ(b.ask(Disable{}, true, 1).outcome, Outcome::done);
    const Result r = b.ask(ReadParameter{Bench::point("SP2")}, false, 0);
    EXPECT_EQ(r.reason, Reason::wrong_state);
    EXPECT_NE(r.text.find("axis 2 may have power there by its enable mode (AP[50])"), std::string::npos) << r.text;
    EXPECT_NE(r.text.find("online.give_back"), std::string::npos) << "and what to do: " << r.text;
    EXPECT_EQ(b.control.mode, 31) << "who reads has not ordered power";
}

TEST(PacontrolOnline, TwoAxesEnabledAtOnceShareOneStart) {
    Bench b(2);
    b.start();
    b.mark();
    const Ticket x = b.command(Enable{}, true, 0), y = b.command(Enable{}, true, 1);
    EXPECT_EQ(b.answer(x).outcome, Outcome::done);
    EXPECT_EQ(b.answer(y).outcome, Outcome::done);
    EXPECT_EQ(std::ranges::count(b.reported(), "0603;0;0;0"), 1);
}

TEST(PacontrolOnline, WhatWasStartedByHandIsNotGivenBack) {
    Bench b(1, 0, {{"online", "manual"}});
    b.start();
    const Result r = b.enable();
    EXPECT_EQ(r.reason, Reason::wrong_state);
    EXPECT_NE(r.text.find("online.start"), std::string::npos);
    EXPECT_TRUE(good(b.action("online.start")));
    b.run(500ms);
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    EXPECT_EQ(b.ask(Disable{}).outcome, Outcome::accepted);
    b.run(2s);
    EXPECT_EQ(b.control.mode, 31);
    EXPECT_TRUE(good(b.action("online.give_back")));
    EXPECT_EQ(b.control.mode, 1);
}

TEST(PacontrolOnline, GivingBackAndReleasingAreChosenByOptions) {
    Bench b(1, 0, {{"give_back", "never"}, {"reference", "release"}});
    b.control.axes[0].referenced = false;
    b.start();
    b.mark();
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    EXPECT_TRUE(b.feedback().referenced);
    EXPECT_EQ(b.ask(Disable{}).outcome, Outcome::accepted);
    b.run(2s);
    EXPECT_EQ(b.reported(), (Lines{"0603;0;0;0", "0A9A;1;1;0", "0A97;1;0;0", "0A83;1;0;0", "0A9A;1;1;0", "0A98;1;0;0"}));
    EXPECT_EQ(b.control.mode, 31);
    Bench keep(1);
    keep.control.axes[0].referenced = false;
    keep.start();
    EXPECT_EQ(keep.enable().outcome, Outcome::accepted);
    EXPECT_FALSE(keep.feedback().referenced) << "no release that nobody asked for";
}

TEST(PacontrolOnline, ExternalStopIsNamed) {
    Bench b(1);
    b.control.external_stop = false;
    b.start();
    const Result r = b.enable();
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::drive_refused);
    EXPECT_EQ(r.code, 44);
    EXPECT_NE(r.text.find("external stop not defined"), std::string::npos) << r.text;
}

struct ModeRow {
    int mode;
    int error;
    bool enables;
    const char* says;
};

TEST(PacontrolOnline, EnableInEveryOperatingStatus) {
    for (const ModeRow& row :
         {ModeRow{1, 0, true, ""}, ModeRow{31, 0, true, ""}, ModeRow{35, 0, true, ""}, ModeRow{2, 0, false, "operator"},
          ModeRow{3, 0, false, "operator"}, ModeRow{20, 0, false, "WINPAC"}, ModeRow{9, 101, false, "E101"},
          ModeRow{11, 0, false, "automatic.cancel"}, ModeRow{15, 0, false, "automatic.cancel"}, ModeRow{19, 525, false, "AUTOMATIC"},
          ModeRow{37, 529, false, "E529"}, ModeRow{39, 529, false, "reset"}, ModeRow{0, 0, false, "not initialised"},
          ModeRow{1, 101, false, "reset"}}) {
        SCOPED_TRACE(row.mode);
        Bench b(1);
        b.control.mode = row.mode;
        b.control.error = row.error;
        b.start();
        const Result r = b.enable();
        EXPECT_EQ(good(r), row.enables) << r.text;
        EXPECT_NE(r.text.find(row.says), std::string::npos) << r.text;
        if (!row.enables) {
            EXPECT_EQ(r.reason, Reason::wrong_state);
        }
        EXPECT_EQ(b.feedback().fault, row.error != 0 || row.mode == 9) << "operating status and error, not the refusal, are the fault";
        EXPECT_EQ(b.feedback().error_code, row.error);
        EXPECT_EQ(b.feedback().native_status & 0xFF, static_cast<std::uint32_t>(row.enables ? 31 : row.mode));
    }
}

TEST(PacontrolOnline, EnableFromAStoppedOnlineLetsNoInterruptedMotionGoOn) {
    Bench b(1);
    b.control.mode = 35;
    b.start();
    b.mark();
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    EXPECT_EQ(b.reported(), (Lines{"0A81;0;0;0", "0603;0;0;0", "0A9A;1;1;0", "0A97;1;0;0"})) << "0603 from 35 would resume";
}

TEST(PacontrolOnline, ResetGoesTheWayOfTheErrorsClass) {
    Enabled b(1);
    b.control.error = 529;
    b.control.mode = 39;
    b.run(500ms);
    EXPECT_TRUE(b.feedback().fault);
    EXPECT_EQ(b.feedback().error_code, 529);
    EXPECT_GE(b.notices_of("alarm"), 1u);
    b.mark();
    EXPECT_EQ(b.ask(ResetFault{}, true).outcome, Outcome::done);
    EXPECT_EQ(b.reported(), (Lines{"0A81;0;0;0"})) << "class 3 goes on the way home";
    EXPECT_FALSE(b.feedback().fault);

    b.control.error = 205;
    b.control.mode = 9;
    b.run(500ms);
    b.mark();
    EXPECT_EQ(b.ask(ResetFault{}).outcome, Outcome::accepted);
    EXPECT_EQ(b.reported(), (Lines{"0909;0;0;0"}));

    b.control.error = 120;
    b.control.mode = 9;
    b.control.unreset = true;
    b.run(500ms);
    const Result r = b.ask(ResetFault{});
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.code, 21);
    EXPECT_NE(r.text.find("E120"), std::string::npos) << r.text;
    EXPECT_TRUE(b.feedback().fault);
}

TEST(PacontrolOnline, AutomaticIsStartedStoppedAndCancelled) {
    Bench b(1);
    b.start();
    b.mark();
    EXPECT_TRUE(good(b.action("automatic.start")));
    EXPECT_EQ(b.control.mode, 11);
    const Result r = b.enable();
    EXPECT_EQ(r.reason, Reason::wrong_state);
    EXPECT_TRUE(good(b.action("automatic.stop")));
    EXPECT_EQ(b.control.mode, 15);
    EXPECT_TRUE(good(b.action("automatic.start"))) << "after a stop it goes on";
    EXPECT_TRUE(good(b.action("automatic.cancel")));
    EXPECT_EQ(b.reported(), (Lines{"0602;0;0;0", "0600;0;0;0", "0602;0;0;0", "0A41;0;0;0"}));
    EXPECT_EQ(b.control.mode, 1);
    EXPECT_EQ(b.action("automatic.start", "DRILL").reason, Reason::not_supported);
}

// --- motion ----------------------------------------------------------------------------------------------------------------------

TEST(PacontrolMotion, AbsoluteWithSpeedAndAcceleration) {
    Enabled b;
    const Ticket go = b.command(absolute(8000, 4000, 20000, 20000), true);
    b.run(1s);
    EXPECT_EQ(b.reported(), (Lines{"0A8D;1;1;4.0", "0A8E;1;1;20.0", "0A94;1;1;8.0"}));
    EXPECT_TRUE(b.feedback().moving);
    EXPECT_FALSE(b.feedback().target_reached);
    EXPECT_GT(b.feedback().position, 2000);
    EXPECT_LT(b.feedback().position, 8000);
    EXPECT_NEAR(static_cast<double>(b.feedback().velocity), 4000, 1);
    EXPECT_FALSE(b.results.contains(go));
    EXPECT_EQ(b.answer(go).outcome, Outcome::done);
    EXPECT_EQ(b.feedback().position, 8000);
    EXPECT_TRUE(b.feedback().target_reached);
    EXPECT_EQ(b.feedback().velocity, 0);
    b.mark();
    EXPECT_EQ(b.ask(absolute(0, 4000, 20000), true).outcome, Outcome::done);
    EXPECT_EQ(b.reported(), (Lines{"0A94;1;1;0.0"})) << "overrides that are in force are not sent again";
}

TEST(PacontrolMotion, AcceptedComesAfterFeedbackThatTheTargetIsNotReached) {
    Enabled b;
    EXPECT_EQ(b.ask(absolute(1000), true).outcome, Outcome::done);
    ASSERT_TRUE(b.feedback().target_reached);
    const Result r = b.ask(absolute(2000));
    EXPECT_EQ(r.outcome, Outcome::accepted);
    EXPECT_FALSE(b.feedback().target_reached);
    EXPECT_TRUE(b.feedback().moving);
}

TEST(PacontrolMotion, FourAxesMoveAtOnce) {
    Enabled b(4);
    std::vector<Ticket> go;
    for (std::uint16_t i = 0; i < 4; ++i)
        go.push_back(b.command(absolute(10000 + i * 1000), true, i));
    b.run(300ms);
    for (std::uint16_t i = 0; i < 4; ++i)
        EXPECT_TRUE(b.feedback(i).moving);
    for (const auto t : go)
        EXPECT_EQ(b.answer(t).outcome, Outcome::done);
    for (std::uint16_t i = 0; i < 4; ++i)
        EXPECT_EQ(b.feedback(i).position, 10000 + i * 1000);
}

TEST(PacontrolMotion, RelativeAndVelocity) {
    Enabled b;
    Move m = absolute(-4000, 8000);
    m.kind = Move::Kind::relative;
    EXPECT_EQ(b.ask(m, true).outcome, Outcome::done);
    EXPECT_EQ(b.feedback().position, -4000);
    b.mark();
    Move jog;
    jog.kind = Move::Kind::velocity;
    jog.target = -3000;
    EXPECT_EQ(b.ask(jog, true).outcome, Outcome::done);
    EXPECT_EQ(b.reported(), (Lines{"0A8D;1;1;3.0", "1913;1;1;0", "0A94;1;1;-500.0"})) << "to the end of the area at that speed";
    EXPECT_EQ(b.feedback().velocity, -3000);
    jog.target = 0;
    EXPECT_EQ(b.ask(jog, true).outcome, Outcome::done);
    EXPECT_FALSE(b.feedback().moving);
}

TEST(PacontrolMotion, ANewTargetStopsTheRunningMotionFirst) {
    Enabled b;
    const Ticket first = b.command(absolute(100000), true);
    b.run(500ms);
    b.mark();
    const Ticket second = b.command(absolute(1000), true);
    EXPECT_EQ(b.answer(first).reason, Reason::interrupted);
    EXPECT_EQ(b.answer(second).outcome, Outcome::done);
    EXPECT_EQ(b.reported(), (Lines{"0A9A;1;1;0", "0A94;1;1;1.0"}));
    EXPECT_EQ(b.feedback().position, 1000);
}

TEST(PacontrolMotion, RefusalsCarryTheCommandErrorAndTheAxisHasNoFault) {
    Enabled b;
    struct Row {
        Move move;
        int code;
        const char* says;
    };
    for (const Row& r : {Row{absolute(600000), 65, "position outside range"}, Row{absolute(0, 2000000), 41, "value outside range"}}) {
        const Result x = b.ask(r.move);
        EXPECT_EQ(x.outcome, Outcome::refused);
        EXPECT_EQ(x.code, r.code);
        EXPECT_NE(x.text.find(r.says), std::string::npos) << x.text;
        EXPECT_FALSE(b.feedback().fault) << "a command error is no fault of the axis";
    }
    b.control.axes[0].referenced = false;
    EXPECT_EQ(b.ask(absolute(5)).code, 43);
    b.control.axes[0].referenced = true;
    b.control.axes[0].on = false;  // switched off at the control
    EXPECT_EQ(b.ask(absolute(5)).code, 55);
    EXPECT_EQ(b.feedback().power, AxisFeedback::Power::off);
    EXPECT_TRUE(good(b.enable()));
    EXPECT_EQ(b.ask(absolute(0, 100, 200, 300)).reason, Reason::not_supported);
    EXPECT_EQ(b.ask(absolute(0, 0)).reason, Reason::out_of_range);
    EXPECT_EQ(b.ask(absolute(3'000'000'000)).reason, Reason::out_of_range);
}

TEST(PacontrolMotion, NothingMovesOutsideOnline) {
    Bench b(1);
    b.start();
    b.mark();
    for (const CommandBody& c :
         {CommandBody{absolute(1)}, CommandBody{Home{}}, CommandBody{SetPosition{5}}, CommandBody{Action{"manual_move", "by 1"}},
          CommandBody{Action{"reference", "all"}}, CommandBody{Action{"traverse_until_input", "I1=1 by 1"}}}) {
        const Result r = b.ask(c);
        EXPECT_EQ(r.reason, Reason::wrong_state) << r.text;
    }
    EXPECT_TRUE(b.reported().empty());
}

TEST(PacontrolMotion, ReferenceRunBarsTheLineButForPolls) {
    Enabled b(2);
    b.control.axes[0].referenced = false;
    b.control.axes[0].position = 33;
    const Ticket home = b.command(Home{}, true, 0);
    const Ticket move = b.command(absolute(2000), true, 1);
    b.run(1s);
    EXPECT_TRUE(b.feedback(0).moving);
    EXPECT_FALSE(b.results.contains(home));
    std::size_t i = b.mark_at;
    while (i < b.sent.size() && b.sent[i].text != "0A84;1;0;0")
        ++i;
    ASSERT_LT(i + 5, b.sent.size());
    for (++i; i < b.sent.size(); ++i)
        EXPECT_EQ(b.sent[i].text, "EOT") << "only polls until the end of processing";
    EXPECT_GE(b.now - b.feedback(1).at, 900ms) << "nothing but polls may be sent: the other axis' position is as old as it is";
    EXPECT_EQ(b.answer(home).outcome, Outcome::done);
    EXPECT_TRUE(b.feedback(0).referenced);
    EXPECT_TRUE(b.feedback(0).homing_attained);
    EXPECT_EQ(b.feedback(0).position, 0);
    EXPECT_EQ(b.answer(move).outcome, Outcome::done) << "what waited goes on";
}

TEST(PacontrolMotion, HomingMethods) {
    Enabled b;
    b.control.axes[0].position = 7;
    EXPECT_EQ(b.ask(Home{35}, true).outcome, Outcome::done);
    EXPECT_EQ(b.reported(), (Lines{"0A96;1;1;0.0"}));
    EXPECT_EQ(b.feedback().position, 0);
    EXPECT_TRUE(b.feedback().homing_attained);
    EXPECT_EQ(b.ask(Home{17}).reason, Reason::not_supported);
    b.control.script = [](const Request& q) { return q.code == 0x0A84 ? FakeControl::refuse(0x2E) : FakeControl::Verdict{}; };
    const Result r = b.ask(Home{});
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.code, 46);
}

TEST(PacontrolMotion, AnEndOfProcessingThatTheFlagContradictsIsNoReference) {
    Enabled b;
    const Ticket home = b.command(Home{}, true);
    b.run(500ms);
    b.control.script = [](const Request& q) {
        return q.code == 0x1934 ? FakeControl::say(framed("0;1;31;0;0;0", CheckForm::with_etx)) : FakeControl::Verdict{};
    };
    const Result r = b.answer(home);
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_NE(r.text.find("not referenced"), std::string::npos) << r.text;
    EXPECT_TRUE(b.feedback().homing_error);
}

TEST(PacontrolMotion, SettingThePositionByG29OrG26) {
    Enabled b;
    EXPECT_EQ(b.ask(SetPosition{200000}).outcome, Outcome::accepted);
    EXPECT_EQ(b.reported(), (Lines{"0A86;1;1;200.0"}));
    EXPECT_EQ(b.feedback().position, 200000);
    Enabled g26(1, {{"set_position", "g26"}});
    EXPECT_TRUE(good(g26.ask(SetPosition{0})));
    EXPECT_TRUE(good(g26.ask(SetPosition{5000})));
    EXPECT_EQ(g26.reported(), (Lines{"0A85;1;0;0", "0A96;1;1;5.0"}));
}

TEST(PacontrolMotion, PreparedAxesAreStartedOneBehindTheOther) {
    Enabled b(3);
    for (std::uint16_t i = 0; i < 2; ++i) {
        Move m = absolute(5000);
        m.prepare_only = true;
        EXPECT_EQ(b.ask(m, false, i).outcome, Outcome::accepted);
    }
    EXPECT_TRUE(b.reported().empty()) << "nothing moves because it was prepared";
    EXPECT_EQ(b.ask(StartTogether{{AxisId{0}, AxisId{2}}}).reason, Reason::wrong_state);
    const Result r = b.ask(StartTogether{{AxisId{0}, AxisId{1}}});
    EXPECT_EQ(r.outcome, Outcome::accepted);
    EXPECT_NE(r.text.find("one behind the other"), std::string::npos);
    EXPECT_EQ(b.reported(), (Lines{"0A94;1;1;5.0", "0A94;2;1;5.0"}));
    EXPECT_TRUE(b.feedback(0).moving && b.feedback(1).moving);
}

TEST(PacontrolMotion, ManualMoveIsRenewedWellWithinASecondAndOnlyWhileItRuns) {
    Enabled b;
    const Ticket go = b.command(Action{"manual_move", "by 30"}, true);
    EXPECT_EQ(b.answer(go, 20s).outcome, Outcome::done);
    EXPECT_EQ(b.feedback().position, 30000) << "3 s of way need two renewals at least";
    Instant last = never;
    std::size_t renewals = 0;
    for (const auto& s : b.sent) {
        if (s.text == "0A91;1;1;30.0") last = s.at;
        if (s.text != "0A92;1;1;0") continue;
        EXPECT_LT(s.at - last, 900ms);
        last = s.at;
        ++renewals;
    }
    EXPECT_GE(renewals, 5u);
    const auto n = b.sent.size();
    b.run(3s);
    for (std::size_t i = n; i < b.sent.size(); ++i)
        EXPECT_NE(b.sent[i].text, "0A92;1;1;0");
}

TEST(PacontrolMotion, TraverseUntilInputSetsTheConditionTheOtherWayRound) {
    Enabled b;
    EXPECT_TRUE(good(b.action("traverse_until_input", "I5=0 to 200.0")));
    EXPECT_EQ(b.reported(), (Lines{"0AA3;1;0;16842757", "0A94;1;1;200.0"})) << "until 5 = 0 is while 5 = 1: 01 01 00 05h";
    b.run(500ms);
    b.control.axes[0].stop(b.now, 0);  // the condition ends it: in position as far as the control is concerned
    b.run(1s);
    EXPECT_FALSE(b.feedback().moving);
    EXPECT_FALSE(b.feedback().target_reached);
    EXPECT_NE(b.notice_text("motion").find("condition"), std::string::npos) << b.notice_text("motion");
    for (const char* bad : {"", "I5 to 3", "I0=1 to 3", "I1025=1 to 3", "X5=1 to 3", "I5=2 to 3", "I5=1 at 3", "I5=1 to x"})
        EXPECT_EQ(b.action("traverse_until_input", bad).reason, Reason::out_of_range) << bad;
}

TEST(PacontrolMotion, ReferencesOfSeveralAxesFollowTheirOrder) {
    Enabled b(4, {{"reference_order", "3,1"}});
    b.control.reference_time = 500ms;
    const Result r = b.ask(Action{"reference", "all"}, true);
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    EXPECT_EQ(b.reported(), (Lines{"0A84;3;0;0", "0A84;1;0;0", "0A84;2;0;0", "0A84;4;0;0"}));
    b.mark();
    EXPECT_TRUE(good(b.ask(Action{"reference", "2,4"}, true)));
    EXPECT_TRUE(good(b.ask(Action{"reference", "0x1"}, true)));
    EXPECT_TRUE(good(b.action("reference", "", 3)));
    EXPECT_EQ(b.reported(), (Lines{"0A84;2;0;0", "0A84;4;0;0", "0A84;1;0;0", "0A84;4;0;0"}));
    for (const char* bad : {"7", "0", "0x0", "all of them", "17"})
        EXPECT_EQ(b.action("reference", bad).reason, Reason::out_of_range) << bad;
}

TEST(PacontrolMotion, OverridesAndMeasuring) {
    Enabled b;
    EXPECT_TRUE(good(b.action("override.speed", "12.5")));
    EXPECT_TRUE(good(b.action("override.acceleration", "100")));
    EXPECT_EQ(b.reported(), (Lines{"0A8D;1;1;12.5", "0A8E;1;1;100.0"}));
    EXPECT_EQ(b.ask(absolute(100, 12500, 100000), true).outcome, Outcome::done);
    EXPECT_EQ(b.reported().back(), "0A94;1;1;0.1") << "known overrides are not sent again";
    EXPECT_TRUE(good(b.action("measure", "on")));
    b.run(1s);
    EXPECT_EQ(b.feedback().power, AxisFeedback::Power::off);
    EXPECT_EQ(b.ask(absolute(0)).reason, Reason::wrong_state);
    EXPECT_NE(b.enable().text.find("measuring"), std::string::npos);
    EXPECT_TRUE(good(b.action("measure", "off")));
    EXPECT_EQ(b.enable().outcome, Outcome::accepted) << "at once: what the status was does not count any more";
    EXPECT_TRUE(good(b.action("measure", "on")));
    EXPECT_EQ(b.ask(absolute(0)).reason, Reason::wrong_state) << "at once, too";
    EXPECT_TRUE(good(b.action("measure", "off")));
    b.run(1s);
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    EXPECT_EQ(b.action("delete_g29").reason, Reason::not_supported);
}

}  // namespace
}  // namespace axisgate::pacontrol::test
