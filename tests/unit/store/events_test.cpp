// Every field is read back, any combination of filters finds the events that a plain search finds, the table is bounded, ids are never used
// twice.
#include <random>

#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Events, EveryFieldComesBack) {
    const TempDir dir;
    Event e;
    e.at_unix_ns = 1'700'000'000'123'456'789;
    e.severity = Severity::alarm;
    e.kind = "alarm";
    e.axis = "feeder";
    e.drive = "d1";
    e.line = "can0";
    e.code = -7;
    e.text = "stall detected: überlastet";
    e.who = "192.0.2.7";
    e.door = "http";
    e.parameter = "AC";
    e.old_value = "1";
    e.new_value = "";
    {
        const auto store = open_store(dir);
        EXPECT_EQ(must(store->append_events(std::span(&e, 1))), 1u);
    }
    const auto store = open_store(dir);
    const auto r = must(store->events({})).at(0);
    EXPECT_EQ(r.id, 1u);
    EXPECT_EQ(r.at_unix_ns, e.at_unix_ns);
    EXPECT_EQ(r.severity, e.severity);
    EXPECT_EQ(r.code, e.code);
    EXPECT_THAT((std::vector{r.kind, r.axis, r.drive, r.line, r.text, r.who, r.door, r.parameter, r.old_value, r.new_value}),
                ElementsAre(e.kind, e.axis, e.drive, e.line, e.text, e.who, e.door, e.parameter, e.old_value, e.new_value));
}

std::uint64_t calls_between = 0;

TEST(Events, OthersAreLetInBetweenTheRowsOfABatch) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.between = []() noexcept { ++calls_between; };
    const auto store = open_store(options);
    const std::vector<Event> few(20, an_event("write", "feeder", 1)), many(400, few[0]);
    calls_between = 0;
    EXPECT_EQ(must(store->append_events(few)), 20u);
    const auto of_few = calls_between;
    calls_between = 0;
    EXPECT_EQ(must(store->append_events(many)), 420u);
    // Every three rows or so, however many there are: no batch occupies a processor.
    EXPECT_GE(of_few, 3u);
    EXPECT_GE(calls_between, 100u);
    EXPECT_EQ(must(store->events({})).size(), 200u);
}

TEST(Events, EveryMixOfFiltersFindsWhatAPlainWalkFinds) {
    const TempDir dir;
    const auto store = open_store(dir);
    std::mt19937 random(1);
    std::vector<Event> all;
    const std::vector<std::string> axes{"", "feeder", "slide"};
    const std::vector<std::string> kinds{"alarm", "write", "line"};
    std::int64_t now = 1000;
    for (std::uint64_t i = 1; i <= 400; ++i) {
        now += static_cast<std::int64_t>(random() % 10);
        if (i == 200) now -= 500;  // the wall clock was set back
        auto e = an_event(kinds[random() % 3], axes[random() % 3], now, static_cast<Severity>(random() % 3));
        all.push_back(e);
        all.back().id = i;
    }
    std::vector<Event> to_store = all;
    for (Event& e : to_store)
        e.id = 0;
    EXPECT_EQ(must(store->append_events(to_store)), 400u);
    int found = 0;
    for (int round = 0; round < 1500; ++round) {
        EventFilter f;
        if (random() % 2) f.since_id = random() % 420;
        if (random() % 2) f.before_id = random() % 420;
        if (random() % 2) f.since_unix_ns = 900 + static_cast<std::int64_t>(random() % 2200);
        if (random() % 2) f.axis = axes[random() % 3];
        if (random() % 2) f.kind = kinds[random() % 3];
        if (random() % 2) f.at_least = static_cast<Severity>(random() % 3);
        f.oldest_first = random() % 2 != 0;
        f.limit = random() % 2 ? 1000 : 1 + random() % 20;
        std::vector<std::uint64_t> want;
        for (const Event& e : all) {
            if (e.id > f.since_id && (f.before_id == 0 || e.id < f.before_id) && e.at_unix_ns >= f.since_unix_ns &&
                (f.axis.empty() || e.axis == f.axis) && (f.kind.empty() || e.kind == f.kind) &&
                (!f.at_least || e.severity >= *f.at_least)) {
                want.push_back(e.id);
            }
        }
        if (want.size() > f.limit) {
            if (f.oldest_first)
                want.resize(f.limit);
            else
                want.erase(want.begin(), want.end() - static_cast<std::ptrdiff_t>(f.limit));
        }
        std::vector<std::uint64_t> have;
        for (const Event& e : must(store->events(f)))
            have.push_back(e.id);
        ASSERT_EQ(have, want) << "round " << round;
        found += static_cast<int>(have.size());
    }
    EXPECT_GT(found, 5000);
}

