// Bodies of commands: conversion of units to whole increments, and every refusal.
#include "gateway/services/command_reader.hpp"

#include <gtest/gtest.h>
#include <boost/json/parse.hpp>

namespace axisgate::http {
namespace {
ReadCommand read(std::string_view text, double scale = 3200) { return read_command(boost::json::parse(text).get_object(), scale, "mm"); }

TEST(CommandReader, Converts) {
    const auto m = read(R"({"command":"move_absolute","position":-100.5,"velocity":50,"acceleration":500.25,"deceleration":1e3})");
    ASSERT_TRUE(m.body);
    const auto& move = std::get<Move>(*m.body);
    EXPECT_EQ(move.kind, Move::Kind::absolute);
    EXPECT_EQ(move.target, -321600);
    EXPECT_EQ(move.velocity, 160000);
    EXPECT_EQ(move.acceleration, 1600800);
    EXPECT_EQ(move.deceleration, 3200000);
    EXPECT_FALSE(move.prepare_only);
    EXPECT_EQ(std::get<Move>(*read(R"({"command":"move_relative","position":0.0001})", 3200).body).target, 0);  // 0.32 increments
    EXPECT_EQ(std::get<Move>(*read(R"({"command":"move_relative","position":0.0002})", 3200).body).target, 1);  // 0.64
    EXPECT_EQ(std::get<Move>(*read(R"({"command":"move_relative","position":-2.5})", 1).body).target, -3);
    EXPECT_TRUE(std::get<Move>(*read(R"({"command":"move_relative","position":1,"prepare":true})").body).prepare_only);
    const auto v = std::get<Move>(*read(R"({"command":"move_velocity","velocity":-2})").body);
    EXPECT_EQ(v.kind, Move::Kind::velocity);
    EXPECT_EQ(v.target, -6400);
    EXPECT_FALSE(v.velocity);
    EXPECT_EQ(std::get<Move>(*read(R"({"command":"move_velocity","velocity":0})").body).target, 0) << "0 stops a velocity motion";
    EXPECT_EQ(std::get<SetPosition>(*read(R"({"command":"set_position","position":2})").body).position, 6400);
    EXPECT_EQ(std::get<Home>(*read(R"({"command":"home"})").body).method, 0);
    EXPECT_EQ(std::get<Home>(*read(R"({"command":"home","method":-3})").body).method, -3);
    EXPECT_EQ(std::get<Home>(*read(R"({"command":"home","method":17.0})").body).method, 17);
    EXPECT_FALSE(std::get<Move>(*read(R"({"command":"move_absolute","position":1,"velocity":null})").body).velocity) << "null is not given";
}

TEST(CommandReader, DeadManTimeOutOfAVelocityMove) {
    EXPECT_EQ(std::get<Move>(*read(R"({"command":"move_velocity","velocity":1,"hold_ms":700})").body).hold_ms, 700);
    EXPECT_FALSE(std::get<Move>(*read(R"({"command":"move_velocity","velocity":1})").body).hold_ms);
    for (const auto* wrong : {"99", "10001", "0.5", "\"700\"", "-1", "1e30"}) {
        const auto r = read(R"({"command":"move_velocity","velocity":1,"hold_ms":)" + std::string(wrong) + "}");
        EXPECT_FALSE(r.body) << wrong;
        ASSERT_EQ(r.faults.size(), 1u) << wrong;
        EXPECT_EQ(r.faults[0].pointer, "/hold_ms") << wrong;
    }
    EXPECT_TRUE(std::get<Move>(*read(R"({"command":"move_velocity","velocity":1,"hold_ms":700,"renew":true})").body).renew_only);
    EXPECT_FALSE(read(R"({"command":"move_velocity","velocity":1,"renew":true})").body) << "renew what, for how long?";
    EXPECT_FALSE(read(R"({"command":"move_absolute","position":1,"hold_ms":700})").body)
        << "a move that ends by itself needs nobody's hand";
}

TEST(CommandReader, SimpleCommands) {
    for (const auto* name : {"enable", "disable", "quick_stop", "halt", "reset_fault"}) {
        const auto r = read("{\"command\":\"" + std::string(name) + "\"}");
        ASSERT_TRUE(r.body) << name;
        EXPECT_EQ(name_of(*r.body), name);
        EXPECT_FALSE(read("{\"command\":\"" + std::string(name) + "\",\"position\":1}").body) << "takes nothing else";
    }
}

TEST(CommandReader, Refuses) {
    struct Row {
        const char* body;
        const char* pointer;
        const char* says;
        bool range;
    };
    for (const auto& [body, pointer, says, range] :
         {Row{R"({})", "/command", "command is missing", false},
          Row{R"({"command":5})", "/command", "must be a text", false},
          Row{R"({"command":"fly"})", "/command", "there is no command fly", false},
          Row{R"({"command":"move_absolute"})", "/position", "needs position", false},
          Row{R"({"command":"move_absolute","position":null})", "/position", "needs position", false},
          Row{R"({"command":"move_absolute","position":"1"})", "/position", "must be a number, not \"1\"", false},
          Row{R"({"command":"move_absolute","position":true})", "/position", "must be a number", false},
          Row{R"({"command":"move_absolute","position":1,"speed":2})", "/speed", "does not know speed", false},
          Row{R"({"command":"move_absolute","position":1,"velocity":0})", "/velocity", "above 0", true},
          Row{R"({"command":"move_absolute","position":1,"velocity":-1})", "/velocity", "above 0", true},
          Row{R"({"command":"move_absolute","position":1,"velocity":0.0001})", "/velocity", "less than 1 increment/s", true},
          Row{R"({"command":"move_absolute","position":1,"acceleration":0})", "/acceleration", "above 0", true},
          Row{R"({"command":"move_velocity","velocity":1,"deceleration":-1})", "/deceleration", "above 0", true},
          Row{R"({"command":"move_absolute","position":1e13})", "/position", "too large", true},
          Row{R"({"command":"move_absolute","position":-1e300})", "/position", "too large", true},
          Row{R"({"command":"move_absolute","position":18446744073709551615})", "/position", "too large", true},
          Row{R"({"command":"move_velocity"})", "/velocity", "needs velocity", false},
          Row{R"({"command":"move_velocity","velocity":1,"position":2})", "/position", "does not know", false},
          Row{R"({"command":"set_position"})", "/position", "needs position", false},
          Row{R"({"command":"home","method":1.5})", "/method", "whole number", false},
          Row{R"({"command":"home","method":"1"})", "/method", "whole number", false},
          Row{R"({"command":"home","method":40000})", "/method", "outside", true},
          Row{R"({"command":"move_relative","position":1,"prepare":1})", "/prepare", "true or false", false}}) {
        const auto r = read(body);
        EXPECT_FALSE(r.body) << body;
        ASSERT_EQ(r.faults.size(), 1u) << body;
        EXPECT_EQ(r.faults[0].pointer, pointer) << body;
        EXPECT_NE(r.faults[0].text.find(says), std::string::npos) << body << ": " << r.faults[0].text;
        EXPECT_FALSE(r.faults[0].remedy.empty()) << body;
        EXPECT_EQ(r.range_only, range) << body;
    }
}

TEST(CommandReader, TellsAllFaultsAtOnce) {
    const auto r = read(R"({"command":"move_absolute","velocity":0,"acceleration":"x","speed":1})");
    EXPECT_EQ(r.faults.size(), 4u);
    EXPECT_FALSE(r.range_only);
}

TEST(CommandReader, NumbersThatAreNotFinite) {
    // 1e999 is JSON; the parser's value for it must never become increments.
    boost::system::error_code ec;
    const auto v = boost::json::parse(R"({"command":"move_absolute","position":1e999})", ec);
    if (!ec) {
        EXPECT_FALSE(read_command(v.get_object(), 1, "").body);
    } else {
        EXPECT_TRUE(ec.failed());
    }
}

ReadSetPoint streamed(std::string_view text, double scale = 3200) {
    return read_set_point(boost::json::parse(text).get_object(), scale, "mm");
}

TEST(CommandReader, SetPointsAreInTheUnitAndTorqueIsNot) {
    const auto speed = streamed(R"({"axis":"x","mode":"velocity","value":-2.5,"acceleration":10,"good_for_ms":20})");
    ASSERT_TRUE(speed.set_point);
    EXPECT_EQ(speed.set_point->mode, SetPoint::Mode::velocity);
    EXPECT_EQ(speed.set_point->value, -8000);
    EXPECT_EQ(speed.set_point->acceleration, 32000);
    EXPECT_EQ(speed.set_point->good_for, std::chrono::milliseconds(20));
    EXPECT_EQ(streamed(R"({"axis":"x","mode":"torque","value":-125})").set_point->value, -125);
    EXPECT_EQ(streamed(R"({"axis":"x","mode":"position","value":1e30})").faults.size(), 1u);
    EXPECT_EQ(streamed(R"({"axis":"x","mode":7,"value":"1","good_for_ms":1.5,"velocity":0})").faults.size(), 4u);
}
}  // namespace
}  // namespace axisgate::http
