// Each freedom of the page: the simulated drive has it, and without it the same steps end otherwise.
#include <algorithm>
#include <cmath>

#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {
using Options = Bench::Options;
using Bytes = std::vector<std::uint8_t>;
constexpr std::int64_t slow = 100'000, rate = 1'000'000;  // 0.1 m/s, 10 m/s2

const char* ask_response = "01 11 03 02 01 00 04";

unsigned word(const Bytes& t, std::size_t at) { return static_cast<unsigned>(t.at(at) | t.at(at + 1) << 8); }
unsigned status_of(const Bytes& t) { return word(t, 7); }
unsigned state_var_of(const Bytes& t) { return word(t, 9); }
std::int32_t position_of(const Bytes& t) { return static_cast<std::int32_t>(word(t, 11) | word(t, 13) << 16); }
/// Everything that the drive sends in this time.
Bytes heard(Bench& b, Duration d) {
    b.late.clear();
    b.run(d);
    return b.late;
}
/// After how many milliseconds a telegram has arrived as a whole; -1: not within 20 s.
int answered_after(Bench& b, const Bytes& at_once, std::size_t size = 16) {
    b.late = at_once;
    for (int ms = 0; ms <= 20'000; ++ms) {
        if (b.late.size() >= size) return ms;
        b.run(1ms);
    }
    return -1;
}
/// The drive runs at once, whatever its boot and its answers are.
Bytes control(Bench& b, std::uint16_t cw) { return b.tell({0, 1, static_cast<std::uint8_t>(cw), static_cast<std::uint8_t>(cw >> 8)}); }
Bytes response(Bench& b) { return b.ask(ask_response); }

// --- those that all families share ----------------------------------------------------------------------------------------------
TEST(LinmotFreedoms, AnswersComeLateAndSpread) {
    Bench exact, late(Options{{"reply_ms", "40"}}), spread(Options{{"reply_ms", "40"}, {"reply_spread_ms", "50"}});
    EXPECT_EQ(answered_after(exact, response(exact)), 0);
    EXPECT_EQ(answered_after(late, response(late)), 40);
    int least = 1000, most = 0;
    for (int i = 0; i < 30; ++i) {
        const int ms = answered_after(spread, response(spread));
        least = std::min(least, ms), most = std::max(most, ms);
    }
    EXPECT_GE(least, 40);
    EXPECT_LE(most, 91);
    EXPECT_GT(most - least, 20);
}

TEST(LinmotFreedoms, AShareOfTheAnswersIsLateDoubledOrLost) {
    const auto counted = [](Options options) {
        Bench b(std::move(options));
        int late = 0;
        std::size_t bytes = 0;
        for (int i = 0; i < 200; ++i) {
            const std::size_t at_once = response(b).size();
            const std::size_t later = heard(b, 700ms).size();
            bytes += at_once + later;
            late += at_once == 0 && later > 0;
        }
        return std::pair(late, bytes / 16);
    };
    EXPECT_EQ(counted({}), std::pair(0, std::size_t{200}));
    const auto [late, all] = counted({{"late_per_mille", "200"}, {"late_ms", "600"}});
    EXPECT_GT(late, 15);
    EXPECT_LT(late, 80);
    EXPECT_EQ(all, 200u);
    EXPECT_GT(counted({{"doubled_per_mille", "200"}}).second, 215u);
    EXPECT_LT(counted({{"lost_per_mille", "30"}}).second, 200u);
}

TEST(LinmotFreedoms, ALostTelegramHasItsEffect) {
    Bench b(Options{{"lost_per_mille", "30"}});
    (void)control(b, 0x3E);
    (void)control(b, 0x3F);
    b.run(400ms);
    Bytes t;
    for (int i = 0; i < 20 && t.empty(); ++i)
        t = response(b);
    EXPECT_EQ(state_var_of(t) >> 8, 8u);
}

