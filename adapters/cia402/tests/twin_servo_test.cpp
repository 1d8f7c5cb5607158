// The simulated CiA 402 drive as its wire shows it: golden frames, power states, modes, homing, faults, PDOs, memory, descriptions.
#include <fstream>
#include <sstream>

#include "adapters/cia402/tests/twin_bench.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using namespace std::chrono_literals;
using canopen::Abort;

/// "605#4000100000000000".
Frame frame_of(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 4; i + 1 < text.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
    return canopen::data_frame(static_cast<std::uint32_t>(std::stoul(text.substr(0, 3), nullptr, 16)), bytes);
}

TEST(Cia402Twin, AnswersAsTheVectorsSay) {
    Bench b;
    std::ifstream f(AXISGATE_SOURCE_DIR "/adapters/cia402/vectors.txt");
    std::string line, name;
    std::size_t answers = 0, at = 0;
    while (std::getline(f, line)) {
        if (line.starts_with("case ")) name = line;
        if (line.starts_with("> ")) {
            b.out.clear();
            at = 0;
            b.send(frame_of(line.substr(2)));
        }
        if (!line.starts_with("< ")) continue;
        ASSERT_LT(at, b.out.frames.size()) << name;
        EXPECT_EQ(to_text(b.out.frames[at++].frame), to_text(frame_of(line.substr(2)))) << name;
        ++answers;
    }
    EXPECT_GE(answers, 12u);
}

TEST(Cia402Twin, StatesFollowTheControlWord) {
    Bench b;
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "switch on disabled";
    b.word(0x0F);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "not from here";
    b.word(0x06);
    EXPECT_EQ(b.status() & 0x6Fu, 0x21u);
    b.word(0x07);
    EXPECT_EQ(b.status() & 0x6Fu, 0x23u);
    b.word(0x0F);
    EXPECT_EQ(b.status() & 0x6Fu, 0x27u);
    b.word(0x06);
    EXPECT_EQ(b.status() & 0x6Fu, 0x21u) << "transition 8";
    b.word(0x0F);
    b.word(0x02);
    b.pass(1ms);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "a quick stop by 605Ah = 2 ends off";
    ASSERT_EQ(b.write(0x605A, 0, 6, 2), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), 5000);
    b.word(0x0B);
    EXPECT_EQ(b.status() & 0x6Fu, 0x07u);
    b.pass(100ms);
    EXPECT_EQ(b.read(0x606C), 0);
    EXPECT_EQ(b.status() & 0x6Fu, 0x07u) << "and stays";
}

