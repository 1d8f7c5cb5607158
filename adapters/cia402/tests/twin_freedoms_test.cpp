// The freedoms of the simulated CiA 402 drive, one by one, on the bus: what differs, and that the drive of the manual does not.
#include <algorithm>

#include "adapters/cia402/tests/free_bench.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using namespace std::chrono_literals;
using canopen::Abort;
using canopen::NmtCommand;

TEST(Cia402Freedoms, TheHandChangesEachOfThemWithinItsRange) {
    for (const Freedom& f : page().freedoms()) {
        SCOPED_TRACE(f.name);
        FreeBench b;
        if (f.name == "flash_silence_ms") {
            EXPECT_NE(b.be(f.name, 1), "") << "the drive does not know of it";
            continue;
        }
        EXPECT_EQ(b.be(f.name, f.max), "");
        EXPECT_NE(b.be(f.name, f.max + 1), "");
        EXPECT_NE(b.be(f.name, f.min - 1), "");
        EXPECT_EQ(b.be(f.name, f.fallback), "");
    }
    FreeBench b;
    EXPECT_NE(b.be("most_acceleration", 12'345), "") << "not one of the page's values";
    EXPECT_NE(b.be("reply_ms", 1), "") << "not on the page";
}

// --- words, modes and their instants -----------------------------------------------------------------------------------------

TEST(Cia402Freedoms, TheControlWordIsSampled) {
    FreeBench b({{"control_sample_ms", 10}});
    b.word(0x06);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u);
    b.pass(10ms);
    EXPECT_EQ(b.status() & 0x6Fu, 0x21u);
    b.word(0x07);
    b.word(0x06);
    b.pass(10ms);
    EXPECT_EQ(b.status() & 0x6Fu, 0x21u) << "7 stood there between two samples";
}

TEST(Cia402Freedoms, AModeIsShownLate) {
    FreeBench b({{"mode_shown_ms", 500}});
    ASSERT_EQ(b.write(0x6060, 0, 3, 1), Abort::none);
    b.pass(499ms);
    EXPECT_EQ(b.read(0x6061), 1);
    b.pass(1ms);
    EXPECT_EQ(b.read(0x6061), 3);
}

TEST(Cia402Freedoms, AModeIsRefusedWhileTheHaltBitIsSetOrWhileItMoves) {
    for (const int refusal : {0, 1, 2, 3}) {
        for (const bool silent : {false, true}) {
            SCOPED_TRACE(std::to_string(refusal) + (silent ? " silent" : ""));
            FreeBench b({{"mode_refusal", refusal}, {"mode_refusal_silent", silent ? 1 : 0}});
            const auto takes = [&](bool should) {
                EXPECT_EQ(b.write(0x6060, 0, 3, 1), should || silent ? Abort::none : Abort::device_state);
                EXPECT_EQ(b.read(0x6061), should ? 3 : 1);
                if (should) EXPECT_EQ(b.write(0x6060, 0, 1, 1), Abort::none);
            };
            b.enable(1);
            b.word(0x10F);
            takes((refusal & 1) == 0);
            b.word(0x0F);
            if (silent) {
                EXPECT_EQ(b.write(0x6060, 0, 1, 1), Abort::none);
            }
            b.move_to(50'000);
            b.pass(500ms);
            const bool moving = (refusal & 2) == 0;
            EXPECT_EQ(b.write(0x6060, 0, 3, 1), moving || silent ? Abort::none : Abort::device_state);
            EXPECT_EQ(b.read(0x6061), moving ? 3 : 1);
            b.pass(20s);
            EXPECT_EQ(b.write(0x6060, 0, 3, 1), Abort::none) << "it stands";
            EXPECT_EQ(b.read(0x6061), 3);
        }
    }
}

TEST(Cia402Freedoms, ASetPointIsAcknowledgedNeverAtOnceOrWhenItIsTaken) {
    for (const int how : {0, 1, 2}) {
        SCOPED_TRACE(how);
        FreeBench b({{"acknowledges", how}});
        b.enable(1);
        b.move_to(20'000);
        EXPECT_EQ((b.status() & 0x1000u) != 0, how != 0) << "nothing is in progress: it is taken at once";
        b.move_to(30'000);
        EXPECT_EQ((b.status() & 0x1000u) != 0, how == 1) << "it waits for the end of the first";
        b.pass(2100ms);
        EXPECT_EQ((b.status() & 0x1000u) != 0, how == 1);
        b.pass(400ms);
        EXPECT_EQ((b.status() & 0x1000u) != 0, how != 0) << "the second is the target now";
        b.pass(3s);
        EXPECT_EQ(b.place(), 30'000) << "it moves in any case";
    }
}

TEST(Cia402Freedoms, AnAcknowledgementIsLate) {
    FreeBench b({{"acknowledge_ms", 300}});
    b.enable(1);
    b.move_to(20'000);
    b.pass(299ms);
    EXPECT_EQ(b.status() & 0x1000u, 0u);
    b.pass(1ms);
    EXPECT_NE(b.status() & 0x1000u, 0u);
}

TEST(Cia402Freedoms, Bits10And12And13AreSetLateAndClearedAtOnce) {
    FreeBench b({{"status_bits_ms", 200}});
    ASSERT_EQ(b.write(0x6098, 0, 35, 1), Abort::none);
    b.enable(6);
    const auto late = [&](unsigned bits) {
        EXPECT_EQ(b.status() & bits, 0u);
        b.pass(199ms);
        EXPECT_EQ(b.status() & bits, 0u);
        b.pass(1ms);
        EXPECT_EQ(b.status() & bits, bits);
    };
    b.word(0x1F);
    late(0x1400);
    b.word(0x0F);
    ASSERT_EQ(b.write(0x6098, 0, 1, 1), Abort::none);
    b.word(0x1F);
    EXPECT_EQ(b.status() & 0x1400u, 0u) << "at once";
    late(0x2000);
    ASSERT_EQ(b.write(0x6060, 0, 1, 1), Abort::none);
    b.move_to(1000);
    EXPECT_NE(b.status() & 0x1000u, 0u) << "the acknowledgement of mode 1 has its own freedom";
    b.pass(10ms);
    while (b.place() != 1000)
        b.pass(1ms);
    EXPECT_EQ(b.status() & 0x400u, 0u);
    b.pass(200ms);
    EXPECT_NE(b.status() & 0x400u, 0u);
    b.move_to(2000);
    EXPECT_EQ(b.status() & 0x400u, 0u) << "at once";
}

// --- PDOs and identifiers ----------------------------------------------------------------------------------------------------

TEST(Cia402Freedoms, PdosAreSetUpInEachStateInPreOperationalOrNotAtAll) {
    for (const int setup : {0, 1, 2, 3, 4}) {
        SCOPED_TRACE(setup);
        FreeBench b({{"pdo_setup", setup}});
        const Abort absent = setup == 4 ? Abort::no_object : Abort::none;
        EXPECT_EQ(b.write(0x1A01, 0, 0, 1), setup == 3 ? Abort::read_only : absent);
        EXPECT_EQ(b.write(0x1801, 2, 1, 1), absent);
        b.nmt(NmtCommand::start);
        EXPECT_EQ(b.write(0x1A01, 0, 0, 1), setup == 0   ? Abort::none
                                            : setup < 3  ? Abort::device_state
                                            : setup == 3 ? Abort::read_only
                                                         : absent);
        EXPECT_EQ(b.write(0x1801, 2, 2, 1), setup == 2 ? Abort::device_state : absent);
        b.out.clear();
        b.send(canopen::data_frame(0x205, std::vector<std::uint8_t>{0x06, 0}));
        EXPECT_EQ(b.count(0x185) > 0, setup != 4);
        EXPECT_EQ(b.status() & 0x6Fu, setup == 4 ? 0x40u : 0x21u) << "without PDOs the control word by PDO is not received";
    }
}

TEST(Cia402Freedoms, TransmissionTypesAreFixed) {
    for (const int fixed : {0, 1}) {
        FreeBench b({{"pdo_types_fixed", fixed}});
        EXPECT_EQ(b.write(0x1800, 2, 1, 1), fixed ? Abort::read_only : Abort::none);
        EXPECT_EQ(b.write(0x1403, 2, 1, 1), fixed ? Abort::read_only : Abort::none);
        EXPECT_EQ(b.read(0x1800, 2) & 0xFF, fixed ? 255 : 1);
    }
}

TEST(Cia402Freedoms, TheFirstMappingsAreThoseOfTheDriveOrOfTheProfile) {
    FreeBench own, usual({{"pdo_defaults", 1}});
    EXPECT_EQ(own.read(0x1A01, 0), 1);
    EXPECT_EQ(own.read(0x1A01, 1), 0x60640020);
    constexpr std::int64_t transmit[] = {0, 0x60610008, 0x60640020, 0x606C0020}, receive[] = {0, 0x60600008, 0x607A0020, 0x60FF0020};
    for (int n = 0; n < 4; ++n) {
        SCOPED_TRACE(n);
        EXPECT_EQ(usual.read(static_cast<std::uint16_t>(0x1A00 + n), 0), n == 0 ? 1 : 2);
        EXPECT_EQ(usual.read(static_cast<std::uint16_t>(0x1A00 + n), 1), 0x60410010);
        EXPECT_EQ(usual.read(static_cast<std::uint16_t>(0x1A00 + n), 2), transmit[n]);
        EXPECT_EQ(usual.read(static_cast<std::uint16_t>(0x1600 + n), 0), n == 0 ? 1 : 2);
        EXPECT_EQ(usual.read(static_cast<std::uint16_t>(0x1600 + n), 1), 0x60400010);
        EXPECT_EQ(usual.read(static_cast<std::uint16_t>(0x1600 + n), 2), receive[n]);
    }
}

TEST(Cia402Freedoms, SingleObjectsCannotBeMapped) {
    constexpr std::pair<int, std::int64_t> objects[] = {{1, 0x60610008}, {2, 0x606C0020}, {4, 0x60620020}};
    for (const int mask : {0, 1, 2, 4, 7}) {
        SCOPED_TRACE(mask);
        FreeBench b({{"unmappable", mask}});
        ASSERT_EQ(b.write(0x1A01, 0, 0, 1), Abort::none);
        for (const auto& [bit, word] : objects) {
            EXPECT_EQ(b.write(0x1A01, 1, word, 4), (mask & bit) != 0 ? Abort::not_mappable : Abort::none);
            EXPECT_NE(b.read(static_cast<std::uint16_t>(word >> 16)), -1) << "it exists";
        }
        EXPECT_EQ(b.write(0x1A01, 1, 0x60410010, 4), Abort::none);
    }
}

TEST(Cia402Freedoms, AnIdentifierIsChangedOnlyWhileItIsInvalid) {
    for (const int strict : {0, 1, 2}) {
        SCOPED_TRACE(strict);
        FreeBench b({{"strict_cob_id", strict}});
        EXPECT_EQ(b.write(0x1800, 1, 0x186, 4), strict == 0 ? Abort::none : Abort::value);
        ASSERT_EQ(b.write(0x1800, 1, b.read(0x1800, 1), 4), Abort::none) << "no change";
        EXPECT_EQ(b.write(0x1800, 1, 0x80000187, 4), strict < 2 ? Abort::none : Abort::value);
        ASSERT_EQ(b.write(0x1800, 1, (b.read(0x1800, 1) & 0x7FF) | 0x80000000, 4), Abort::none);
        EXPECT_EQ(b.write(0x1800, 1, 0x80000188, 4), Abort::none);
        EXPECT_EQ(b.write(0x1800, 1, 0x189, 4), Abort::none);
        EXPECT_EQ(b.write(0x1014, 0, 0x90, 4), strict == 0 ? Abort::none : Abort::value) << "EMCY";
    }
}

TEST(Cia402Freedoms, AMappingIsChangedInTheOrderOfTheStandard) {
    for (const bool strict : {false, true}) {
        FreeBench b({{"strict_mapping", strict ? 1 : 0}});
        const Abort wrong = strict ? Abort::device_state : Abort::none;
        EXPECT_EQ(b.write(0x1A00, 0, 0, 1), wrong) << "the PDO is enabled";
        ASSERT_EQ(b.write(0x1800, 1, 0x80000185, 4), Abort::none);
        ASSERT_EQ(b.write(0x1A00, 0, 1, 1), Abort::none);
        EXPECT_EQ(b.write(0x1A00, 1, 0x60640020, 4), wrong) << "it has entries";
        EXPECT_EQ(b.write(0x1A00, 0, 0, 1), Abort::none);
        EXPECT_EQ(b.write(0x1A00, 1, 0x60640020, 4), Abort::none);
        EXPECT_EQ(b.write(0x1A00, 0, 1, 1), Abort::none);
        ASSERT_EQ(b.write(0x1800, 1, 0x185, 4), Abort::none);
    }
}

TEST(Cia402Freedoms, FurtherTpdosAreOnAtPowerOn) {
    for (const int extra : {0, 1, 3}) {
        SCOPED_TRACE(extra);
        FreeBench b({{"extra_tpdos", extra}});
        b.nmt(NmtCommand::start);
        b.out.clear();
        b.run(200ms);
        EXPECT_EQ(b.count(0x285), extra >= 1 ? 4u : 0u) << "the position";
        EXPECT_EQ(b.count(0x385), extra >= 2 ? 4u : 0u) << "the velocity";
        EXPECT_EQ(b.count(0x485), extra >= 3 ? 4u : 0u) << "the torque";
        if (extra == 0) continue;
        ASSERT_EQ(b.write(0x1801, 1, 0x80000285, 4), Abort::none) << "a master may switch it off";
        b.out.clear();
        b.run(200ms);
        EXPECT_EQ(b.count(0x285), 0u);
    }
}

// --- objects ------------------------------------------------------------------------------------------------------------------

TEST(Cia402Freedoms, AnObjectThatTheDriveLacksIsRefusedAndNotMapped) {
    struct Object {
        const char* freedom;
        std::uint16_t index;
        std::uint8_t sub;
        std::uint32_t mapped;
    };
    for (const Object& o : {Object{"has_6062h", 0x6062, 0, 0x60620020}, Object{"has_606ch", 0x606C, 0, 0x606C0020},
                            Object{"has_6502h", 0x6502, 0, 0}, Object{"has_605ah", 0x605A, 0, 0}, Object{"has_1016h", 0x1016, 1, 0},
                            Object{"has_60c2h", 0x60C2, 1, 0}, Object{"has_1010h", 0x1010, 1, 0}}) {
        SCOPED_TRACE(o.freedom);
        FreeBench b({{o.freedom, 0}}), all;
        const auto refused = [&](FreeBench& of) {
            const Frame f = of.sdo(0x40, {o.index, o.sub});
            return f.storage[0] == 0x80 ? static_cast<Abort>(canopen::value_of(f)) : Abort::none;
        };
        EXPECT_EQ(refused(b), Abort::no_object);
        EXPECT_EQ(refused(all), Abort::none);
        if (o.mapped != 0) {
            ASSERT_EQ(b.write(0x1A03, 0, 0, 1), Abort::none);
            EXPECT_EQ(b.write(0x1A03, 1, o.mapped, 4), Abort::no_object);
            ASSERT_EQ(all.write(0x1A03, 0, 0, 1), Abort::none);
            EXPECT_EQ(all.write(0x1A03, 1, o.mapped, 4), Abort::none);
        } else {
            const int size = o.index == 0x605A ? 2 : o.index == 0x60C2 ? 1 : 4;
            const std::int64_t value = o.index == 0x1010 ? 0x65766173 : o.index == 0x605A ? 6 : 10;
            EXPECT_EQ(b.write(o.index, o.sub, value, size), o.index == 0x6502 ? Abort::read_only : Abort::no_object);
        }
        EXPECT_EQ(b.be(o.freedom, 1), "");
        EXPECT_EQ(refused(b), Abort::none);
    }
    FreeBench b({{"has_606ch", 0}});
    EXPECT_EQ(b.read(0x1A02, 0), 0) << "the maker's mapping does not contain it either";
}

TEST(Cia402Freedoms, MemoryOfAnObjectThatTheDriveLacksDoesNotCount) {
    FreeBench b({{"has_605ah", 0}});
    b.twin->power_on({{"605A:00", Value{std::int64_t{6}}}}, b.now, b.out);
    b.enable(1);
    b.word(0x0B);
    b.pass(1ms);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "a quick stop ends off";
}

TEST(Cia402Freedoms, WithoutTheInterpolationTimeATargetIsReachedInTheTimeOfASync) {
    for (const int has : {0, 1}) {
        FreeBench b({{"has_60c2h", has}});
        b.begin_stream();
        for (int i = 0; i < 20; ++i) {
            b.pass(10ms);
            b.lead(100 * i);
            b.sync();
        }
        EXPECT_NEAR(1'900 - b.place(), has ? 200 : 100, 10) << "60C2h is 20 ms: each target is reached by half";
    }
}

// --- messages -----------------------------------------------------------------------------------------------------------------

TEST(Cia402Freedoms, AnSdoAnswerTakesItsTime) {
    FreeBench b({{"sdo_answer_ms", 150}});
    b.out.clear();
    b.send(canopen::sdo_frame(0x605, 0x40, {0x6041, 0}));
    b.pass(149ms);
    EXPECT_EQ(b.count(0x585), 0u);
    b.pass(1ms);
    EXPECT_EQ(b.count(0x585), 1u);
}

TEST(Cia402Freedoms, AnEmergencyComesBeforeOrAfterTheStatusWord) {
    for (const bool after : {false, true}) {
        FreeBench b({{"emcy_after_status", after ? 1 : 0}});
        b.nmt(NmtCommand::start);
        b.enable(1);
        b.out.clear();
        ASSERT_EQ(b.twin->set_hand("inject_error", Value{std::int64_t{0x2310}}, b.now, b.out), "");
        const std::vector<std::uint32_t> first{0x85, 0x185}, last{0x185, 0x85};
        EXPECT_EQ(b.ids(), after ? last : first);
    }
}

TEST(Cia402Freedoms, AHeartbeatIsLateByADifferentTimeEach) {
    for (const int jitter : {0, 30}) {
        FreeBench b({{"heartbeat_jitter_ms", jitter}});
        ASSERT_EQ(b.write(0x1017, 0, 100, 2), Abort::none);
        const Instant begin = b.now;
        b.out.clear();
        b.run(2050ms);
        std::vector<double> late;
        for (const auto& tx : b.out.frames)
            if (tx.frame.id == 0x705) late.push_back(seconds(tx.frame.at - begin) * 1000 - 100 * static_cast<double>(late.size() + 1));
        ASSERT_EQ(late.size(), 20u);
        const auto [least, most] = std::ranges::minmax(late);
        EXPECT_GE(least, -1e-6);
        EXPECT_LE(most, jitter + 1e-6);
        EXPECT_EQ(most - least > 5, jitter > 0);
    }
}

TEST(Cia402Freedoms, AnotherMasterStopsTheNodeOnce) {
    FreeBench b({{"stopped_by_other_s", 3}});
    ASSERT_EQ(b.write(0x1017, 0, 500, 2), Abort::none);
    b.run(5s);
    const auto stops = [&] { return std::ranges::count_if(b.out.frames, [](const auto& tx) { return tx.frame.id == 0; }); };
    const auto state = [&] {
        std::uint8_t last = 0;
        for (const auto& tx : b.out.frames)
            if (tx.frame.id == 0x705) last = tx.frame.data()[0];
        return last;
    };
    EXPECT_EQ(stops(), 0) << "not before it was started";
    b.nmt(NmtCommand::start);
    b.run(2900ms);
    EXPECT_EQ(state(), 5);
    b.run(700ms);
    EXPECT_EQ(stops(), 1) << "the others on the bus see the order";
    EXPECT_EQ(state(), 4);
    b.nmt(NmtCommand::start);
    b.run(20s);
    EXPECT_EQ(stops(), 1);
    EXPECT_EQ(state(), 5);
}

TEST(Cia402Freedoms, TheDriveMonitorsTheStreamOfACyclicMode) {
    struct Case {
        int syncs, targets;
        bool sync_stops;
        unsigned code;
        Duration after;
    };
    // SYNC each 20 ms, targets each 20 ms (60C2h)
    for (const Case& c : {Case{0, 0, true, 0, 0ms}, Case{0, 0, false, 0, 0ms}, Case{3, 0, true, 0x8700, 70ms}, Case{3, 0, false, 0, 0ms},
                          Case{0, 5, false, 0x8250, 110ms}, Case{0, 5, true, 0x8250, 110ms}}) {
        SCOPED_TRACE(std::to_string(c.syncs) + ", " + std::to_string(c.targets) + (c.sync_stops ? ": no SYNC" : ": no target"));
        FreeBench b({{"sync_watch_periods", c.syncs}, {"target_watch_periods", c.targets}});
        b.begin_stream();
        for (int i = 0; i < 50; ++i) {
            b.pass(20ms);
            b.lead(50 * i);
            b.sync();
        }
        EXPECT_EQ(b.fault(), 0u) << "the stream comes";
        const Instant stopped = b.now;
        while (b.now < stopped + 500ms && b.fault() == 0) {
            b.pass(1ms);
            if (!c.sync_stops && (b.now - stopped) % 20ms == Duration::zero()) b.sync();
        }
        EXPECT_EQ(b.fault(), c.code);
        if (c.code != 0) EXPECT_EQ(b.now - stopped, c.after);
    }
}

TEST(Cia402Freedoms, AStreamThatEndedWithItsModeIsNotMissed) {
    FreeBench b({{"sync_watch_periods", 3}, {"target_watch_periods", 3}});
    b.begin_stream();
    for (int i = 0; i < 10; ++i) {
        b.pass(20ms);
        b.lead(0);
        b.sync();
    }
    ASSERT_EQ(b.write(0x6060, 0, 1, 1), Abort::none);
    b.pass(1s);
    EXPECT_EQ(b.fault(), 0u);
}

TEST(Cia402Freedoms, ItBootsForItsTimeAfterPowerOnAndAfterAReset) {
    FreeBench b({{"boot_ms", 2500}});
    const auto answers = [&] {
        b.out.clear();
        b.send(canopen::sdo_frame(0x605, 0x40, {0x6041, 0}));
        return b.count(0x585) > 0;
    };
    EXPECT_EQ(b.count(0x705), 0u);
    b.run(2499ms);
    EXPECT_FALSE(answers());
    b.out.clear();
    b.run(1ms);
    EXPECT_EQ(b.count(0x705), 1u);
    EXPECT_TRUE(answers());
    b.enable(1);
    b.out.clear();
    b.nmt(NmtCommand::reset_node);
    EXPECT_EQ(b.count(0x705), 0u);
    EXPECT_FALSE(b.twin->mechanics(1, b.now).powered);
    b.run(2499ms);
    EXPECT_FALSE(answers());
    b.out.clear();
    b.run(1ms);
    EXPECT_EQ(b.count(0x705), 1u);
    EXPECT_TRUE(answers());
    b.out.clear();
    b.nmt(NmtCommand::reset_communication);
    EXPECT_EQ(b.count(0x705), 1u) << "its program runs on";
}

TEST(Cia402Freedoms, ItIsSilentWhileItStores) {
    FreeBench b({{"flash_silence_ms", 800}});
    ASSERT_EQ(b.write(0x6081, 0, 1234, 4), Abort::none);
    b.out.clear();
    b.send(canopen::sdo_frame(0x605, 0x23, {0x1010, 1}, 0x65766173));
    b.run(799ms);
    EXPECT_EQ(b.count(0x585), 0u);
    b.run(1ms);
    EXPECT_EQ(b.count(0x585), 1u);
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