TEST(LinmotFreedoms, TelegramsArriveInRunsWithNoiseBefore) {
    Bench b(Options{{"chunk_bytes", "5"}, {"chunk_pause_ms", "10"}});
    EXPECT_EQ(response(b).size(), 5u);
    EXPECT_EQ(heard(b, 9ms).size(), 0u);
    EXPECT_EQ(heard(b, 1ms).size(), 5u);
    EXPECT_EQ(heard(b, 20ms).size(), 6u);
    Bench noisy(Options{{"noise_per_mille", "50"}});
    std::size_t bytes = 0;
    for (int i = 0; i < 200; ++i)
        bytes += response(noisy).size();
    EXPECT_GT(bytes, 200u * 16);
    EXPECT_LT(bytes, 200u * 16 + 50);
}

TEST(LinmotFreedoms, ItBootsAndIsSilentWhileItWritesItsMemory) {
    Bench b(Options{{"boot_ms", "2000"}});
    b.run(1999ms);
    EXPECT_TRUE(response(b).empty());
    b.run(2ms);
    EXPECT_EQ(response(b).size(), 16u);
    const Bytes write{1, 0x05, 0xC7, 0x13, 5, 0, 0, 0};  // 13C7h in ROM
    Bench at_once, flash(Options{{"flash_silence_ms", "1000"}});
    EXPECT_EQ(answered_after(at_once, at_once.tell(write), 14), 0);
    EXPECT_EQ(answered_after(flash, flash.tell(write), 14), 1000);
}

// --- the software ---------------------------------------------------------------------------------------------------------------
TEST(LinmotFreedoms, AfterAResetItSleeps) {
    for (const auto& [value, ms] : {std::pair{"3000", 3000ms}, {"9000", 9000ms}}) {
        Bench b(Options{{"restart_ms", value}});
        EXPECT_EQ(b.ask("01 11 03 02 02 06 04").size(), 16u) << "the answer of the reset comes at once";
        b.run(ms - 1ms);
        EXPECT_TRUE(response(b).empty()) << value;
        b.run(2ms);
        EXPECT_EQ(response(b).size(), 16u) << value;
    }
}

TEST(LinmotFreedoms, TheHardwareTestsTakeTheirTime) {
    Bench b(Options{{"hardware_test_ms", "2000"}});
    b.control(0x3E);
    b.control(0x3F);
    b.run(1999ms);
    EXPECT_EQ(b.state(), 5);
    b.run(1ms);
    EXPECT_EQ(b.state(), 8);
}

