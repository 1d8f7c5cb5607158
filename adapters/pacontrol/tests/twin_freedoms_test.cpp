// The freedoms of the twin, part one: the line, the answers, the commands and the operating mode. Each test shows the difference that
// its freedom makes; specimen 0 is the twin without any.
#include "adapters/pacontrol/tests/twin_freedoms_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

const std::string acknowledged =
    "\x01\x02"
    "0;1;1;0;0;0\x03";  // the beginning of the answer to 1909 in home position

TEST(TwinFreedoms, SpecimenZeroIsTheTwinWithoutFreedoms) {
    Bench plain(setup(2)), zero(specimen_with({}));
    for (Bench* b : {&plain, &zero}) {
        b->online();
        b->good("0A94;1;1;100");
        for (int i = 0; i < 40; ++i) {
            b->pass(33ms);
            for (const char* text : {"190C;1;1;0", "1910;1;0;0", "1911;0;0;0", "1921;1;0;0", "190D;1;1;0", "190E;1;1;0", "1915;1;1;0"})
                (void)b->ask(text);
        }
        b->good("0A98;1;0;0");
        b->good("0A97;1;0;0");
        b->good("0A84;2;0;0");
        b->stand(2);
        (void)b->poll();
        b->home();
        b->bytes({1, 2, '1'});
        b->pass(2s);
    }
    EXPECT_EQ(plain.raw, zero.raw);
    EXPECT_EQ(plain.when, zero.when);
}