TEST(Cia402Twin, APositionIsReachedAndAcknowledgedAndHaltedWithoutBeingForgotten) {
    Bench b;
    b.enable(1);
    ASSERT_EQ(b.write(0x607A, 0, 10'000, 4), Abort::none);
    b.word(0x1F);
    EXPECT_NE(b.status() & 0x1000u, 0u) << "set-point acknowledged";
    EXPECT_EQ(b.status() & 0x400u, 0u);
    b.word(0x0F);
    EXPECT_EQ(b.status() & 0x1000u, 0u);
    b.pass(500ms);
    b.word(0x10F);
    b.pass(2s);
    const auto there = b.read(0x6064);
    EXPECT_GT(there, 1000);
    EXPECT_LT(there, 9000);
    EXPECT_NE(b.status() & 0x400u, 0u) << "halted: bit 10 says that it stands";
    b.word(0x0F);
    b.pass(3s);
    EXPECT_EQ(b.read(0x6064), 10'000);
    EXPECT_NE(b.status() & 0x400u, 0u);
    // Buffered: the second one waits for the first.
    ASSERT_EQ(b.write(0x607A, 0, 20'000, 4), Abort::none);
    b.word(0x1F), b.word(0x0F);
    ASSERT_EQ(b.write(0x607A, 0, 5'000, 4), Abort::none);
    b.word(0x1F);
    EXPECT_NE(b.status() & 0x1000u, 0u);
    b.word(0x0F);
    b.pass(1s);
    EXPECT_GT(b.read(0x6064), 15'000) << "goes on to the first";
    b.pass(6s);
    EXPECT_EQ(b.read(0x6064), 5'000);
}

TEST(Cia402Twin, LimitsOfPositionHold) {
    Bench b;
    ASSERT_EQ(b.write(0x607D, 1, -1000, 4), Abort::none);
    ASSERT_EQ(b.write(0x607D, 2, 1000, 4), Abort::none);
    b.enable(1);
    ASSERT_EQ(b.write(0x607A, 0, 5'000, 4), Abort::none);
    b.word(0x1F);
    b.pass(3s);
    EXPECT_EQ(b.read(0x6064), 1000);
    EXPECT_NE(b.status() & 0x800u, 0u);
    b.word(0x0F);
    ASSERT_EQ(b.write(0x60FF, 0, -3000, 4), Abort::none);
    ASSERT_EQ(b.write(0x6060, 0, 3, 1), Abort::none);
    b.pass(5s);
    EXPECT_EQ(b.read(0x6064), -1000);
}

TEST(Cia402Twin, HomingFindsItsPlaceOrSaysThatThereIsNone) {
    Bench without;
    without.enable(6);
    ASSERT_EQ(without.write(0x6098, 0, 17, 1), Abort::none);
    without.word(0x1F);
    EXPECT_NE(without.status() & 0x2000u, 0u) << "no switch: homing error";
    EXPECT_EQ(without.write(0x6098, 0, 99, 1), Abort::value);
    for (const auto& [method, place] : {std::pair{17, -20'000.0}, {18, 20'000.0}, {19, 0.0}, {33, -4096.0}, {34, 4096.0}}) {
        SCOPED_TRACE(method);
        Bench b({{"travel", "20000"}});
        b.enable(6);
        ASSERT_EQ(b.write(0x6098, 0, method, 1), Abort::none);
        ASSERT_EQ(b.write(0x607C, 0, 250, 4), Abort::none);
        b.word(0x1F);
        if (method != 19) EXPECT_EQ(b.status() & 0x3000u, 0u) << "on its way";
        b.pass(60s);
        EXPECT_NE(b.status() & 0x1000u, 0u);
        EXPECT_EQ(b.read(0x6064), 250) << "the zero is called 607Ch";
        EXPECT_NEAR(b.twin->mechanics(1, b.now).position, place, 1);
    }
}

TEST(Cia402Twin, CyclicModesFollowTheirTargetsAtTheSync) {
    Bench b;
    canopen::Pdo target;
    target.direction = canopen::PdoDirection::receive;
    target.settings = {.id = 0x205, .valid = true, .transmission = 1};
    target.mapping = {{{0x607A, 0}, 32}};
    for (const auto& w : canopen::writes_of(target))
        ASSERT_EQ(b.write(w.address.index, w.address.sub, static_cast<std::int64_t>(canopen::low_first(w.bytes)),
                          static_cast<int>(w.bytes.size())),
                  Abort::none);
    ASSERT_EQ(b.write(0x60C2, 1, 10, 1), Abort::none);
    b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
    b.enable(8);
    for (int i = 1; i <= 100; ++i) {
        const std::array<std::uint8_t, 4> bytes{static_cast<std::uint8_t>(i * 10), static_cast<std::uint8_t>(i * 10 >> 8), 0, 0};
        b.send(canopen::data_frame(0x205, bytes));
        const double before = b.twin->mechanics(1, b.now).position;
        EXPECT_EQ(before, b.twin->mechanics(1, b.now).position) << "not before the SYNC";
        b.send(canopen::data_frame(0x80, {}));
        b.pass(5ms);
        EXPECT_NEAR(b.twin->mechanics(1, b.now).position, (i - 1) * 10 + 5, 0.01) << "half way after half the period";
        b.pass(5ms);
    }
    b.pass(10ms);
    EXPECT_EQ(b.read(0x6064), 1000);
    EXPECT_EQ(b.read(0x606C), 0);
    // A short one is told by EMCY 8210h and nothing of it is taken.
    b.out.clear();
    b.send(canopen::data_frame(0x205, std::array<std::uint8_t, 2>{1, 2}));
    ASSERT_EQ(b.count(0x85), 1u);
    EXPECT_EQ(canopen::low_first(b.out.frames[0].frame.data().first(2)), 0x8210u);
    // Torque: 1/1000 of it makes 50 increments/s2.
    ASSERT_EQ(b.write(0x6071, 0, 100, 2), Abort::none);
    ASSERT_EQ(b.write(0x6060, 0, 10, 1), Abort::none);
    b.pass(1s);
    EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 5000, 1);
}

TEST(Cia402Twin, AHeldShaftIsAFollowingErrorAtTheSameInstantHoweverLateItIsAsked) {
    std::vector<Instant> told;
    for (const Duration step : {1ms, 5000ms}) {
        Bench b;
        b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
        b.enable(3);
        ASSERT_EQ(b.write(0x60FF, 0, 4000, 4), Abort::none);
        b.pass(1s);
        ASSERT_EQ(b.twin->set_hand("stall", Value{true}, b.now, b.out), "");
        b.out.clear();
        for (Duration d{}; d < 5s; d += step)
            b.pass(step);
        ASSERT_EQ(b.count(0x85), 1u);
        for (const auto& tx : b.out.frames)
            if (tx.frame.id == 0x85) told.push_back(tx.frame.at);
        EXPECT_EQ(b.status() & 0x4Fu, 0x08u);
        EXPECT_EQ(b.read(0x603F) & 0xFFFF, 0x8611);
        EXPECT_EQ(b.read(0x1001), 0x11);
        b.word(0x0F);
        EXPECT_EQ(b.status() & 0x4Fu, 0x08u) << "a fault is left by a reset alone";
        b.word(0x80);
        EXPECT_EQ(b.status() & 0x6Fu, 0x40u);
        EXPECT_EQ(b.read(0x603F), 0);
    }
    EXPECT_EQ(told[0], told[1]);
}

TEST(Cia402Twin, HeartbeatBootUpAndMemory) {
    Bench b;
    ASSERT_EQ(b.out.frames.size(), 1u);
    EXPECT_EQ(to_text(b.out.frames[0].frame), "705#00");
    ASSERT_EQ(b.write(0x1017, 0, 100, 2), Abort::none);
    b.out.clear();
    b.pass(1s);
    EXPECT_EQ(b.count(0x705), 10u);
    EXPECT_EQ(b.out.frames[0].frame.at, b.now - 900ms);
    ASSERT_EQ(b.write(0x6081, 0, 777, 4), Abort::none);
    EXPECT_TRUE(b.twin->non_volatile().empty()) << "not before it is saved";
    ASSERT_EQ(b.write(0x1010, 1, 0x65766173, 4), Abort::none);
    EXPECT_EQ(b.twin->non_volatile().size(), 2u);
    ASSERT_EQ(b.write(0x6081, 0, 888, 4), Abort::none);
    b.send(canopen::nmt_frame(canopen::NmtCommand::reset_node, 5));
    EXPECT_EQ(b.read(0x6081), 777);
    Bench again({}, nullptr, b.twin->non_volatile());
    EXPECT_EQ(again.read(0x6081), 777);
    ASSERT_EQ(again.write(0x1011, 1, 0x64616F6C, 4), Abort::none);
    EXPECT_EQ(again.read(0x6081), 777) << "not before the reset";
    again.send(canopen::nmt_frame(canopen::NmtCommand::reset_node, 5));
    EXPECT_EQ(again.read(0x6081), 10'000);
    EXPECT_TRUE(again.twin->non_volatile().empty());
}

TEST(Cia402Twin, ATouchProbeKeepsThePlaceOfTheEdge) {
    Bench b;
    ASSERT_EQ(b.write(0x60B8, 0, 0x11, 2), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 1000, 4), Abort::none);
    b.pass(2s);
    const auto here = b.read(0x6064);
    ASSERT_EQ(b.twin->set_hand("inputs", Value{std::int64_t{1}}, b.now, b.out), "");
    b.pass(1s);
    EXPECT_EQ(b.read(0x60BA), here);
    EXPECT_EQ(b.read(0x60B9), 3);
    EXPECT_EQ(b.read(0x60FD), 0x10000);
}

TEST(Cia402Twin, IsBuiltFromADescriptionAndSaysWhatItDoesNotModel) {
    const std::string text =
        "[FileInfo]\nFileName=a.eds\n[DeviceInfo]\nVendorNumber=0x99\n[MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n"
        "[1000]\nParameterName=Device type\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0x00020192\nPDOMapping=0\n"
        "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2100\n"
        "[2100]\nParameterName=Gain\nObjectType=0x7\nDataType=0x0006\nAccessType=rw\nDefaultValue=12\nHighLimit=100\nPDOMapping=0\n"
        "[OptionalObjects]\nSupportedObjects=1\n1=0x6081\n"
        "[6081]\nParameterName=Profile velocity\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\nDefaultValue=4321\nPDOMapping=1\n";
    std::vector<canopen::FileFault> faults, notes;
    const auto eds = canopen::read_eds(text, faults, notes);
    ASSERT_TRUE(eds) << (faults.empty() ? "" : faults[0].text);
    Bench b({}, &*eds);
    EXPECT_EQ(b.read(0x2100), 12);
    EXPECT_EQ(b.write(0x2100, 0, 101, 2), Abort::too_high);
    EXPECT_EQ(b.write(0x2100, 0, 99, 2), Abort::none);
    EXPECT_EQ(b.read(0x6081), 4321);
    for (const auto& item : b.twin->hand())
        if (item.name == "unmodelled") EXPECT_EQ(item.value, Value{std::int64_t{1}});
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