TEST(Events, PagesForwardsAndBackwards) {
    const TempDir dir;
    const auto store = open_store(dir);
    std::vector<Event> ten(10, an_event("x", "", 1));
    must(store->append_events(ten));
    const auto ids = [&](const EventFilter& f) {
        std::vector<std::uint64_t> v;
        for (const auto& e : must(store->events(f)))
            v.push_back(e.id);
        return v;
    };
    EventFilter f;
    f.limit = 3;
    EXPECT_THAT(ids(f), ElementsAre(8, 9, 10));
    f.before_id = 8;
    EXPECT_THAT(ids(f), ElementsAre(5, 6, 7));
    f.before_id = 0;
    f.oldest_first = true;
    f.since_id = 4;
    EXPECT_THAT(ids(f), ElementsAre(5, 6, 7));
    f.limit = 0;  // clamped to 1
    EXPECT_THAT(ids(f), ElementsAre(5));
    f.since_id = ~0ull;
    EXPECT_TRUE(ids(f).empty());
    EventQuery query;  // the type of core
    query.since_id = 8;
    EXPECT_THAT(ids(query), ElementsAre(9, 10));
}

TEST(Events, AreBoundedAndDeletedInSmallPieces) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.events = 100;
    options.limits.piece = 5;
    {
        const auto store = open_store(options);
        std::vector<Event> seven(7, an_event("x", "", 1));
        for (int i = 0; i < 40; ++i) {
            must(store->append_events(seven));
            ASSERT_LE(must(store->facts()).events, 100u);
        }
        const auto left = must(store->events([] {
            EventFilter f;
            f.limit = 1000;
            return f;
        }()));
        ASSERT_EQ(left.size(), 100u);
        EXPECT_EQ(left.front().id, 181u);
        EXPECT_EQ(left.back().id, 280u);
    }
    options.limits.events = 10;
    const auto store = open_store(options);
    const Event one = an_event("x", "", 1);
    must(store->append_events(std::span(&one, 1)));
    EXPECT_EQ(must(store->facts()).events, 100u + 1 - 6);  // one piece, not ninety rows at once
    for (int i = 0; i < 20; ++i)
        must(store->tidy());
    EXPECT_EQ(must(store->facts()).events, 10u);
}

TEST(Events, IdsAreNeverGivenTwice) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.events = 1;
    const Event one = an_event("x", "", 1);
    {
        const auto store = open_store(options);
        EXPECT_EQ(must(store->last_event_id()), 0u);
        for (int i = 0; i < 5; ++i)
            must(store->append_events(std::span(&one, 1)));
    }
    meddle(dir / "axisgate.db", "DELETE FROM event");
    const auto store = open_store(options);
    EXPECT_EQ(must(store->last_event_id()), 5u);
    EXPECT_EQ(must(store->append_events(std::span(&one, 1))), 6u);
}

TEST(Events, GivenIdsMustGoUp) {
    const TempDir dir;
    const auto store = open_store(dir);
    std::vector<Event> events(3, an_event("x", "", 1));
    events[0].id = 10;
    events[1].id = 0;  // the next one
    events[2].id = 12;
    EXPECT_EQ(must(store->append_events(events)), 12u);
    for (const auto& [first, second] :
         std::vector<std::pair<std::uint64_t, std::uint64_t>>{{12, 13}, {13, 13}, {0, 13}, {0, 0xFFFFFFFFFFFFFFFF}}) {
        std::vector<Event> wrong(2, an_event("x", "", 1));
        wrong[0].id = first;
        wrong[1].id = second;
        EXPECT_EQ(refused(store->append_events(wrong)).kind, Kind::invalid) << first << " " << second;
    }
    EXPECT_EQ(must(store->last_event_id()), 12u);
}

TEST(Events, LongTextsAreCutBetweenCharactersNotRefused) {
    const TempDir dir;
    const auto store = open_store(dir);
    Event e = an_event("x", "feeder", 1);
    for (const std::string begin : {"", "x"}) {  // so that the bound falls between characters and inside one
        e.text = begin;
        for (int i = 0; i < 5000; ++i)
            e.text += "ä";
        must(store->append_events(std::span(&e, 1)));
        const auto r = must(store->events({})).back();
        EXPECT_LE(r.text.size(), max_event_text_bytes);
        EXPECT_GT(r.text.size(), max_event_text_bytes - 8);
        EXPECT_TRUE(r.text.ends_with("ä [...]")) << r.text.substr(r.text.size() - 12);
    }
    e.text = std::string(10'000, '\x80');  // not UTF-8
    must(store->append_events(std::span(&e, 1)));
    EXPECT_TRUE(must(store->events({})).back().text.ends_with(" [...]"));
}

}  // namespace
}  // namespace axisgate::test
