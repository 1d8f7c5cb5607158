// A world is recorded and played again through an engine of its own, for every family, on twins and on a cable: there is no difference if
// nothing was changed, and the right one otherwise.
#include "tests/world/tape.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

std::string published(const ReplayReport& r) {
    std::string text = r.fault;
    for (const auto& d : r.listed)
        text += "\n recorded: " + d.recorded + "\n replayed: " + d.replayed;
    return text;
}

/// The usual commands of a user: enable, move, stop, read, and conditions of the twin.
void live(World& w, AxisId axis, DriveId drive, bool simulated) {
    ASSERT_TRUE(w.run_until_true([&] { return (w.picture(axis).flags & flag_online) != 0; }, 10s));
    (void)w.wait(w.command(axis, Enable{}, true), 10s);
    Move m;
    m.target = 4000;
    m.velocity = 2000;
    (void)w.command(axis, m);
    w.run_for(700ms);
    (void)w.wait(w.command(axis, Halt{}), 5s);
    (void)w.wait(w.command(axis, ReadParameter{{0, 0}}), 5s);
    SetPoint p;
    p.axis = axis;
    p.value = 100;
    p.at = w.now;
    (void)w.engine.on_set_point(p, w.now);
    w.run_for(300ms);
    if (simulated) (void)w.engine.set_hand(drive, {{"silent", Value{true}}}, {}, w.now);
    w.run_for(2s);
    if (simulated) (void)w.engine.set_hand(drive, {{"silent", Value{false}}}, {}, w.now);
    w.run_for(2s);
    (void)w.wait(w.command(axis, Disable{}, true), 5s);
    w.run_for(500ms);
}

class Replayed : public testing::TestWithParam<Subject> {};
INSTANTIATE_TEST_SUITE_P(Families, Replayed, testing::ValuesIn(subjects()), name_of_subject);

TEST_P(Replayed, TwinsDoTheSameAgain) {
    Tape tape;
    World w(7);
    w.engine.set_tap(&tape);
    const auto state = w.apply(w.twins(GetParam(), 2));
    live(w, state->axis_ids[0], state->drive_ids[0], true);
    const auto report = tape.play();
    EXPECT_EQ(report.differences, 0u) << published(report);
    EXPECT_EQ(report.fault, "");
    EXPECT_GT(report.compared, 200u);
    EXPECT_GT(report.inputs, 100u);
}

TEST(Replay, MeetsTheSameSpecimen) {
    // A page of the test's own: half of the answers of the example come 30 ms late, differently from message to message.
    boost::json::object page = families().find("example").catalogue->document();
    page["freedoms"] = boost::json::parse(R"([
        {"name": "late_ms", "unit": "ms", "min": 0, "max": 100, "default": 0, "description": "late", "source": "silent", "named": {"slow": 30}},
        {"name": "late_per_mille", "min": 0, "max": 1000, "default": 0, "description": "how many", "source": "silent", "named": {"slow": 500}}])");
    std::vector<std::string> faults;
    const auto catalogue = Catalogue::parse(boost::json::serialize(page), faults);
    ASSERT_TRUE(catalogue);
    Families own = families();
    for (FamilyEntry& e : own.entries) {
        if (e.family->name == "example") e.catalogue = &*catalogue;
    }
    const auto recorded = [&](const std::string& specimen) {
        auto tape = std::make_unique<Tape>();
        World w(7, std::make_shared<Plant>(), own);
        w.engine.set_tap(tape.get());
        Site site = w.twins(wires_of(own.find("example")).front());
        if (!specimen.empty()) site.drives[0].options["specimen"] = specimen;
        const auto state = w.apply(std::move(site));
        live(w, state->axis_ids[0], state->drive_ids[0], true);
        return tape;
    };
    const auto slow = recorded("slow"), plain = recorded("");
    EXPECT_NE(Tape::joined(slow->window), Tape::joined(plain->window)) << "the specimen makes no difference";
    const auto again = [&](const Tape& tape) {
        const std::string in = Tape::joined(tape.inputs), out = Tape::joined(tape.window);
        return replay(own, {in, out, tape.window.gone_outcomes()});
    };
    const auto report = again(*slow);
    EXPECT_EQ(report.differences, 0u) << published(report);
    EXPECT_EQ(report.fault, "");
    EXPECT_GT(report.compared, 200u);
}