TEST(LinmotFreedoms, TheCountIsThatOfAMasterBefore) {
    Bench b(Options{{"first_count", "7"}});
    b.enable();
    EXPECT_EQ(b.sub() & 0x0F, 7);
    b.count = 6;  // the next command has the count 7, and is nothing new
    b.motion("010xh", {50'000, slow, rate, rate});
    b.run(1s);
    EXPECT_EQ(b.position(), 0);
    b.motion("010xh", {50'000, slow, rate, rate});
    b.run(1s);
    EXPECT_EQ(b.position(), 50'000);
    Bench none;
    none.enable();
    EXPECT_EQ(none.sub() & 0x0F, 0);
}

TEST(LinmotFreedoms, EnablingSetsTheCountToZero) {
    const auto count_after = [](Options options) {
        Bench b(std::move(options));
        b.enable();
        b.motion("010xh", {0, slow, rate, rate});
        b.motion("010xh", {0, slow, rate, rate});
        b.control(0x3E);
        b.enable();
        return b.sub() & 0x0F;
    };
    EXPECT_EQ(count_after({}), 2);
    EXPECT_EQ(count_after({{"count_at_enable", "1"}}), 0);
}

// --- the response ---------------------------------------------------------------------------------------------------------------
TEST(LinmotFreedoms, TheResponseIsReconfigured) {
    EXPECT_EQ(Bench().ask(ask_response).size(), 16u);
    EXPECT_EQ(Bench(Options{{"response_content", "1"}}).ask(ask_response).size(), 20u);
    EXPECT_EQ(Bench(Options{{"response_content", "3"}}).ask(ask_response).size(), 12u);
    Bench all(Options{{"response_content", "2"}});
    (void)all.hand("current", Value{std::int64_t{1234}});
    (void)all.hand("position", Value{std::int64_t{555}});
    const Bytes t = response(all);
    ASSERT_EQ(t.size(), 24u);
    EXPECT_EQ(t[2], 20) << "the length";
    EXPECT_EQ(position_of(t), 555);
    EXPECT_EQ(word(t, 15), 555u) << "the demand of a drive without power";
    EXPECT_EQ(word(t, 19), 1234u);
    EXPECT_EQ(word(t, 21), 0x80u) << "not homed";
    EXPECT_EQ(all.ask("01 11 05 02 00 03 93 1B 04").size(), 28u) << "a RAM value comes after all of it";
}

TEST(LinmotFreedoms, TheWarnWordAndRamAreAnsweredOtherwiseOrNotAtAll) {
    const char* warn = "01 11 03 02 03 00 04";
    const char* ram = "01 11 05 02 00 03 93 1B 04";
    EXPECT_EQ(Bench().ask(warn).size(), 20u);
    EXPECT_EQ(Bench(Options{{"warn_answer", "1"}}).ask(warn).size(), 18u);
    EXPECT_TRUE(Bench(Options{{"warn_answer", "2"}}).ask(warn).empty());
    EXPECT_EQ(Bench().ask(ram).size(), 20u);
    EXPECT_TRUE(Bench(Options{{"ram_access", "0"}}).ask(ram).empty());
}

TEST(LinmotFreedoms, ParametersAreNotDescribed) {
    Bench full, bare(Options{{"parameter_info", "0"}});
    for (std::uint8_t sub = 3; sub <= 7; ++sub) {
        EXPECT_EQ(full.tell({sub, 5, 0xC7, 0x13}).size(), 14u);
        EXPECT_TRUE(bare.tell({sub, 5, 0xC7, 0x13}).empty()) << int{sub};
    }
    EXPECT_EQ(bare.tell({0, 5, 0xC7, 0x13}).size(), 14u) << "its value is";
}

TEST(LinmotFreedoms, SurplusBytesAreRefused) {
    Bench b, strict(Options{{"exact_length", "1"}});
    EXPECT_EQ(b.tell({1, 0, 0, 0}).size(), 16u);
    EXPECT_TRUE(strict.tell({1, 0, 0, 0}).empty());
    EXPECT_TRUE(strict.tell({0, 1, 0x3E, 0, 0}).empty());
    EXPECT_EQ(strict.tell({0, 1, 0x3E, 0}).size(), 16u);
}

TEST(LinmotFreedoms, ARequestThatComesTooSoonIsNotHeard) {
    Bench b(Options{{"request_pause_ms", "50"}});
    EXPECT_EQ(response(b).size(), 16u);
    b.run(49ms);
    EXPECT_TRUE(response(b).empty());
    b.run(1ms);
    EXPECT_EQ(response(b).size(), 16u);
    Bench exact;
    EXPECT_EQ(response(exact).size(), 16u);
    EXPECT_EQ(response(exact).size(), 16u);
}

// --- late words -----------------------------------------------------------------------------------------------------------------
TEST(LinmotFreedoms, TheStateWordIsLateBehindTheCommand) {
    Bench b(Options{{"status_late_ms", "160"}});
    b.run(1s);
    (void)response(b);
    (void)control(b, 0x3E);
    EXPECT_EQ(b.state(), 2);
    EXPECT_EQ(state_var_of(response(b)) >> 8, 0u) << "as before";
    b.run(140ms);
    EXPECT_EQ(state_var_of(response(b)) >> 8, 0u);
    b.run(40ms);
    EXPECT_EQ(state_var_of(response(b)) >> 8, 2u);
    (void)control(b, 0x3F);
    b.run(1s);
    b.motion("010xh", {50'000, slow, rate, rate});
    EXPECT_EQ(state_var_of(response(b)) & 0x0F, 0u) << "the count is late, too";
    b.run(200ms);
    EXPECT_EQ(state_var_of(response(b)) & 0x0F, 1u);
    Bench exact;
    (void)control(exact, 0x3E);
    EXPECT_EQ(state_var_of(response(exact)) >> 8, 2u);
}

TEST(LinmotFreedoms, MotionActiveAndInTargetOfTheStatusWordAreLate) {
    const auto bits = [](Bench& b) {
        const Bytes t = response(b);
        EXPECT_EQ((state_var_of(t) & 0x20u) != 0, (b.sub() & 0x20) != 0) << "in StateVar they belong to the count [L201-206]";
        EXPECT_EQ((state_var_of(t) & 0x40u) != 0, (b.sub() & 0x40) != 0);
        return std::pair((status_of(t) & 0x2000u) != 0, (status_of(t) & 0x0400u) != 0);  // moves, in target
    };
    const std::pair rests{false, true}, moves{true, false};
    Bench exact;
    exact.enable();
    exact.motion("010xh", {150'000, slow, rate, rate});
    EXPECT_EQ(bits(exact), moves);
    Bench b(Options{{"motion_active_late_ms", "80"}, {"in_target_late_ms", "160"}});
    b.enable();
    b.run(1s);
    EXPECT_EQ(bits(b), rests);
    b.motion("010xh", {150'000, slow, rate, rate});  // it takes 160 ms
    EXPECT_EQ(bits(b), rests) << "the count has come, and the bits are those of before";
    EXPECT_EQ(b.sub() & 0x0F, 1);
    b.run(100ms);
    EXPECT_EQ(bits(b), std::pair(true, true));
    b.run(75ms);
    EXPECT_EQ(bits(b), moves);
    b.run(500ms);
    EXPECT_EQ(bits(b), rests);
}

TEST(LinmotFreedoms, WarningsAreLate) {
    const auto warns = [](Bench& b) {
        const Bytes t = b.ask("01 11 03 02 03 00 04");
        EXPECT_EQ((status_of(t) & 0x80u) != 0, word(t, 15) != 0);
        return (word(t, 15) & 0x40u) != 0;  // controller hot
    };
    for (const bool late : {false, true}) {
        Bench b(late ? Options{{"warn_late_ms", "320"}} : Options{});
        b.run(1s);
        (void)warns(b);
        (void)b.hand("temperature", Value{std::int64_t{72}});
        EXPECT_EQ(warns(b), !late);
        b.run(280ms);
        EXPECT_EQ(warns(b), !late);
        b.run(100ms);
        EXPECT_TRUE(warns(b));
    }
}

// --- jobs -----------------------------------------------------------------------------------------------------------------------
TEST(LinmotFreedoms, TheHomingHasStepsAndAnEndThatTakesTime) {
    Bench b(Options{{"homing_phases", "5"}, {"homing_check_ms", "1000"}});
    (void)b.hand("position", Value{std::int64_t{300'000}});
    b.enable();
    b.control(0x083F);
    std::vector<int> seen;
    for (int i = 0; i < 5000 && b.drive().state_var() != 0x090F; ++i) {
        if (seen.empty() || seen.back() != b.sub()) seen.push_back(b.sub());
        b.run(1ms);
    }
    EXPECT_EQ(seen, (std::vector<int>{1, 2, 3, 4, 5}));
    EXPECT_EQ(b.position(), 0);
    const Instant checked = b.now;
    Bench plain;
    (void)plain.hand("position", Value{std::int64_t{300'000}});
    plain.enable();
    plain.control(0x083F);
    EXPECT_EQ(plain.drive().state_var(), 0x0900);
    while (plain.drive().state_var() != 0x090F && plain.now < at_ns(60'000'000'000))
        plain.run(1ms);
    EXPECT_EQ(checked - plain.now, Duration(1000ms));
}

TEST(LinmotFreedoms, TheTableIsWrittenAndSavedSlowly) {
    const Bytes add{3, 8, 1, 0, 64, 0}, save{0, 8};
    Bench exact;
    EXPECT_EQ(exact.tell(add).size(), 14u);
    Bench b(Options{{"table_write_ms", "300"}, {"save_ms", "4000"}});
    EXPECT_EQ(answered_after(b, b.tell(add), 14), 300);
    EXPECT_EQ(b.tell({7, 8, 0, 0}).size(), 14u) << "a read is answered at once";
    EXPECT_EQ(answered_after(b, b.tell({4, 4, 1, 0, 70, 0, 8, 0}), 14), 300) << "curves, too";
    (void)b.tell({3, 6});  // stop of the software
    EXPECT_EQ(answered_after(b, b.tell(save), 14), 4000);
}

TEST(LinmotFreedoms, TheCurrentRisesInTime) {
    const auto current = [](Bench& b) { return word(b.ask("01 11 05 02 00 03 93 1B 04"), 15); };
    Bench b(Options{{"current_rise_ms", "400"}});
    (void)b.hand("current", Value{std::int64_t{2000}});
    EXPECT_EQ(current(b), 0u);
    b.run(100ms);
    EXPECT_EQ(current(b), 500u);
    b.run(400ms);
    EXPECT_EQ(current(b), 2000u);
    Bench exact;
    (void)exact.hand("current", Value{std::int64_t{2000}});
    EXPECT_EQ(current(exact), 2000u);
}

// --- unasked --------------------------------------------------------------------------------------------------------------------
TEST(LinmotFreedoms, AnotherMasterTalksToAnotherDrive) {
    EXPECT_TRUE(heard(*std::make_unique<Bench>(), 1s).empty());
    Bench b(Options{{"foreign_ms", "100"}});
    const Bytes all = heard(b, 250ms);
    ASSERT_EQ(all.size(), 2u * (7 + 16));
    EXPECT_EQ(Bytes(all.begin(), all.begin() + 7), bytes_of("01 91 03 02 01 00 04"));
    EXPECT_EQ(all[8], 0x91) << "an answer of the number 145";
    EXPECT_TRUE(b.hand("silent", Value{true}).empty());
    EXPECT_EQ(heard(b, 100ms).size(), 23u) << "this traffic is not its own";
    EXPECT_TRUE(b.hand("power", Value{false}).empty());
    EXPECT_TRUE(heard(b, 1s).empty());
}

TEST(LinmotFreedoms, ItAnswersWithoutARequest) {
    Bench b(Options{{"unsolicited_ms", "100"}});
    const Bytes all = heard(b, 250ms);
    ASSERT_EQ(all.size(), 32u);
    EXPECT_EQ(Bytes(all.begin(), all.begin() + 16), response(b));
}

// --- the whole ------------------------------------------------------------------------------------------------------------------
TEST(LinmotFreedoms, NamedSpecimensDifferAndASeedIsTheSameDriveAgain) {
    for (const auto name : named_specimens)
        EXPECT_GE(specimen_in_words(page(), specimen_values(page(), name)).size(), 2u) << name;
    EXPECT_TRUE(specimen_in_words(page(), specimen_values(page(), "0")).empty());
    const auto told = [] {
        Bench b(Options{{"specimen", "77"}});
        Bytes all;
        for (int i = 0; i < 50; ++i) {
            const Bytes now = response(b), later = heard(b, 50ms);
            all.insert(all.end(), now.begin(), now.end());
            all.insert(all.end(), later.begin(), later.end());
        }
        return all;
    };
    EXPECT_EQ(told(), told());
}

TEST(LinmotFreedoms, TheDefaultsOfThePageAreTheDriveWithoutFreedoms) {
    TwinSetup bare;
    bare.address = "17";
    const auto without = linmot::twin::make_twin(page(), bare);
    Bench with;
    Out out;
    Instant now = with.now;
    without->power_on({}, now, out);
    const auto both = [&](const char* hex) {
        Out one;
        without->on_frame(Frame::run(bytes_of(hex)), now, one);
        Bytes told;
        for (const auto& f : one.frames)
            told.insert(told.end(), f.frame.data().begin(), f.frame.data().end());
        EXPECT_EQ(told, with.ask(hex)) << hex;
    };
    for (const char* hex : {ask_response, "01 11 03 02 03 00 04", "01 11 05 02 00 01 3E 00 04", "01 11 05 02 00 01 3F 00 04",
                            "01 11 05 02 00 03 93 1B 04", "01 11 05 02 05 05 C7 13 04", "01 11 03 02 02 06 04"}) {
        both(hex);
        now += 500ms;
        Out one;
        without->on_deadline(now, one);
        with.run(500ms);
    }
}

}  // namespace
}  // namespace axisgate::linmot::test
