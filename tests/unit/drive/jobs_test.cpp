// Jobs of the kit: one command in progress, the others behind it, and exactly one result for each, however it ends.
#include "gateway/drive/jobs.hpp"

#include <gtest/gtest.h>

#include "gateway/drive/part.hpp"

namespace axisgate::drive {
namespace {

struct Press;
class Work;
struct Task : JobBase<Work> {
    int step = 0;
};
class Work final : public VerbBase<Part<Press>, Task> {
public:
    using VerbBase::accept, VerbBase::fail, VerbBase::job, VerbBase::refuse, VerbBase::succeed;
    using VerbBase::VerbBase;
    void without_success(Failure& how, Turn&) override {
        seen.push_back(how);
        how.text += adds;
    }
    std::vector<Failure> seen;
    std::string adds;
};
class Tasks : public JobsBase<Part<Press>, Task> {
public:
    using JobsBase::JobsBase;
};
struct Press {
    [[nodiscard]] static AxisId axis() noexcept { return AxisId{3}; }
    Tickets tickets;
    Tasks jobs{*this};
    Work moves{*this}, reads{*this};
};

struct Bench {
    Press drive;
    Out out;
    Turn t{Instant{}, out};

    Command command(CommandBody body) {
        Command c;
        c.ticket = Ticket{++given};
        c.axis = AxisId{3};
        c.body = std::move(body);
        EXPECT_TRUE(drive.tickets.open(c, out));
        return c;
    }
    Ticket begin(Work& verb, CommandBody body) {
        const Command c = command(std::move(body));
        drive.jobs.begin(verb, c);
        return c.ticket;
    }
    Ticket wait(CommandBody body) {
        const Command c = command(std::move(body));
        EXPECT_TRUE(drive.jobs.queue.push(c));
        return c.ticket;
    }
    std::uint64_t given = 0;
};

TEST(Jobs, EachEndIsOneResultAndLeavesNothingInHand) {
    Bench b;
    const Ticket taken = b.begin(b.drive.moves, Move{});
    EXPECT_TRUE(b.drive.jobs.is(b.drive.moves) && !b.drive.jobs.is(b.drive.reads));
    b.drive.moves.accept("on its way", b.t);
    EXPECT_TRUE(b.drive.jobs.idle());
    b.begin(b.drive.reads, ReadParameter{});
    b.drive.reads.job().bytes = {1, 2};
    b.drive.reads.succeed("", b.t, Value{std::int64_t{7}});
    b.begin(b.drive.moves, Move{});
    b.drive.moves.refuse(Reason::out_of_range, "too far", b.t, 41);
    b.begin(b.drive.moves, Move{});
    b.drive.moves.fail(Reason::no_answer, "silent", b.t);
    b.drive.moves.fail(Reason::no_answer, "nobody's", b.t);

    ASSERT_EQ(b.out.results.size(), 4u);
    EXPECT_EQ(b.out.results[0].ticket, taken);
    EXPECT_EQ(b.out.results[0].outcome, Outcome::accepted);
    EXPECT_EQ(b.out.results[1].value, Value{std::int64_t{7}});
    EXPECT_EQ(b.out.results[1].bytes.size(), 2u);
    EXPECT_EQ(b.out.results[2].outcome, Outcome::refused);
    EXPECT_EQ(b.out.results[2].code, 41);
    EXPECT_EQ(b.out.results[3].outcome, Outcome::failed);
    EXPECT_EQ(b.drive.moves.seen.size(), 2u) << "a verb is told of what did not succeed, and of nothing else";
    EXPECT_TRUE(b.drive.reads.seen.empty());
}

TEST(Jobs, WhatIsHandedOverIsAnsweredByWhoTookIt) {
    Bench b;
    const Ticket t = b.begin(b.drive.moves, Home{});
    const Task taken = b.drive.jobs.hand_over();
    EXPECT_TRUE(b.drive.jobs.idle());
    b.drive.moves.accept("", b.t);
    EXPECT_TRUE(b.out.results.empty());
    EXPECT_TRUE(b.drive.tickets.is_open(t));
    EXPECT_TRUE(std::holds_alternative<Home>(taken.command.body));
    EXPECT_TRUE(b.drive.tickets.accepted(taken.command.ticket, b.out));
}

TEST(Jobs, TheDrivesOwnBusinessOwesNoResult) {
    Bench b;
    b.drive.jobs.begin_own(b.drive.reads, ReadParameter{});
    EXPECT_EQ(b.drive.jobs.job().command.axis, AxisId{3});
    b.drive.reads.fail(Reason::no_answer, "silent", b.t);
    EXPECT_TRUE(b.out.results.empty());
    EXPECT_EQ(b.drive.reads.seen.size(), 1u);
}

TEST(Jobs, AStopEndsWhatItNamesInHandAndWaiting) {
    Bench b;
    const auto motions = [](const Command& c) { return is_motion(c.body); };
    const Ticket moving = b.begin(b.drive.moves, Move{}), read = b.wait(ReadParameter{}), home = b.wait(Home{});
    b.drive.moves.adds = "; it stands";
    b.drive.jobs.interrupt(motions, "halt", b.t);
    ASSERT_EQ(b.out.results.size(), 2u);
    EXPECT_EQ(b.out.results[0].ticket, moving);
    EXPECT_EQ(b.out.results[0].text, "interrupted by halt; it stands");
    EXPECT_EQ(b.out.results[1].ticket, home);
    for (const auto& r : b.out.results)
        EXPECT_EQ(r.reason, Reason::interrupted);
    EXPECT_TRUE(b.drive.moves.seen.at(0).dropped) << "a verb knows that it was no fault of its own";
    EXPECT_TRUE(b.drive.jobs.idle());
    EXPECT_EQ(b.drive.jobs.queue.front().ticket, read);

    b.drive.jobs.begin(b.drive.reads, b.drive.jobs.queue.pop());
    b.drive.jobs.interrupt(motions, "halt", b.t);
    EXPECT_TRUE(b.drive.jobs.is(b.drive.reads)) << "what does not move goes on";
}

TEST(Jobs, ADriveThatIsGoneLeavesNobodyWaiting) {
    Bench b;
    b.begin(b.drive.reads, ReadParameter{});
    b.wait(Move{});
    b.wait(Enable{});
    b.drive.jobs.fail_all(Reason::line_down, "the line is down", b.t);
    ASSERT_EQ(b.out.results.size(), 3u);
    for (const auto& r : b.out.results) {
        EXPECT_EQ(r.reason, Reason::line_down);
        EXPECT_EQ(r.text, "the line is down");
    }
    EXPECT_TRUE(b.drive.reads.seen.at(0).dropped);
    EXPECT_EQ(b.drive.tickets.size(), 0u);
    EXPECT_TRUE(b.drive.jobs.idle() && b.drive.jobs.queue.empty());
    b.drive.jobs.fail_all(Reason::line_down, "the line is down", b.t);
    EXPECT_EQ(b.out.results.size(), 3u);
}

}  // namespace
}  // namespace axisgate::drive
