// What the UIM342 adapter may say: an end only with the place it ended at, a fault with the motion that goes on, an age that is true of
// everything shown, values and parts of values in their own units. In: commands and a fake drive. Out: feedback, results, frames.
#include "adapters/uim342/tests/fake_bench.hpp"
#include "gateway/core/parameter_form.hpp"

namespace axisgate::uim342::test {
namespace {

struct Ready {
    Bench b;
    FakeNode& f;
    explicit Ready(std::map<std::string, std::string> options = {}) : f(b.add(5, std::move(options))) {
        b.start(1s);
        b.ask(Enable{});
        b.run(100ms);
        b.mark();
    }
    /// A move to 1000 is under way, and its place and speed have been seen.
    void moving() {
        Move m;
        m.target = 1000;
        m.velocity = 500;
        b.command(m);
        b.run(30ms);
        f.position = 198;
        f.speed = 195;
        b.run(100ms);
        EXPECT_EQ(b.feedback().velocity, 195);
        b.feedbacks.clear();
    }
};

TEST(Uim342Truth, AnAxisAtRestShowsThePlaceOfItsRest) {
    Ready r;
    r.moving();
    r.f.finish();
    ASSERT_TRUE(r.b.run_until([&] { return r.b.feedback().target_reached; }, 1s));
    EXPECT_EQ(r.b.feedback().position, 1000);
    EXPECT_EQ(r.b.feedback().velocity, 0);
    int at_rest = 0;
    for (const auto& fb : r.b.feedbacks) {
        if (fb.value.moving) continue;
        ++at_rest;
        EXPECT_EQ(fb.value.position, 1000) << "not the place of before";
        EXPECT_EQ(fb.value.velocity, 0);
    }
    EXPECT_GT(at_rest, 0);
}

TEST(Uim342Truth, HomingIsDoneWhereItStands) {
    Ready r({{"home_input", "2"}, {"home_velocity", "500"}, {"home_timeout_s", "5"}});
    r.b.command(Home{20});
    ASSERT_TRUE(r.b.run_until([&] { return r.f.speed != 0; }, 1s));
    r.f.position = 198;
    r.f.speed = 195;
    r.b.run(100ms);
    r.b.feedbacks.clear();
    r.f.inputs |= 2;
    r.f.position = 200;
    r.f.speed = 0;
    r.f.stop = true;
    r.f.values[0x3401] = le(0, 2);
    ASSERT_TRUE(r.b.run_until([&] { return r.b.feedback().homing_attained; }, 1s));
    for (const auto& fb : r.b.feedbacks) {
        if (!fb.value.homing_attained) continue;
        EXPECT_FALSE(fb.value.moving);
        EXPECT_EQ(fb.value.position, 200);
        EXPECT_EQ(fb.value.velocity, 0);
    }
}

TEST(Uim342Truth, AFaultInMotionIsShownWithItsMotion) {
    for (const std::uint8_t code : Bytes{0x19, 0x1A, 0x1B, 0x1E}) {
        Ready r;
        r.moving();
        r.f.err = true;
        r.b.say(message(5, cw::RT, std::array<std::uint8_t, 5>{0, code}));
        r.b.run(200ms);
        EXPECT_TRUE(r.b.feedback().fault && r.b.feedback().moving) << int(code);
        EXPECT_EQ(r.b.feedback().velocity, 195);
        EXPECT_EQ(r.b.feedback().error_code, code);
        EXPECT_EQ(r.b.ask(QuickStop{}).outcome, Outcome::accepted) << "a fault bars no stop";
        r.b.run(200ms);
        EXPECT_TRUE(r.b.feedback().fault && !r.b.feedback().moving);
    }
}

TEST(Uim342Truth, TheAgeIsThatOfTheOldestPart) {
    Ready r;
    // From now on MS[1] is lost: the status stays fresh, the place grows old.
    const Instant lost = r.b.now;
    r.f.script = [](const Message& m) { return m.cw == 0x91 && m.d[0] == 1 ? FakeNode::lost() : FakeNode::Verdict{}; };
    r.f.inputs = 1;
    r.b.run(500ms);
    ASSERT_NE(r.b.feedback().native_status & 0x08u, 0u) << "the status was told";
    EXPECT_LE(r.b.feedback().at, lost);
}

TEST(Uim342Truth, PartsOfAnInputsLogicAreWrittenIntoTheWhole) {
    Ready r;
    r.f.values[0x3400] = le(0x8A03, 2);  // rising: relative move, on a change; falling: stop, at power-on too
    EXPECT_EQ(r.b.read("IL[0].falling_action").value, Value{std::int64_t{3}});
    EXPECT_EQ(r.b.read("IL[0].falling_flag").value, Value{std::int64_t{0}});
    EXPECT_EQ(r.b.read("IL[0].rising_action").value, Value{std::int64_t{10}});
    EXPECT_EQ(r.b.read("IL[0].rising_flag").value, Value{std::int64_t{1}});
    r.b.mark();
    EXPECT_EQ(r.b.write("IL[0].falling_action", 6).value, Value{std::int64_t{6}});
    EXPECT_EQ(r.b.write("IL[0].falling_flag", 1).value, Value{std::int64_t{1}});
    EXPECT_EQ(r.b.write("IL[0].rising_action", 0).value, Value{std::int64_t{0}});
    EXPECT_EQ(r.b.received(5), lines({"B4 00", "B4 00 06 8A", "B4 00", "B4 00 86 8A", "B4 00", "B4 00 86 80"}));
    EXPECT_EQ(r.b.sample("IL[0]"), Value{std::int64_t{0x8086}});
    r.b.mark();
    const Result no = r.b.write("IL[0].rising_action", 12);
    EXPECT_EQ(no.outcome, Outcome::refused);
    EXPECT_NE(no.text.find("0 (no action), 1 (driver off)"), std::string::npos) << no.text;
    EXPECT_TRUE(r.b.received(5).empty()) << "before the wire";
}

TEST(Uim342Truth, ActionCodesAreCheckedWithTheLegalOnesInTheMessage) {
    for (const auto& [value, field] :
         {std::pair{0x808C, "falling_edge_action"}, {0x0C80, "rising_edge_action"}, {0x7F00, "rising_edge_action"}}) {
        const auto checked = catalogue().check_write(Bench::point("IL[1]"), Value{std::int64_t{value}});
        EXPECT_NE(checked.fault.find(field), std::string::npos) << checked.fault;
        if (value <= 0x8B8B) EXPECT_NE(checked.fault.find("6 (origin, then stop)"), std::string::npos) << checked.fault;
    }
    for (const int good : {0, 0x8080, 0x8B8B, 0x0B0B, 0x8006})
        EXPECT_EQ(catalogue().check_write(Bench::point("IL[2]"), Value{std::int64_t{good}}).fault, "") << good;
    EXPECT_EQ(value_in_words(catalogue(), Bench::point("IL[0]"), Value{std::int64_t{0x8006}}),
              "falling_edge_action: origin, then stop; falling_edge_waits_for_change: at power-on too; rising_edge_action: no action; "
              "rising_edge_waits_for_change: on a change only");
    EXPECT_EQ(value_in_words(catalogue(), Bench::point("TG[0]"), Value{std::int64_t{0}}), "continuous");
    EXPECT_EQ(value_in_words(catalogue(), Bench::point("TG[1]"), Value{std::int64_t{60000}}), "low pass, filter time in ms");
    EXPECT_EQ(value_in_words(catalogue(), Bench::point("TG[2]"), Value{std::int64_t{60001}}), "one time");
}

TEST(Uim342Truth, RampsAreTimesWhileIc4IsOne) {
    int n = 0;
    for (std::uint16_t i = 0; i < catalogue().parameters().size(); ++i) {
        const Point p{i, 0};
        const auto a = alternate_of(catalogue(), p);
        if (!a || !a->of) continue;
        ++n;
        const std::string& id = catalogue().parameters()[i].id;
        const auto known_as = [&](std::int64_t ic4) { return [ic4](Point) { return Value{ic4}; }; };
        EXPECT_EQ(form_now(catalogue(), p, known_as(1)).unit, "ms") << id;
        EXPECT_EQ(form_now(catalogue(), p, known_as(1)).max, 60000) << id;
        EXPECT_EQ(form_now(catalogue(), p, known_as(0)).unit, "pulse/s^2") << id;
        EXPECT_EQ(form_now(catalogue(), p, known_as(0)).max, 65'000'000) << id;
        EXPECT_EQ(check_write_now(catalogue(), p, Value{std::int64_t{60000}}, known_as(1)).fault, "") << id;
        EXPECT_EQ(check_write_now(catalogue(), p, Value{std::int64_t{60001}}, known_as(1)).fault,
                  id + ": 60001 is outside 1..60000 ms, because IC[4] is 1");
        EXPECT_EQ(check_write_now(catalogue(), p, Value{std::int64_t{65'000'000}}, known_as(0)).fault, "") << id;
        EXPECT_EQ(check_write_now(catalogue(), p, Value{std::int64_t{65'000'000}}, {}).fault, "") << id << ": nobody knows the unit";
        // Where nobody above knew it, the adapter does: both ways, as IC[4] is written.
        Ready r;
        EXPECT_EQ(r.b.write(id, 65'000'000).outcome, Outcome::done) << id;
        EXPECT_EQ(r.b.write("IC[4]", 1).outcome, Outcome::done);
        const Result no = r.b.write(id, 60001);
        EXPECT_EQ(no.outcome, Outcome::refused) << id;
        EXPECT_NE(no.text.find("1..60000 ms"), std::string::npos) << no.text;
        EXPECT_EQ(r.b.write(id, 60000).outcome, Outcome::done) << id;
        EXPECT_EQ(r.b.write("IC[4]", 0).outcome, Outcome::done);
        EXPECT_EQ(r.b.write(id, 60001).outcome, Outcome::done) << id;
    }
    EXPECT_EQ(n, 14);
}

TEST(Uim342Truth, TheOutputCanBeWrittenByItsOwnName) {
    Ready r;
    EXPECT_EQ(r.b.write("DI.OP1", 1).outcome, Outcome::done);
    EXPECT_EQ(r.b.received(5), lines({"B7 01 01 00 00"}));
    EXPECT_EQ(r.b.sample("DI"), Value{std::int64_t{0x100}}) << "within the range of what is read";
    EXPECT_EQ(check_write_now(catalogue(), Bench::point("DI"), Value{std::int64_t{2}}, {}).fault, "DI: 2 is outside 0..1");
    EXPECT_EQ(r.b.write("DI", 2).outcome, Outcome::refused);
}

TEST(Uim342Truth, StorageThatTheManualDoesNotPrintIsMarked) {
    int marked = 0;
    for (std::uint16_t i = 0; i < catalogue().parameters().size(); ++i)
        marked += entry_of(catalogue(), {i, 0})->contains("choice") ? 1 : 0;
    EXPECT_EQ(marked, 31);
    for (const char* id : {"IC[0]", "IC[7]", "IE[8]", "BL", "MF2.SP", "MF7.PA"})
        EXPECT_TRUE(entry_of(catalogue(), Bench::point(id))->contains("choice")) << id;
    for (const char* id : {"AC", "PP[7]", "IL[0]", "MF2.AC", "QE[0]"})
        EXPECT_FALSE(entry_of(catalogue(), Bench::point(id))->contains("choice")) << id;
}

TEST(Uim342Truth, CodesAreLegibleInTheCatalogue) {
    for (const char* id : {"TG[0]", "TG[1]", "TG[2]"}) {  // [L1651] to [L1653]
        const auto meanings = meanings_of(catalogue(), Bench::point(id));
        ASSERT_EQ(meanings.size(), 3u) << id;
        for (const std::int64_t code : {0, 1, 60000, 60001})
            EXPECT_EQ(std::ranges::count_if(meanings, [&](const auto& m) { return m.from <= code && code <= m.through; }), 1) << id << code;
    }
    for (const char* id : {"IL[0]", "IL[1]", "IL[2]"}) {  // [L1000], [L1611]: twelve parts in all
        const auto fields = fields_of(catalogue(), Bench::point(id));
        ASSERT_EQ(fields.size(), 4u) << id;
        for (const auto& f : fields)
            EXPECT_EQ(f.allowed.size(), f.bits == 1 ? 2u : 12u) << id << " " << f.name;
        for (const char* part : {".falling_action", ".falling_flag", ".rising_action", ".rising_flag"})
            EXPECT_NE(entry_of(catalogue(), Bench::point(std::string(id) + part)), nullptr) << id << part;
    }
    // DI is written as 0 or 1 and read as the image of all ports, bits 0 to 2 and 8 [L1682].
    const auto written = alternate_of(catalogue(), Bench::point("DI"));
    ASSERT_TRUE(written);
    EXPECT_FALSE(written->of) << "of what is written";
    EXPECT_EQ(written->min, 0);
    EXPECT_EQ(written->max, 1);
    EXPECT_EQ(fields_of(catalogue(), Bench::point("DI")).size(), 4u);
    EXPECT_EQ(*form_now(catalogue(), Bench::point("DI"), [](Point) { return Value{}; }).max, 0x107);
}

/// Edges that come faster than two reads: position and end of motion are read all the same, and a halt is done.
TEST(Uim342Truth, AnInputThatChattersDoesNotKeepThePositionFromBeingRead) {
    Bench b(LineKind::bytes);
    FakeNode& node = b.add(5);
    b.start();
    node.latency = 30ms;
    for (int i = 0; i < 200; ++i) {
        b.say(message(5, cw::RT, std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(1 + i % 2)}));
        b.run(10ms);
    }
    EXPECT_LT(b.now - b.feedback().at, 400ms);
}

TEST(Uim342Truth, FramesWithTheOtherCrcAreTold) {
    for (const CrcMode mine : {CrcMode::twelve, CrcMode::thirteen}) {
        const CrcMode other = mine == CrcMode::twelve ? CrcMode::thirteen : CrcMode::twelve;
        Bench b(LineKind::bytes);
        b.setup.options["crc"] = std::string(name_of(mine));
        b.add(5);
        b.configure();
        b.line(true);
        const Message m = message(5, 0x15, std::array<std::uint8_t, 1>{1});
        b.raw(Frame::run(to_uimessage(m, mine)));
        EXPECT_EQ(b.notices_of("setup"), 0u);
        for (int i = 0; i < 3; ++i)
            b.raw(Frame::run(to_uimessage(m, other)));
        ASSERT_EQ(b.notices_of("setup"), 1u) << "once";
        EXPECT_NE(b.notices.back().text.find("option crc = " + std::string(name_of(other))), std::string::npos) << b.notices.back().text;
    }
}

}  // namespace
}  // namespace axisgate::uim342::test
