// A command is the same, and is refused with the same text, whether its wish was made of JSON or of values.
#include "gateway/services/command_wish.hpp"

#include <gtest/gtest.h>

#include <boost/json/parse.hpp>

#include "gateway/services/command_reader.hpp"

namespace axisgate {
namespace {
CommandWish of_json(std::string_view text) { return read_command_wish(boost::json::parse(text).get_object()); }
std::string told(const std::vector<Fault>& faults) {
    std::string s;
    for (const auto& f : faults)
        s += f.pointer + ": " + f.text + "; " + f.remedy + "\n";
    return s;
}

TEST(CommandWish, MembersAreValuesInTheUnitAndWhatIsNoValueStaysInIt) {
    const auto move =
        of_json(R"({"command":"move_velocity","velocity":-2.5,"acceleration":"x","hold_ms":null,"prepare":1,"renew":true,"speed":1})");
    EXPECT_EQ(move.word, CommandWord::move_velocity);
    EXPECT_EQ(move.name, "move_velocity");
    EXPECT_EQ(std::get<double>(move.velocity), -2.5);
    EXPECT_EQ(std::get<NoNumber>(move.acceleration).written, "\"x\"");
    EXPECT_EQ(move.hold_ms.index(), 0u) << "null is not given";
    EXPECT_EQ(move.prepare, WishedFlag::no_flag);
    EXPECT_EQ(move.renew, WishedFlag::yes);
    EXPECT_EQ(move.unknown, std::vector<std::string>{"speed"});
    EXPECT_EQ(of_json("{}").word, CommandWord::missing);
    EXPECT_EQ(of_json(R"({"command":7})").word, CommandWord::no_text);
    EXPECT_EQ(of_json(R"({"command":"fly"})").word, CommandWord::unknown);
    EXPECT_EQ(of_json(R"({"command":"fly"})").name, "fly");
    EXPECT_TRUE(is_stop(of_json(R"({"command":"halt","position":1})").word)) << "whatever else was given";
    EXPECT_FALSE(is_stop(CommandWord::disable));
}

TEST(CommandWish, ACommandOfValuesIsTheOneOfTheSameJson) {
    CommandWish wish = CommandWish::named("move_relative");
    wish.position = 2.5;
    wish.velocity = 1.0;
    wish.prepare = WishedFlag::yes;
    const auto made = make_command(wish, 3200, "mm");
    const auto read = read_command(
        boost::json::parse(R"({"command":"move_relative","position":2.5,"velocity":1,"prepare":true})").get_object(), 3200, "mm");
    ASSERT_TRUE(made.body && read.body);
    const auto &a = std::get<Move>(*made.body), &b = std::get<Move>(*read.body);
    EXPECT_EQ(a.kind, Move::Kind::relative);
    EXPECT_EQ(a.target, 8000);
    EXPECT_EQ(a.target, b.target);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_TRUE(a.prepare_only && b.prepare_only);
}

TEST(CommandWish, AMemberThatTheCommandDoesNotTakeIsRefusedHoweverItCame) {
    CommandWish wish = CommandWish::named("home");
    wish.method = 17.5;
    wish.position = 1.0;
    wish.renew = WishedFlag::yes;
    EXPECT_EQ(told(make_command(wish, 3200, "mm").faults),
              told(make_command(of_json(R"({"command":"home","method":17.5,"position":1,"renew":true})"), 3200, "mm").faults));
    EXPECT_EQ(told(make_command(wish, 3200, "mm").faults),
              "/position: home does not know position; remove it; home takes method\n"
              "/renew: home does not know renew; remove it; home takes method\n"
              "/method: method must be a whole number; write a CiA 402 homing method, or 0 for the drive's own\n");
}

TEST(CommandWish, FaultsAreToldInTheOrderOfTheMembersAndInTheUnitOfTheAxis) {
    const auto wish = of_json(R"({"speed":1,"command":"move_absolute","velocity":0,"acceleration":"x","deceleration":-0.5,"prepare":0})");
    EXPECT_EQ(told(make_command(wish, 3200, "mm").faults),
              "/speed: move_absolute does not know speed; remove it; move_absolute takes position, velocity, acceleration, deceleration, "
              "prepare\n"
              "/position: move_absolute needs position; add \"position\", in mm\n"
              "/velocity: velocity must be above 0, not 0; the direction follows from the position\n"
              "/acceleration: acceleration must be a number, not \"x\"; write it in mm/s^2\n"
              "/deceleration: deceleration must be above 0, not -0.5; write a positive value\n"
              "/prepare: prepare must be true or false; write \"prepare\": true\n");
    EXPECT_NE(told(make_command(wish, 1, "").faults).find("in increments\n"), std::string::npos) << "one wish, another axis";
}

TEST(CommandWish, ASetPointOfValuesIsTheOneOfTheSameJson) {
    SetPointWish wish;
    wish.mode = SetPoint::Mode::velocity;
    wish.value = -2.5;
    wish.acceleration = 10.0;
    wish.good_for_ms = 20.0;
    const auto made = make_set_point(wish, 3200, "mm");
    ASSERT_TRUE(made.set_point);
    EXPECT_EQ(made.set_point->value, -8000);
    EXPECT_EQ(made.set_point->acceleration, 32000);
    EXPECT_EQ(made.set_point->good_for, std::chrono::milliseconds(20));
    const auto nothing = [](const SetPointWish& w) { return told(make_set_point(w, 3200, "mm").faults); };
    EXPECT_EQ(nothing({}), nothing(read_set_point_wish({})));
    EXPECT_EQ(nothing({}),
              "/mode: mode must be \"position\", \"velocity\" or \"torque\"; write what the value is\n"
              "/value: a set-point needs value; add \"value\", in mm\n");
}
}  // namespace
}  // namespace axisgate
