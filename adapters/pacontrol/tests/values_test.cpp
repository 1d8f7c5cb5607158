// Points and native exchanges: elements, system and axis parameters with the home-position rule, frames in the control's own language.
#include "adapters/pacontrol/tests/fake_bench.hpp"

namespace axisgate::pacontrol::test {
namespace {

Result read(Bench& b, const std::string& id, std::uint16_t axis = 0) { return b.ask(ReadParameter{Bench::point(id)}, false, axis); }
Result write(Bench& b, const std::string& id, Value v, std::uint16_t axis = 0) {
    return b.ask(WriteParameter{Bench::point(id), std::move(v)}, false, axis);
}

TEST(PacontrolValues, ElementsOfEveryForm) {
    Bench b(2);
    b.start();
    b.control.inputs[5] = 1;
    b.mark();
    EXPECT_EQ(read(b, "I[5]").value, Value{true});
    EXPECT_EQ(write(b, "O[7]", true).value, Value{true});
    EXPECT_EQ(write(b, "MW[2]", std::int64_t{0x45F2}).outcome, Outcome::done);
    EXPECT_EQ(write(b, "N[3]", std::int64_t{-333}).value, Value{std::int64_t{-333}});
    EXPECT_EQ(write(b, "R[1]", 640.0).value, Value{640.0});
    EXPECT_EQ(read(b, "R[1]", 1).value, Value{640.0}) << "same point, same value, through any axis";
    EXPECT_EQ(b.reported(), (Lines{"1900;5;0;0", "0902;7;0;1", "0905;17;0;17906", "0906;3;0;-333", "0907;1;1;640.0", "1907;1;1;0"}))
        << "a word is named by an element inside it, a read of a real carries its type";
    const Result t = read(b, "T[1]");
    EXPECT_EQ(t.reason, Reason::not_supported);
    EXPECT_FALSE(t.text.empty());
    EXPECT_EQ(b.ask(ReadParameter{{999, 0}}).reason, Reason::unknown_point);
}

TEST(PacontrolValues, ADriveValueIsToldForEveryAxis) {
    Bench b(3);
    b.start();
    b.samples.clear();
    (void)write(b, "N[3]", std::int64_t{9});
    std::set<AxisId> reported;
    for (const auto& s : b.samples)
        if (s.point == Bench::point("N[3]")) reported.insert(s.axis);
    EXPECT_EQ(reported.size(), 3u);
}

TEST(PacontrolValues, AxisParametersAreOneDecimalNumberAndReal) {
    Bench b(3);
    b.start();
    b.control.axis_parameters[774] = 1234.5;
    b.mark();
    EXPECT_EQ(read(b, "AP6", 2).value, Value{1234.5});
    EXPECT_TRUE(good(write(b, "AP6", 0.1, 0)));
    EXPECT_TRUE(good(write(b, "SP2", std::int64_t{4}, 1)));
    EXPECT_EQ(b.reported(), (Lines{"1800;774;1;0", "0800;262;1;0.1", "0700;2;0;4"}));
}

TEST(PacontrolValues, TheHomePositionRuleRefusesWithItsReason) {
    Enabled b;
    b.mark();
    for (const Result& r : {read(b, "SP2"), read(b, "AP6"), write(b, "SP2", std::int64_t{1}), write(b, "AP6", 1.0)}) {
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_EQ(r.reason, Reason::wrong_state);
        EXPECT_NE(r.text.find("home position"), std::string::npos) << r.text;
        EXPECT_NE(r.text.find("31 (ONLINE)"), std::string::npos) << r.text;
    }
    EXPECT_TRUE(b.reported().empty());
    EXPECT_TRUE(good(write(b, "N[1]", std::int64_t{5}))) << "elements are open in every mode";
}

TEST(PacontrolValues, OrWaitsForHomePositionWithABound) {
    Enabled b(2, {{"when", "wait"}, {"when_timeout_ms", "5000"}});
    const Ticket t = b.command(WriteParameter{Bench::point("SP2"), Value{std::int64_t{3}}}, false, 0);
    const Ticket behind = b.command(ReadParameter{Bench::point("N[1]")}, false, 0);
    b.run(1s);
    EXPECT_FALSE(b.results.contains(t));
    EXPECT_FALSE(b.results.contains(behind)) << "commands of one axis keep their order";
    EXPECT_TRUE(good(read(b, "N[1]", 1))) << "the other axis is not held up";
    (void)b.command(Disable{}, false, 0);
    b.run(500ms);
    EXPECT_FALSE(b.results.contains(t)) << "an axis is on";
    EXPECT_EQ(b.control.mode, 31);
    (void)b.command(Disable{}, false, 1);
    b.run(500ms);
    EXPECT_EQ(b.control.mode, 1);
    ASSERT_TRUE(b.results.contains(t)) << "no axis is on any more: the control was given back for it";
    EXPECT_EQ(b.results.at(t).value, Value{std::int64_t{3}});
    EXPECT_TRUE(good(b.answer(behind)));
    EXPECT_EQ(b.enable(1).outcome, Outcome::accepted);
    const Result late = write(b, "SP2", std::int64_t{1});
    EXPECT_EQ(late.outcome, Outcome::refused);
    EXPECT_EQ(late.reason, Reason::wrong_state);
    EXPECT_NE(late.text.find("home position"), std::string::npos) << late.text;
}

TEST(PacontrolValues, ACommandErrorIsShownAsThat) {
    Bench b(1);
    b.control.error = 205;
    b.control.mode = 9;
    b.start();
    b.control.script = [](const Request& q) { return q.code == 0x0902 ? FakeControl::refuse(36) : FakeControl::Verdict{}; };
    const Result r = write(b, "O[1000]", true);
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::drive_refused);
    EXPECT_EQ(r.code, 36);
    EXPECT_NE(r.text.find("command error 36 (24h): inadmissible output"), std::string::npos) << r.text;
    EXPECT_NE(r.text.find("PA-CONTROL error E205"), std::string::npos) << "and the PA-CONTROL error beside it";
}

TEST(PacontrolValues, WhatThisTypeOfControlDoesNotHaveIsNotSupported) {
    Bench b(1);
    b.start();
    for (const std::uint16_t q : {quit::unknown_command, quit::not_executable}) {
        b.control.script = [q](const Request& r) { return r.code == 0x1906 ? FakeControl::refuse(q) : FakeControl::Verdict{}; };
        const Result r = read(b, "N[1]");
        EXPECT_EQ(r.reason, Reason::not_supported);
        EXPECT_EQ(r.code, q);
    }
}

TEST(PacontrolValues, WhatTheControlTookIsTheResult) {
    Bench b(1);
    b.start();
    b.control.script = [](const Request& q) {
        return q.code == 0x0906 ? FakeControl::say(framed("0;1;1;0;0;100", CheckForm::with_etx)) : FakeControl::Verdict{};
    };
    const Result r = write(b, "N[1]", std::int64_t{333});
    EXPECT_EQ(r.value, Value{std::int64_t{100}});
    EXPECT_NE(r.text.find("took 100"), std::string::npos) << r.text;
}

Result native(Bench& b, const std::string& text) {
    Native n;
    n.send.assign(text.begin(), text.end());
    return b.ask(n);
}
Result native_bytes(Bench& b, std::vector<std::uint8_t> bytes) {
    Native n;
    n.send = std::move(bytes);
    n.is_text = false;
    return b.ask(n);
}

TEST(PacontrolNative, TextIsFramedAndTheAnswerIsGivenAsItCame) {
    Bench b(1);
    b.start();
    b.control.inputs[5] = 1;
    const Result r = native(b, "1900;5;0;0");
    EXPECT_EQ(r.outcome, Outcome::done);
    EXPECT_EQ(r.text, "0;1;1;0;0;1");
    EXPECT_EQ(r.bytes,
              (std::vector<std::uint8_t>{1, 2, 0x30, 0x3B, 0x31, 0x3B, 0x31, 0x3B, 0x30, 0x3B, 0x30, 0x3B, 0x31, 3, 0x35, 0x37, 4}));
    EXPECT_EQ(native(b, "EOT").text, "0;1;1;0;0;1");
    EXPECT_EQ(native_bytes(b, {4}).outcome, Outcome::done);
    EXPECT_EQ(native_bytes(b, framed("1906;2;0;0", CheckForm::zero)).text, "0;1;1;0;0;0");
    const Result quit = native(b, "1906;2000;0;0");
    EXPECT_EQ(quit.outcome, Outcome::done) << "an answer is an answer";
    EXPECT_EQ(quit.code, 38);
    for (const char* bad : {"", "1900", "PR P", "1900;5;0;0;0"})
        EXPECT_EQ(native(b, bad).reason, Reason::out_of_range) << bad;
    EXPECT_EQ(native_bytes(b, {1, 2, 3}).reason, Reason::out_of_range);
    EXPECT_EQ(native_bytes(b, {4, 4}).reason, Reason::out_of_range);
}

TEST(PacontrolNative, AWaitingMoveBarsTheLineUntilItsEnd) {
    Enabled b(2);
    const Result r = native(b, "0A87;2;1;20.0");
    EXPECT_EQ(r.text, "0;0;31;0;1;0.0000") << "acknowledged at once, end of processing outstanding";
    b.mark();
    EXPECT_TRUE(good(read(b, "N[1]")));
    for (std::size_t i = b.mark_at; i + 1 < b.sent.size() && b.sent[i].text != "1906;1;0;0"; ++i)
        EXPECT_TRUE(b.sent[i].text == "EOT" || b.control.pending < 0) << b.sent[i].text;
    EXPECT_EQ(b.control.axes[1].position, 20);
}

TEST(PacontrolNative, TheMoveAndItsPollsAsTheManualShowsThem) {
    Enabled b(2);
    b.control.axes[1].max = 10000;
    b.control.axes[1].position = 1255;
    b.control.axes[1].speed = 1000;
    EXPECT_EQ(native(b, "0A87;2;1;5552.0").text, "0;0;31;0;1;1255.0000") << "the start position [L1447]";
    double last = 1255;
    for (int i = 0; i < 3; ++i) {
        b.run(1s);
        const Result r = native(b, "EOT");
        EXPECT_TRUE(r.text.starts_with("0;0;31;0;1;")) << r.text;
        const double p = real_of(std::string_view(r.text).substr(11)).value_or(0);
        EXPECT_GT(p, last);
        EXPECT_LT(p, 5552);
        last = p;
    }
    b.run(3s);
    EXPECT_EQ(b.control.axes[1].position, 5552);
    EXPECT_TRUE(good(b.ask(absolute(5000000), true, 1))) << "and the line is free again";
}

TEST(PacontrolActions, EveryCommandByItsName) {
    Enabled b(2);
    EXPECT_TRUE(good(b.action("cmd_put_no_reference", "", 1)));
    EXPECT_TRUE(good(b.action("0A8D", "2.5", 1)));
    EXPECT_EQ(b.action("cmd_get_int_reg", "17").value, Value{std::int64_t{0}});
    EXPECT_TRUE(good(b.action("cmd_put_int_reg", "17;99")));
    EXPECT_TRUE(good(b.action("put_limit_switch_monitoring_on_off", "0;0")));
    EXPECT_EQ(b.reported(), (Lines{"0A83;2;0;0", "0A8D;2;1;2.5", "1906;17;0;0", "0906;17;0;99", "0AA2;0;0;0"}));
    EXPECT_EQ(b.action("cmd_get_int_reg").reason, Reason::out_of_range);
    EXPECT_EQ(b.action("cmd_put_int_reg", "17;1.5").reason, Reason::out_of_range);
    EXPECT_EQ(b.action("0A94", "2;5", 0).reason, Reason::out_of_range) << "an axis is moved through itself";
    EXPECT_EQ(b.action("nothing").reason, Reason::unknown_point);
    EXPECT_EQ(b.action("online.stop", "now").reason, Reason::out_of_range);
}

}  // namespace
}  // namespace axisgate::pacontrol::test