TEST_P(Replayed, WhatCameOverACableIsPlayedAgain) {
    Tape tape;
    World w(7);
    w.engine.set_tap(&tape);
    const Subject& s = GetParam();
    const auto state = w.apply(w.make_site(s, s.cable(), 1, "device"));
    w.plug_in("line", DriveId{900}, s, addresses(s, 1)[0], s.kind());
    live(w, state->axis_ids[0], state->drive_ids[0], false);
    const auto report = tape.play();
    EXPECT_EQ(report.differences, 0u) << published(report);
    EXPECT_EQ(report.fault, "");
    EXPECT_GT(report.compared, 100u);
}

TEST(Replay, OfTheLastStretchAloneIsComparedToo) {
    Tape tape(128 * 1024);
    World w(3);
    w.engine.set_tap(&tape);
    const auto state = w.apply(w.twins(subjects()[0], 2));
    for (int i = 0; i < 4; ++i)
        live(w, state->axis_ids[0], state->drive_ids[0], true);
    w.run_for(60s);
    ASSERT_GT(tape.window.gone_outcomes(), 0u);
    const auto report = tape.play();
    EXPECT_EQ(report.differences, 0u) << published(report);
    EXPECT_GT(report.compared, 100u);
}

TEST(Replay, NamesWhatIsDoneOtherwise) {
    Tape tape;
    World w(3);
    w.engine.set_tap(&tape);
    const auto state = w.apply(w.twins(subjects()[0]));
    live(w, state->axis_ids[0], state->drive_ids[0], true);
    // The same recording without its move: the consequences differ from the recorded ones.
    FlightLog without(64u << 20, false);
    const std::string all = Tape::joined(tape.inputs);
    FlightReader reader(all);
    while (const auto r = reader.next()) {
        const auto c = r->kind == FlightKind::command ? unpack<CommandRecord>(r->payload) : std::nullopt;
        if (!c || !std::holds_alternative<Move>(c->command.body)) without.add(*r);
    }
    const auto report = tape.play(Tape::joined(without));
    EXPECT_EQ(report.fault, "");
    EXPECT_GT(report.differences, 10u);
    ASSERT_FALSE(report.listed.empty());
    EXPECT_LE(report.listed.size(), ReplayReport::most_listed);
    EXPECT_FALSE(report.listed[0].recorded.empty());
}

TEST(Replay, EndsAtWhatCannotBeRead) {
    Tape tape;
    World w(3);
    w.engine.set_tap(&tape);
    (void)w.apply(w.twins(subjects()[0]));
    w.run_for(500ms);
    std::string all = Tape::joined(tape.inputs);
    EXPECT_EQ(tape.play(all.substr(0, all.size() - 1)).fault, "the records are damaged");
    EXPECT_EQ(tape.play("\x06\x02\x00\x00").fault, "the records are damaged");
    FlightLog headless(1000, false);
    headless.add({FlightKind::turn, 0xFFFF, at_ns(5), {}});
    EXPECT_EQ(tape.play(Tape::joined(headless)).fault, "the recording does not begin with a site");
}

TEST(FlightLog, LetsTheOldestGoOrGivesUp) {
    FlightLog ring(3 * FlightLog::chunk_bytes, true), once(3 * FlightLog::chunk_bytes, false);
    const std::string payload(1000, 'x');
    for (int i = 0; i < 1000; ++i) {
        ring.add({FlightKind::event, 0xFFFF, at_ns(i), payload});
        once.add({FlightKind::event, 0xFFFF, at_ns(i), payload});
    }
    EXPECT_LE(ring.bytes(), 3 * FlightLog::chunk_bytes);
    EXPECT_EQ(ring.gone(), ring.gone_outcomes());
    const std::string all = Tape::joined(ring);
    FlightReader reader(all);
    std::uint64_t read = 0;
    Instant newest{};
    while (const auto r = reader.next())
        ++read, newest = r->at;
    EXPECT_FALSE(reader.damaged());
    EXPECT_EQ(read + ring.gone(), 1000u);
    EXPECT_EQ(newest, at_ns(999));
    EXPECT_TRUE(once.overflowed());
    EXPECT_EQ(once.bytes(), 0u);
}

}  // namespace
}  // namespace axisgate::test
