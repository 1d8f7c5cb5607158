// One result per command, and the behaviour at the bounds, in virtual time.
#include "gateway/doors/dds/commands_seen.hpp"

#include <gtest/gtest.h>

namespace axisgate::dds {
namespace {
using Stage = CommandsSeen::Stage;

Result result_with(std::string text) {
    Result r;
    r.text = std::move(text);
    return r;
}

TEST(CommandsSeen, OneThatIsSentAgainHasTheResultThatItHad) {
    CommandsSeen seen;
    Instant now = at_ns(0);
    EXPECT_EQ(seen.begin("hall", "1", now).stage, Stage::is_new);
    EXPECT_EQ(seen.begin("hall", "1", now).stage, Stage::under_way);
    EXPECT_EQ(seen.begin("yard", "1", now).stage, Stage::is_new) << "ids belong to their source";
    seen.end("hall", "1", result_with("first"), now);
    seen.end("hall", "1", result_with("second"), now);
    now += CommandsSeen::keep_for - std::chrono::milliseconds(1);
    const auto again = seen.begin("hall", "1", now);
    ASSERT_EQ(again.stage, Stage::answered);
    EXPECT_EQ(again.result->text, "first");
    EXPECT_EQ(seen.begin("yard", "1", now).stage, Stage::under_way) << "one without a result is never forgotten";
    EXPECT_EQ(seen.begin("hall", "1", now + std::chrono::milliseconds(1)).stage, Stage::is_new);
}

TEST(CommandsSeen, SourceAndIdAreNotMixedUp) {
    CommandsSeen seen;
    EXPECT_EQ(seen.begin("ab", "c", at_ns(0)).stage, Stage::is_new);
    EXPECT_EQ(seen.begin("a", "bc", at_ns(0)).stage, Stage::is_new);
}

TEST(CommandsSeen, TurnsNewOnesAwayRatherThanForgetting) {
    CommandsSeen seen;
    for (std::size_t i = 0; i < CommandsSeen::most; ++i)
        ASSERT_EQ(seen.begin("s", std::to_string(i), at_ns(0)).stage, Stage::is_new);
    EXPECT_EQ(seen.begin("s", "more", at_ns(0)).stage, Stage::no_room);
    EXPECT_EQ(seen.begin("s", "0", at_ns(0)).stage, Stage::under_way);
    seen.end("s", "0", result_with("x"), at_ns(0));
    EXPECT_EQ(seen.begin("s", "more", at_ns(0)).stage, Stage::no_room);
    EXPECT_EQ(seen.begin("s", "more", at_ns(0) + CommandsSeen::keep_for).stage, Stage::is_new);
    EXPECT_EQ(seen.size(), CommandsSeen::most);
}

TEST(CommandsSeen, AFloodOfOneWriterLeavesRoomForTheOthers) {
    CommandsSeen seen;
    std::size_t taken = 0;
    for (std::size_t i = 0; i < 2 * CommandsSeen::most; ++i)
        taken += seen.begin("invented " + std::to_string(i), "1", at_ns(0), 7).stage == Stage::is_new ? 1 : 0;
    EXPECT_EQ(taken, CommandsSeen::most - CommandsSeen::kept_for_others);
    for (std::size_t i = 0; i < CommandsSeen::share; ++i)
        EXPECT_EQ(seen.begin("anna", std::to_string(i), at_ns(0), 8).stage, Stage::is_new) << i;
    EXPECT_EQ(seen.begin("invented 0", "1", at_ns(0), 7).stage, Stage::under_way) << "nothing is forgotten for it";
    for (std::size_t i = 0; i < taken; ++i)
        seen.end("invented " + std::to_string(i), "1", {}, at_ns(0));
    EXPECT_EQ(seen.begin("invented", "later", at_ns(0) + CommandsSeen::keep_for, 7).stage, Stage::is_new) << "its places are free again";
}
}  // namespace
}  // namespace axisgate::dds
