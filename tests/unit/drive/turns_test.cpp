// Turns and Roster: the order of sending on a line, and that no drive is forgotten.
#include "gateway/drive/turns.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "gateway/drive/roster.hpp"

namespace axisgate::drive::test {
namespace {
using namespace std::chrono_literals;

struct TurnsOfALine : testing::Test {
    Turns turns;
    Instant now = time_zero + 1s;
    void SetUp() override { turns.line_changed(now); }
    void wish(std::size_t slot, Want want) { turns.settle(slot, want, never, never); }
    std::optional<std::size_t> next() { return turns.next(now); }
};

TEST_F(TurnsOfALine, AStopOvertakesEverythingThatWaits) {
    wish(1, Want::poll);
    wish(2, Want::command);
    wish(3, Want::probe);
    wish(4, Want::urgent);
    EXPECT_EQ(next(), 4u);
    EXPECT_EQ(next(), 2u);
}

TEST_F(TurnsOfALine, OnePlaceIsOneExchange) {
    wish(1, Want::command);
    wish(2, Want::urgent);
    EXPECT_EQ(next(), 2u);
    turns.began(2, false);
    EXPECT_FALSE(next()) << "not even while another waits";
    EXPECT_EQ(turns.deadline(), never);
    turns.ended(2);
    EXPECT_EQ(next(), 1u);
    turns.ended(2);
    EXPECT_EQ(turns.on_their_way(), 0u) << "ended twice is ended once";
}

/// A drive that is asked again before its first exchange has ended still has one place.
TEST_F(TurnsOfALine, AnExchangeThatBeginsTwiceHasOnePlace) {
    turns.set({.window = 2, .probe_window = 1});
    turns.began(2, false);
    turns.began(2, false);
    EXPECT_EQ(turns.on_their_way(), 1u);
    turns.ended(2);
    EXPECT_EQ(turns.on_their_way(), 0u) << "a place that is never given back is lost to the line";
}

TEST_F(TurnsOfALine, ThePauseAfterAnAnswerIsKeptAndIsADeadline) {
    turns.set({.window = 1, .probe_window = 1, .pause = 3ms});
    turns.received(now);
    wish(1, Want::urgent);
    EXPECT_FALSE(next());
    EXPECT_EQ(turns.deadline(), now + 3ms);
    now += 3ms;
    EXPECT_EQ(next(), 1u);
    EXPECT_EQ(turns.deadline(), never) << "a pause that is over is nobody's deadline";
}

TEST_F(TurnsOfALine, WhoChangedItsMindIsPassedOver) {
    wish(1, Want::command);
    wish(2, Want::command);
    wish(1, Want::nothing);
    wish(3, Want::command);
    wish(3, Want::poll);
    EXPECT_EQ(next(), 2u);
    EXPECT_EQ(next(), 3u) << "what it sends next is its own matter";
    EXPECT_FALSE(next());
    wish(5, Want::probe);
    wish(5, Want::command);
    EXPECT_EQ(next(), 5u);
    EXPECT_FALSE(next()) << "one wish, one place";
}

TEST_F(TurnsOfALine, CommandsLeaveEveryNinthPlace) {
    std::map<std::size_t, int> served;
    for (int n = 0; n < 900; ++n) {
        wish(1, Want::command);
        wish(2, Want::poll);
        ++served[*next()];
    }
    EXPECT_EQ(served[2], 100);
}

TEST_F(TurnsOfALine, MovingAxesGoFirstAndStandingOnesInTurn) {
    std::map<std::size_t, int> served;
    for (int n = 0; n < 800; ++n) {
        wish(1, Want::quick_poll);
        for (std::size_t s = 2; s < 6; ++s)
            wish(s, Want::poll);
        ++served[*next()];
    }
    EXPECT_EQ(served[1], 600);
    for (std::size_t s = 2; s < 6; ++s)
        EXPECT_EQ(served[s], 50) << s;
}

TEST_F(TurnsOfALine, SilentDrivesHaveTheirOwnPlacesAndTakeTurnsWithPolls) {
    turns.set({.window = 4, .probe_window = 1});
    for (std::size_t s = 1; s < 4; ++s)
        wish(s, Want::probe);
    wish(9, Want::poll);
    const auto first = next();
    ASSERT_EQ(first, 1u);
    turns.began(1, true);
    EXPECT_EQ(next(), 9u);
    turns.began(9, false);
    EXPECT_FALSE(next()) << "two places are free, and not for a second silent drive";
    turns.ended(1);
    EXPECT_EQ(next(), 2u);
}

TEST_F(TurnsOfALine, OvertakenOnesHoldPollsUpButNotCommands) {
    turns.set({.window = 4, .probe_window = 1, .pause = {}, .overtaken_limit = 2, .overtaken_grace = 2ms});
    turns.began(8, false);
    for (int i = 0; i < 2; ++i) {
        turns.began(1, false);
        turns.ended(1);
    }
    wish(2, Want::poll);
    EXPECT_FALSE(next());
    EXPECT_EQ(turns.deadline(), now + 2ms);
    for (int i = 0; i < 20; ++i) {
        wish(3, Want::command);
        ASSERT_EQ(next(), 3u);
    }
    now += 2ms;
    EXPECT_EQ(next(), 2u) << "its drive is silent: the others go on";
}

TEST_F(TurnsOfALine, DueOnesComeByTheirDeadline) {
    turns.settle(1, Want::nothing, now + 5ms, now + 9ms);
    turns.settle(2, Want::nothing, never, now + 3ms);
    turns.settle(3, Want::poll, now + 7ms, now + 1ms);
    EXPECT_EQ(turns.deadline(), now + 3ms) << "who waits for a place is not due by its wish";
    EXPECT_FALSE(turns.due(now + 2ms));
    EXPECT_EQ(turns.due(now + 3ms), 2u);
    turns.remove(2);
    EXPECT_EQ(turns.due(now + 5ms), 1u);
    turns.line_changed(now);
    EXPECT_EQ(turns.deadline(), never);
    EXPECT_FALSE(next());
}

TEST_F(TurnsOfALine, ARemovedDriveGivesItsPlaceBack) {
    wish(1, Want::probe);
    ASSERT_EQ(next(), 1u);
    turns.began(1, true);
    wish(1, Want::command);
    turns.remove(1);
    EXPECT_EQ(turns.on_their_way(), 0u);
    wish(2, Want::probe);
    EXPECT_EQ(next(), 2u);
}

/// All slots and requests at random: never more places than exist, and no drive waits for more than one round of all.
TEST_F(TurnsOfALine, NobodyIsForgotten) {
    std::mt19937 random(11);
    for (const std::size_t window : {std::size_t{1}, std::size_t{5}}) {
        turns.line_changed(now);
        turns.set({.window = window, .probe_window = 1 + window / 4});
        std::array<int, slot_limit> waits{};
        std::array<bool, slot_limit> wants{}, flies{};
        std::size_t flying = 0;
        for (int n = 0; n < 60000; ++n, now += 1us) {
            const std::size_t s = random() % slot_limit;
            if (flies[s]) {
                turns.ended(s);
                flies[s] = false;
                --flying;
            } else if (!wants[s]) {
                wish(s, static_cast<Want>(2 + random() % 4));
                wants[s] = true;
            }
            while (const auto who = next()) {
                ASSERT_TRUE(wants[*who]);
                wants[*who] = false;
                waits[*who] = 0;
                turns.began(*who, false);
                flies[*who] = true;
                ++flying;
                ASSERT_LE(flying, window);
                wish(*who, Want::nothing);
            }
            if (window == 1) continue;
            for (std::size_t k = 0; k < slot_limit; ++k)
                ASSERT_LE(waits[k] += wants[k] && flying == 0 ? 1 : 0, 1) << "the line is free and " << k << " waits";
        }
    }
}

struct FakeDrive {
    static constexpr int channels = 2;
    DriveSetup setup_;
    std::size_t slot;
    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }
    void look(const DriveSetup&) noexcept {}
};

TEST(DriveRoster, WhoIsTheSameStaysAndAddressesAreFreeForNewOnes) {
    Roster<FakeDrive> roster;
    Out out;
    LineSetup line;
    const auto drive = [](std::uint16_t id, std::string address, std::vector<AxisSetup> axes) {
        DriveSetup d;
        d.id = DriveId{id};
        d.name = "d" + std::to_string(id);
        d.address = std::move(address);
        d.axes = std::move(axes);
        return d;
    };
    std::vector<std::uint16_t> removed;
    const auto fit = [&] {
        return roster.fit(
            line, [&](FakeDrive& d) { removed.push_back(index_of(d.setup().id)); },
            [&](const DriveSetup& s) {
                const auto* other = roster.find([&](const FakeDrive& d) { return d.setup().address == s.address; });
                return other ? s.address + " belongs to " + other->setup().name : std::string();
            },
            [](const DriveSetup& s, std::size_t slot) {
                return std::make_unique<FakeDrive>(FakeDrive{s, slot});
            },
            out);
    };
    line.drives = {drive(1, "5", {{AxisId{10}, 1}, {AxisId{11}, 2}, {AxisId{12}, 3}}), drive(2, "6", {{AxisId{20}, 1}}), drive(3, "6", {})};
    EXPECT_EQ(fit().size(), 2u);
    ASSERT_EQ(out.links.size(), 1u);
    EXPECT_EQ(out.links[0].text, "6 belongs to d2");
    EXPECT_EQ(out.links[0].drive, DriveId{3});
    FakeDrive* first = roster.of(AxisId{10});
    ASSERT_TRUE(first);
    EXPECT_EQ(roster.of(AxisId{11}), first);
    EXPECT_EQ(roster.of(AxisId{12}), nullptr) << "no such channel";
    EXPECT_EQ(roster.of(AxisId{99}), nullptr);

    line.drives.erase(line.drives.begin() + 1);  // 2 goes; 3 may have its address now
    const auto fresh = fit();
    EXPECT_EQ(removed, (std::vector<std::uint16_t>{2}));
    ASSERT_EQ(fresh.size(), 1u);
    EXPECT_EQ(fresh[0]->slot, 1u) << "the free place";
    EXPECT_EQ(roster.of(AxisId{10}), first) << "undisturbed";
    line.drives[0].axes.pop_back();
    line.drives[0].axes.push_back({AxisId{13}, 2});
    int changed = 0;
    roster.fit_axes(line, [&](FakeDrive& d, const DriveSetup& s) {
        EXPECT_EQ(&d, first);
        d.setup_ = s;
        ++changed;
    });
    EXPECT_EQ(changed, 1) << "other axes of the same drive: it goes on";
    EXPECT_TRUE(fit().empty());
    EXPECT_EQ(removed.size(), 1u);
    EXPECT_EQ(roster.of(AxisId{13}), first);
    EXPECT_EQ(roster.of(AxisId{12}), nullptr);
    line.drives[0].options["x"] = "1";
    EXPECT_EQ(fit().size(), 1u) << "other options make another drive";
}

}  // namespace
}  // namespace axisgate::drive::test