TEST(TwinFreedoms, EveryNamedSpecimenStartsOnlineAndMoves) {
    for (const auto name : named_specimens) {
        SCOPED_TRACE(name);
        TwinSetup s = setup(1);
        s.freedoms = specimen_values(freedoms_page(), name);
        EXPECT_FALSE(specimen_in_words(freedoms_page(), s.freedoms).empty());
        Wire w(s);
        w.pass(20s);
        const auto tell = [&](std::string_view text) {  // with the check that every one of them takes
            w.send(frame(text, "0"));
            w.pass(2s);
        };
        tell("0603;0;0;0");
        w.pass(3s);
        tell("0A83;1;0;0");  // without an absolute system it is not referenced
        tell("0A94;1;1;20");
        w.pass(5s);
        EXPECT_NEAR(w.twin().mechanics(1, w.now).position, 20'000, 50);
    }
}

// --- the line ---

TEST(TwinFreedoms, AnswersComeLate) {
    Wire w(specimen_with({{"reply_ms", 50}}));
    const Instant asked = w.now;
    w.ask("1909;0;0;0");
    w.pass(200ms);
    ASSERT_EQ(w.ends().size(), 1u);
    EXPECT_EQ(w.ends()[0] - asked, 50ms);
}

TEST(TwinFreedoms, AnswersComeDifferentlyLate) {
    Wire w(specimen_with({{"reply_spread_ms", 40}, {"late_per_mille", 20}, {"late_ms", 500}}));
    std::set<Duration> times;
    int late = 0;
    for (int i = 0; i < 500; ++i) {
        const Instant asked = w.now;
        w.ask("1909;0;0;0");
        w.pass(600ms);
        ASSERT_EQ(w.ends().size(), static_cast<std::size_t>(i) + 1);
        const Duration took = w.ends().back() - asked;
        times.insert(took);
        late += took >= 500ms;
        EXPECT_TRUE(took <= 40ms || (took >= 500ms && took <= 540ms));
    }
    EXPECT_GT(times.size(), 100u);
    EXPECT_GT(late, 2);
    EXPECT_LT(late, 30);
}

TEST(TwinFreedoms, AnswersAreLostAndNoiseComesBeforeThem) {
    Wire lossy(specimen_with({{"lost_per_mille", 20}})), noisy(specimen_with({{"noise_per_mille", 20}}));
    for (int i = 0; i < 500; ++i) {
        lossy.ask("1909;0;0;0");
        noisy.ask("1909;0;0;0");
        lossy.pass(10ms);
        noisy.pass(10ms);
    }
    EXPECT_LT(lossy.ends().size(), 500u);
    EXPECT_GT(lossy.ends().size(), 470u);
    const std::size_t whole = (acknowledged.size() + 3) * 500;
    EXPECT_GT(noisy.bytes.size(), whole);
    EXPECT_LT(noisy.bytes.size(), whole + 30);
}

TEST(TwinFreedoms, AnAnswerComesInRuns) {
    Wire w(specimen_with({{"chunk_bytes", 4}, {"chunk_pause_ms", 5}}));
    w.ask("1909;0;0;0");
    w.pass(200ms);
    EXPECT_TRUE(w.sent().starts_with(acknowledged));
    for (std::size_t i = 0; i < w.bytes.size(); ++i)
        EXPECT_EQ(w.bytes[i].at - w.bytes[0].at, (i / 4) * 5ms) << i;
}

TEST(TwinFreedoms, ItBoots) {
    Wire w(specimen_with({{"boot_ms", 700}, {"power_on_message", 1}}));
    w.ask("1909;0;0;0");
    w.pass(600ms);
    EXPECT_TRUE(w.bytes.empty());
    w.pass(200ms);
    ASSERT_EQ(w.ends().size(), 1u) << "its message, when it has booted";
    w.ask("1909;0;0;0");
    w.pass(10ms);
    EXPECT_EQ(w.ends().size(), 2u);
}

TEST(TwinFreedoms, MessagesAtPowerOn) {
    Wire frame(specimen_with({{"power_on_message", 1}})), text(specimen_with({{"power_on_message", 2}})), none(specimen_with({}));
    EXPECT_TRUE(frame.sent().starts_with(acknowledged));
    EXPECT_EQ(text.sent(), "PA-CONTROL V5.23\r\n");
    EXPECT_EQ(none.sent(), "");
    Out out;
    EXPECT_EQ(text.twin().set_hand("power", false, text.now, out), "");
    EXPECT_EQ(text.twin().set_hand("power", true, text.now, out), "");
    EXPECT_EQ(out.frames.size(), 1u);
}

TEST(TwinFreedoms, MessagesAtErrors) {
    Bench b(specimen_with({{"error_message", 1}})), without(specimen_with({}));
    for (Bench* x : {&b, &without}) {
        x->hand("inject_error", std::int64_t{150});
        x->hand("inject_error", std::int64_t{0});
    }
    ASSERT_EQ(b.raw.size(), 2u) << "one as it comes, one as it goes";
    EXPECT_NE(std::string(b.raw[0].begin(), b.raw[0].end()).find("0;1;9;150;0;0"), std::string::npos);
    EXPECT_TRUE(without.raw.empty());
}

// --- requests and answers ---

TEST(TwinFreedoms, ASilenceEndsARequest) {
    Bench b(specimen_with({{"frame_silence_ms", 50}})), zero(specimen_with({})), loud(specimen_with({{"frame_silence_answer", 1}}));
    const Bytes request = frame("1909;0;0;0");
    const Bytes head(request.begin(), request.begin() + 5), tail(request.begin() + 5, request.end());
    const auto in_two = [&](Bench& x, Duration between) {
        x.bytes(head);
        x.pass(between);
        return x.bytes(tail);
    };
    EXPECT_EQ(zero.one(in_two(zero, 60ms), "in time"), "0;1;1;0;0;0");
    EXPECT_EQ(b.one(in_two(b, 40ms), "in time"), "0;1;1;0;0;0");
    EXPECT_EQ(b.one(in_two(b, 60ms), "the rest is none"), "18;1;1;0;0;0");
    zero.bytes(head);
    zero.pass(2s);
    EXPECT_EQ(zero.raw.size(), 1u) << "nothing is said of it";
    loud.bytes(head);
    loud.pass(999ms);
    EXPECT_TRUE(loud.raw.empty());
    loud.pass(2ms);
    ASSERT_EQ(loud.raw.size(), 1u);
    EXPECT_NE(std::string(loud.raw[0].begin(), loud.raw[0].end()).find("17;1;1;0;0;0"), std::string::npos);
}

TEST(TwinFreedoms, ChecksOfRequestsAndAnswers) {
    const auto sent = [](std::int64_t form, const char* check) {
        Bench b(specimen_with({{"request_check_form", form}}));
        return Bench::fields(b.one(b.bytes(frame("1900;5;0;0", check)), check)).quit;
    };
    EXPECT_EQ(sent(0, "6"), 0);
    EXPECT_EQ(sent(0, "5"), 16);
    EXPECT_EQ(sent(1, "6"), 0);
    EXPECT_EQ(sent(1, "5"), 0);
    EXPECT_EQ(sent(2, "6"), 16);
    EXPECT_EQ(sent(2, "5"), 0);
    EXPECT_EQ(sent(2, "0"), 0);
    const auto received = [](std::int64_t form) {
        Wire w(specimen_with({{"reply_check_form", form}}));
        w.ask("1900;5;0;0");
        return w.sent().substr(w.sent().find('\x03') + 1);
    };
    EXPECT_EQ(received(0), "56\x04");  // of 0;1;1;0;0;0
    EXPECT_EQ(received(1), "59\x04");
    EXPECT_EQ(received(2), "0\x04");
}

TEST(TwinFreedoms, FormsOfRealNumbers) {
    const auto told = [](std::int64_t form, const std::string& value) {
        Bench b(specimen_with({{"real_form", form}}));
        const std::string text = b.ask("0907;1;1;" + value);
        return text.substr(text.rfind(';') + 1);
    };
    EXPECT_EQ(told(0, "640"), "640.0000");
    EXPECT_EQ(told(1, "640"), "640.000");
    EXPECT_EQ(told(2, "640"), "640.0");
    EXPECT_EQ(told(2, "-1.25"), "-1.25");
    EXPECT_EQ(told(1, "-0.0001"), "0.000");
    EXPECT_EQ(told(2, "-0.0001"), "0.0");
}

TEST(TwinFreedoms, PollsWithNothingInProgress) {
    Bench zero(specimen_with({})), empty(specimen_with({{"idle_poll", 1}})), none(specimen_with({{"idle_poll", 2}}));
    for (Bench* b : {&zero, &empty, &none})
        b->good("0906;1;0;77");
    EXPECT_EQ(zero.poll(), "0;1;1;0;0;77");
    EXPECT_EQ(empty.poll(), "0;1;1;0;0;0");
    EXPECT_TRUE(none.bytes({4}).empty());
    none.online();
    EXPECT_EQ(none.get("0A87;1;1;50").end, 0);
    none.stand(1);
    EXPECT_EQ(none.get_poll().end, 1) << "the end of processing is told once";
    EXPECT_TRUE(none.bytes({4}).empty());
}

TEST(TwinFreedoms, StoringAParameterTakesTime) {
    Wire w(specimen_with({{"parameter_store_ms", 300}}));
    const Instant asked = w.now;
    w.ask("0800;257;1;400.0");
    w.pass(100ms);
    w.ask("1909;0;0;0");  // not heard
    w.pass(500ms);
    ASSERT_EQ(w.ends().size(), 1u);
    EXPECT_EQ(w.ends()[0] - asked, 300ms);
    w.ask("0800;257;1;-1.0");
    w.pass(1ms);
    EXPECT_EQ(w.ends().size(), 2u) << "a refusal stores nothing";
}

TEST(TwinFreedoms, InputsAndOutputsAreScanned) {
    Bench b(specimen_with({{"io_scan_ms", 100}}));
    b.pass(110ms);
    EXPECT_EQ(b.value("1902;3;0;0"), 0);
    b.good("0902;3;0;1");
    b.hand("inputs", std::int64_t{4});
    EXPECT_EQ(b.value("1902;3;0;0"), 0);
    EXPECT_EQ(b.value("1900;3;0;0"), 0);
    b.pass(100ms);
    EXPECT_EQ(b.value("1902;3;0;0"), 1);
    EXPECT_EQ(b.value("1903;3;0;0"), 4);
    EXPECT_EQ(b.value("1900;3;0;0"), 1);
    EXPECT_EQ(b.value("1901;3;0;0"), 4 + 32768) << "with the wire of the external stop, input 16";
    b.pass(50ms);
    b.hand("inputs", std::int64_t{0});
    b.pass(60ms);
    EXPECT_EQ(b.value("1900;3;0;0"), 0) << "nobody has to ask for a scan to take place";
}

// --- commands and modes ---

TEST(TwinFreedoms, ItIsInitialised) {
    Bench b(specimen_with({{"initialise_ms", 500}}));
    EXPECT_EQ(b.get("1900;1;0;0").text, "52;1;0;0;0;0");
    EXPECT_EQ(b.get_poll().status, 0);
    b.pass(499ms);
    EXPECT_EQ(b.quit("0603;0;0;0"), 52);
    b.pass(1ms);
    EXPECT_EQ(b.status(), 1);
    b.good("0700;8;0;1");  // autostart
    b.hand("power", false);
    b.hand("power", true);
    EXPECT_EQ(b.get_poll().status, 0);
    b.pass(600ms);
    EXPECT_EQ(b.status(), 11);
}

TEST(TwinFreedoms, ChangesOfTheModeTakeTime) {
    Bench b(specimen_with({{"start_ms", 300}, {"home_ms", 400}}));
    EXPECT_EQ(b.get("0603;0;0;0").text, "0;0;30;0;0;0");
    b.pass(280ms);
    EXPECT_EQ(b.get_poll().status, 30);
    b.pass(20ms);
    EXPECT_EQ(b.get_poll().text, "0;1;31;0;0;0");
    EXPECT_EQ(b.get("0A81;0;0;0").text, "0;0;31;0;0;0");
    b.pass(380ms);
    EXPECT_EQ(b.get_poll().status, 31);
    b.pass(20ms);
    EXPECT_EQ(b.get_poll().text, "0;1;1;0;0;0");
}

TEST(TwinFreedoms, ItIsBusyAfterAChangeOfTheMode) {
    Bench b(specimen_with({{"busy_ms", 200}}));
    b.good("0603;0;0;0");
    EXPECT_EQ(b.quit("190C;1;1;0"), 21);
    EXPECT_EQ(b.get_poll().status, 31) << "polls are answered";
    b.pass(200ms);
    EXPECT_EQ(b.quit("190C;1;1;0"), 0);
    b.good("0600;0;0;0");
    EXPECT_EQ(b.quit("190C;1;1;0"), 21);
    b.good("0A81;0;0;0");
}

TEST(TwinFreedoms, CommandErrorInTheWrongMode) {
    Bench zero(specimen_with({})), b(specimen_with({{"wrong_mode_error", 21}}));
    EXPECT_EQ(zero.quit("0A94;1;1;5"), 20);
    EXPECT_EQ(b.quit("0A94;1;1;5"), 21);
}

TEST(TwinFreedoms, CommandsThatAreMissing) {
    Bench zero(specimen_with({}));
    Bench b(specimen_with({{"switching_commands", 0}, {"system_elements", 0}, {"ep_functions", 0}, {"measuring_mode", 0}}));
    Bench no_switch(specimen_with({{"switching_commands", 2}}));
    for (Bench* x : {&zero, &b, &no_switch})
        x->online();
    for (const char* text : {"0A96;1;1;0.0", "0A97;1;0;0", "0A98;1;0;0", "0A9A;1;0;0", "1934;51;0;0", "1935;10;0;0", "1937;51;1;0"}) {
        EXPECT_EQ(zero.quit(text), 0) << text;
        EXPECT_EQ(b.quit(text), 19) << text;
    }
    for (const char* text : {"190E;1;1;0", "190F;1;1;0", "1915;1;1;0", "1920;1;1;0"}) {
        EXPECT_EQ(no_switch.quit(text), 0) << text;
        EXPECT_EQ(b.quit(text), 21) << text;
    }
    EXPECT_EQ(no_switch.quit("0AA0;1;0;0"), 0);
    EXPECT_EQ(b.quit("0AA0;1;0;0"), 108);
    EXPECT_EQ(no_switch.quit("0A97;1;0;0"), 21);
    EXPECT_EQ(no_switch.quit("0A98;1;0;0"), 21);
    EXPECT_EQ(no_switch.quit("0A9A;1;0;0"), 0);
}

TEST(TwinFreedoms, OptionsSayItInTheirOwnWords) {
    Bench b(specimen_with({{"ep_functions", 0}, {"measuring_mode", 0}, {"absolute_system", 0}}, 1,
                          {{"model", "ep"}, {"measuring", "on"}, {"absolute", "on"}}));
    EXPECT_EQ(b.quit("190E;1;1;0"), 0);
    EXPECT_EQ(b.value("1934;51;0;0"), 1);
    b.online();
    EXPECT_EQ(b.quit("0AA0;1;0;0"), 0);
}

TEST(TwinFreedoms, OnlineDoesNotResume) {
    Bench zero(specimen_with({})), b(specimen_with({{"online_resumes", 0}}));
    for (Bench* x : {&zero, &b}) {
        x->online();
        x->good("0600;0;0;0");
        ASSERT_EQ(x->status(), 35);
    }
    EXPECT_EQ(zero.quit("0603;0;0;0"), 0);
    EXPECT_EQ(b.quit("0603;0;0;0"), 20);
    b.home();
    b.online();
}

TEST(TwinFreedoms, AFurtherCommandIsNotAnswered) {
    Bench b(specimen_with({{"excluded_command", 1}}));
    b.online();
    EXPECT_EQ(b.get("0A87;1;1;500").end, 0);
    EXPECT_TRUE(b.bytes(frame("190C;1;1;0")).empty());
    b.pass(50ms);
    EXPECT_EQ(b.get_poll().end, 0) << "the move goes on";
    EXPECT_EQ(b.quit("0A93;1;0;0"), 0) << "a stop is taken";
}

TEST(TwinFreedoms, ErrorsAreShownAndClearedLate) {
    Bench b(specimen_with({{"error_shown_ms", 200}, {"error_cleared_ms", 600}}));
    b.hand("inject_error", std::int64_t{150});
    EXPECT_EQ(b.get("1909;0;0;0").text, "0;1;1;0;0;0");
    EXPECT_EQ(b.quit("0603;0;0;0"), 21) << "it is there all the same";
    b.pass(200ms);
    EXPECT_EQ(b.get("1909;0;0;0").text, "0;1;9;150;0;150");
    b.good("0909;0;0;0");
    b.pass(599ms);
    EXPECT_EQ(b.get("1935;10;0;0").text, "0;1;9;150;0;150");
    b.pass(1ms);
    EXPECT_EQ(b.get("1909;0;0;0").text, "0;1;1;0;0;0");
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
