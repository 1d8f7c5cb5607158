// The adapter with twins on a simulated RS-485 line: the telegrams of each command, counts, refusals, stops, parameters, actions, tables,
// speed. A command that was only accepted must not be answered as done.
#include <fmt/core.h>

#include "adapters/linmot/tests/line_bench.hpp"
#include "gateway/core/command_arguments.hpp"

namespace axisgate::linmot::test {

Result LineBench::act(const std::string& name, const boost::json::object& arguments, std::size_t axis) {
    const auto* c = page().command(name);
    EXPECT_TRUE(c) << name;
    auto checked = check_arguments(*c, arguments);
    EXPECT_TRUE(checked.faults.empty()) << (checked.faults.empty() ? "" : checked.faults[0].text);
    return ask(Action{name, {}, std::move(checked.values)}, axis);
}

namespace {
const boost::json::object to_10_mm{{"position", 10}, {"velocity", 0.1}, {"acceleration", 1}, {"deceleration", 1}};
Point point(const char* id) { return page().find(id).value(); }

TEST(LinmotAdapter, FindsItsDrivesAndTellsTheirState) {
    LineBench b(3);
    b.run(2s);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(b.links[DriveId{static_cast<std::uint16_t>(i)}].online);
        EXPECT_EQ(b.axis(i).power, AxisFeedback::Power::off);
    }
    EXPECT_EQ(b.drive().control_word() & 1, 1) << "nothing was written to a drive that was found";
    ASSERT_TRUE(b.enable(1));
    EXPECT_EQ(b.drive(0).state(), 0);
    EXPECT_EQ(b.drive(1).state(), 8);
    EXPECT_EQ(b.axis(1).native_status >> 24, 8u);
}

TEST(LinmotAdapter, GoesOnFromTheDrivesOwnCountAfterARestart) {
    LineBench b;
    b.run(1s);
    ASSERT_TRUE(b.enable());
    EXPECT_TRUE(good(b.act("VAI Go To Pos", to_10_mm)));
    b.run(1s);
    const auto count = b.drive().state_var() & 15;
    // A new gateway with the same drive.
    b.adapter = std::make_unique<LineAdapter>(page());
    Out out;
    b.adapter->configure(b.setup, b.now, out);
    b.adapter->on_line(true, b.now, out);
    for (const auto& f : out.frames)
        (void)b.bus->send(f.frame, f.priority, b.now);
    b.run(1s);
    EXPECT_EQ(b.drive().state(), 8) << "and it is not switched off by that";
    Move m;
    m.target = 0;
    m.velocity = 100'000;
    EXPECT_TRUE(good(b.ask(m)));
    EXPECT_EQ(b.drive().state_var() & 15, (count + 1) & 15);
    b.run(2s);
    EXPECT_EQ(b.axis().position, 0);
    EXPECT_TRUE(b.axis().target_reached);
}

TEST(LinmotAdapter, MotionCommandsByName) {
    LineBench b;
    b.run(1s);
    ASSERT_TRUE(b.enable());
    const Result r = b.act("VAI Go To Pos", to_10_mm);
    EXPECT_EQ(r.outcome, Outcome::accepted) << r.text;
    EXPECT_TRUE(b.axis().moving);
    b.run(1s);
    EXPECT_EQ(b.axis().position, 100'000);
    EXPECT_TRUE(b.axis().target_reached);
    EXPECT_TRUE(good(b.act("010xh", {{"position", -1.5}, {"velocity", 1}, {"acceleration", 10}, {"deceleration", 10}})));
    b.run(1s);
    EXPECT_EQ(b.axis().position, -15'000);
    const Result text = b.ask(Action{"Predef VAI Go To Pos", "position=2", {}});
    EXPECT_TRUE(good(text)) << text.text;
    EXPECT_EQ(b.ask(Action{"Predef VAI Go To Pos", "position=x", {}}).reason, Reason::out_of_range);
    EXPECT_EQ(b.ask(Action{"No Such Command", "", {}}).reason, Reason::unknown_point);
}

TEST(LinmotAdapter, WhatTheDriveRefusesIsToldWithItsCode) {
    LineBench b;
    b.run(1s);
    (void)b.hand("control_mask", Value{std::int64_t{0x08}});  // a PC tool controls bit 3: state 6
    const Result off = b.ask(Enable{});
    EXPECT_EQ(off.outcome, Outcome::failed);
    EXPECT_NE(off.text.find("state 6"), std::string::npos) << off.text;
    const Result r = b.act("VAI Go To Pos", to_10_mm);
    EXPECT_EQ(r.reason, Reason::drive_refused);
    EXPECT_EQ(r.code, 0x86);
    EXPECT_NE(r.text.find("Motion Cmd In Wrong St"), std::string::npos) << r.text;
    b.run(100ms);
    EXPECT_TRUE(b.axis().fault);
    EXPECT_EQ(b.axis().error_code, 0x86);
    EXPECT_EQ(std::ranges::count(b.notices, std::string("alarm"), &Notice::kind), 1);
    (void)b.hand("control_mask", Value{std::int64_t{0}});
    EXPECT_TRUE(good(b.ask(ResetFault{})));
    EXPECT_FALSE(b.axis().fault);
    LineBench small(1, 115200, {{"series", "b1100"}});
    small.run(1s);
    ASSERT_TRUE(small.enable());
    const Result winding = small.act("Encoder Winding Start With Default Parameters");
    EXPECT_EQ(winding.code, 0x81) << winding.text;
}

TEST(LinmotAdapter, ACountThatDidNotChangeIsTold) {
    LineBench b;
    b.run(1s);
    ASSERT_TRUE(b.enable());
    const auto count = static_cast<int>(b.drive().state_var() & 15);
    char text[40];
    std::snprintf(text, sizeof text, "00 02 %02X 02 A0 86 01 00", count);
    const std::string send = text;
    const Result r = b.ask(Native{{send.begin(), send.end()}, true});
    EXPECT_EQ(r.outcome, Outcome::done);
    EXPECT_NE(r.text.find("the drive has not executed it"), std::string::npos) << r.text;
    b.run(1s);
    EXPECT_EQ(b.axis().position, 0);
    const auto wrong = b.ask(Native{{'0', '1', ' ', '0'}, true});
    EXPECT_EQ(wrong.outcome, Outcome::refused);
    const Result whole = b.ask(Native{bytes_of("01 11 03 02 01 00 04"), false});
    EXPECT_EQ(whole.bytes.size(), 16u);
    EXPECT_EQ(b.ask(Native{bytes_of("01 12 03 02 01 00 04"), false}).outcome, Outcome::refused) << "another drive's ID";
}

TEST(LinmotAdapter, AReconfiguredResponseIsRefusedWithItsReason) {
    LineBench b;
    b.run(1s);
    EXPECT_TRUE(b.links[DriveId{0}].online);
    Out out;
    LineAdapter alone{page()};
    alone.configure(b.setup, b.now, out);
    alone.on_line(true, b.now, out);
    ASSERT_EQ(out.frames.size(), 1u);
    out.clear();
    alone.on_frame(Frame::run(bytes_of("01 11 0E 02 00 00 00 00 00 00 00 00 00 00 00 00 00 04")), b.now, out);
    ASSERT_EQ(out.links.size(), 1u);
    EXPECT_FALSE(out.links[0].online);
    EXPECT_NE(out.links[0].text.find("reconfigured"), std::string::npos);
    ASSERT_EQ(out.notices.size(), 1u) << "it is told, too";
    EXPECT_EQ(out.notices[0].kind, "not_served");
}

TEST(LinmotAdapter, AnswersOfOthersAreNobodys) {
    LineBench b;
    Out out;
    LineAdapter alone{page()};
    alone.configure(b.setup, b.now, out);
    alone.on_line(true, b.now, out);
    out.clear();
    alone.on_frame(Frame::run(bytes_of("01 12 0C 02 00 00 00 37 28 A2 08 5E 81 01 00 04")), b.now, out);
    EXPECT_TRUE(out.feedback.empty());
    EXPECT_TRUE(out.links.empty());
    EXPECT_EQ(alone.counters().unexpected, 1u);
}

TEST(LinmotAdapter, StopsOvertakeAndInterrupt) {
    LineBench b;
    b.run(1s);
    ASSERT_TRUE(b.enable());
    Move m;
    m.target = 10'000'000;
    m.velocity = 100'000;
    m.acceleration = m.deceleration = 1'000'000;
    EXPECT_TRUE(good(b.ask(m)));
    b.run(500ms);
    const Ticket waits = b.submit(m), reads = b.submit(ReadParameter{point("14BEh")});
    EXPECT_EQ(b.ask(Halt{}).outcome, Outcome::accepted);
    EXPECT_EQ(b.results[waits].at(0).reason, Reason::interrupted);
    b.run(1s);
    EXPECT_TRUE(good(b.results[reads].at(0)));
    EXPECT_FALSE(b.axis().moving);
    EXPECT_EQ(b.drive().state(), 8);
    EXPECT_TRUE(good(b.ask(m)));
    b.run(300ms);
    EXPECT_TRUE(good(b.ask(QuickStop{})));
    b.run(100ms);
    EXPECT_EQ(b.drive().state(), 12);
    EXPECT_TRUE(b.axis().quick_stopping);
    const double here = b.drive().actual();
    ASSERT_TRUE(b.enable());
    b.run(1s);
    EXPECT_EQ(b.drive().actual(), here) << "the command was cleared";
    EXPECT_TRUE(good(b.ask(Disable{})));
    EXPECT_LT(b.drive().state(), 8);
}

TEST(LinmotAdapter, HomingEndsWithTheBitTakenBack) {
    LineBench b;
    b.run(1s);
    (void)b.hand("position", Value{std::int64_t{200'000}});
    ASSERT_TRUE(b.enable());
    EXPECT_EQ(b.ask(Home{}).outcome, Outcome::accepted);
    EXPECT_TRUE(b.axis().homing);
    b.run(3s);
    EXPECT_TRUE(b.axis().homing_attained);
    EXPECT_TRUE(b.axis().referenced);
    EXPECT_EQ(b.axis().position, 0);
    EXPECT_EQ(b.drive().state(), 8);
    EXPECT_TRUE(good(b.ask(SetPosition{5000})));
    b.run(100ms);
    EXPECT_EQ(b.axis().position, 5000);
    EXPECT_EQ(b.ask(Home{18}).reason, Reason::not_supported);
}

TEST(LinmotAdapter, RamAndRomValues) {
    LineBench b;
    b.run(1s);
    EXPECT_EQ(b.ask(ReadParameter{point("14BEh")}).value, Value{std::int64_t{100'000}});
    EXPECT_EQ(b.ask(WriteParameter{point("14BEh"), std::int64_t{5000}}).value, Value{std::int64_t{5000}});
    EXPECT_EQ(b.drive().ram(0x14BE), 5000u);
    EXPECT_EQ(b.ask(ReadParameter{point("14BEh.rom")}).value, Value{std::int64_t{100'000}});
    EXPECT_TRUE(good(b.ask(WriteParameter{point("14BEh.rom"), std::int64_t{6000}})));
    EXPECT_EQ(b.drive().memory.rom(0x14BE), 6000u);
    EXPECT_EQ(b.ask(ReadParameter{point("1717h")}).value, Value{false});
    EXPECT_EQ(b.ask(ReadParameter{point("146Eh")}).value, Value{std::int64_t{-100'000'000}});
    EXPECT_EQ(b.ask(ReadParameter{point("WarnWord")}).reason, Reason::not_supported) << "inferred, and not asked for";
    EXPECT_EQ(b.ask(ReadParameter{point("StateVar")}).value, Value{std::int64_t{0}});
    LineBench with(1, 115200, {{"warn_word", "inferred"}});
    with.run(1s);
    EXPECT_EQ(with.ask(ReadParameter{point("WarnWord")}).value, Value{std::int64_t{0x80}}) << "not homed";
}

TEST(LinmotAdapter, ACommandTableIsWrittenReadAndRun) {
    LineBench b;
    b.run(1s);
    ASSERT_TRUE(b.enable());
    const auto row = [&](int n, const char* command, const char* arguments, int next) {
        const Result r =
            b.act("table.write", {{"entry", n}, {"command", command}, {"arguments", arguments}, {"next", next}, {"label", "row"}});
        EXPECT_TRUE(good(r)) << n << ": " << r.text;
    };
    row(1, "Set Cmd Table Var 1 To", "value=0", 2);
    row(2, "VAI Go To Pos", "position=20, velocity=1, acceleration=50, deceleration=50", 3);
    row(3, "Wait Until Motion Finished", "", 4);
    row(4, "VAI Go To Pos", "position=0 velocity=1 acceleration=50 deceleration=50", 5);
    row(5, "Wait Until Motion Finished", "", 6);
    row(6, "Add To Cmd Table Var 1", "value=1", 7);
    row(7, "IF Cmd Table Var 1 Less Than", "value=3 entry_if_true=2 entry_if_false=8", 0);
    row(8, "No Operation", "", 0);
    EXPECT_EQ(b.act("table.presence").text, "1 2 3 4 5 6 7 8");
    EXPECT_EQ(b.act("table.read", {{"entry", 2}}).text,
              "VAI Go To Pos: position=20 velocity=1 acceleration=50 deceleration=50; next=3; name=row");
    EXPECT_TRUE(good(b.act("Start Command Table Command", {{"entry", 1}})));
    b.run(2s);
    EXPECT_EQ(b.drive().ram(0x1E72), 3u);
    EXPECT_EQ(b.axis().position, 0);
    const auto touched = b.adapter->counters().exchanges;
    const Result bad = b.act("table.write", {{"entry", 9}, {"command", "VAI Go To Pos"}, {"arguments", "position=20"}});
    EXPECT_EQ(bad.reason, Reason::out_of_range);
    EXPECT_NE(bad.text.find("velocity is missing"), std::string::npos) << bad.text;
    EXPECT_LE(b.adapter->counters().exchanges, touched + 1) << "before the drive's memory is touched";
    EXPECT_FALSE(b.drive().table.contains(9));
    EXPECT_TRUE(good(b.act("table.delete", {{"entry", 2}})));
    EXPECT_FALSE(b.drive().table.contains(2));
    EXPECT_EQ(b.act("table.save").code, 0xD7) << "the software runs";
}

TEST(LinmotAdapter, WhatTheDriveSaysOfItself) {
    LineBench b;
    b.run(1s);
    EXPECT_EQ(b.act("error.text", {{"code", 1}}).text, "Err: X4 Logic Supply Too Low");
    EXPECT_EQ(b.act("error.counters").text, "21 entries in the error log, 0 errors have occurred");
    EXPECT_EQ(b.act("parameter.info", {{"upid", 0x13A2}}).text, "usage 010Fh (live)\ntype UINT16\nmin 0\nmax 65535\ndefault 9");
    EXPECT_EQ(b.act("parameter.list", {{"first", 0x2000}}).text,
              "2008h usage 000Dh type RADIO_DIR_BIT\n2080h usage 000Dh type UINT16\n2136h usage 1001h type UINT16");
    EXPECT_TRUE(good(b.act("program.stop")));
    b.run(100ms);
    EXPECT_FALSE(b.drive().software_runs());
    EXPECT_TRUE(good(b.act("program.start")));
    EXPECT_TRUE(b.drive().software_runs());
    LineBench strict(1, 115200, {{"inferred", "off"}});
    strict.run(1s);
    EXPECT_EQ(strict.act("table.read", {{"entry", 1}}).reason, Reason::not_supported);
    EXPECT_EQ(strict.act("VAI Dec=Acc Infinite Motion Positive Direction", {{"velocity", 1}, {"acceleration", 1}}).reason,
              Reason::not_supported);
}

TEST(LinmotAdapter, ChecksumsWorkAndSayThatTheyAreNotProven) {
    for (const char* kind : {"sum", "crc", "crc_reflected"}) {
        LineBench b(1, 115200, {}, {}, {{"checksum", kind}});
        b.run(1s);
        EXPECT_TRUE(b.links[DriveId{0}].online) << kind;
        EXPECT_EQ(std::ranges::count(b.notices, std::string("setup"), &Notice::kind), 1);
    }
}

TEST(LinmotAdapter, StreamedSetPointsAreMovesAndNeverTheDrivesOwnStream) {
    // 0: a line without a bit rate, as over TCP. However frequent the set-points are, no stream is started whose period of 2 to 5 ms cannot
    // be kept.
    for (const std::uint32_t bit_rate : {115'200u, 0u}) {
        SCOPED_TRACE(bit_rate);
        LineBench b(1, bit_rate);
        b.run(1s);
        ASSERT_TRUE(b.enable());
        std::size_t moves = 0;
        std::uint32_t last = 0;
        for (int i = 1; i <= 500; ++i) {
            b.stream(i * 20);  // 10 mm/s
            b.run(2ms);
            const std::uint32_t header = b.drive().ram(0x1DB0);
            ASSERT_TRUE(header >> 4 == 0x010 || (i < 10 && header == 0)) << header;
            moves += header != last;
            last = header;
        }
        EXPECT_GT(moves, 100u) << "it follows";
        EXPECT_EQ(b.drive().error_code(), 0);
        b.run(250ms);  // a gap, which would be error 0083h during a stream
        EXPECT_EQ(b.drive().error_code(), 0);
        b.run(1s);
        EXPECT_EQ(b.drive().actual(), 10'000) << "the newest one counts";
    }
}

TEST(LinmotAdapter, TheDrivesOwnStreamCarriesSetPointsWhereTheLineHoldsIt) {
    LineBench b(1, 115'200, {{"set_points", "stream"}});
    b.run(1s);
    ASSERT_TRUE(b.enable());
    double worst = 0;
    const auto begin = b.now;
    const auto place = [&](Instant at) { return 100'000 * (1 - std::cos(seconds(at - begin) * 3.14)); };  // +-10 mm
    for (int i = 0; i < 400; ++i) {
        b.stream(std::llround(place(b.now)), 1'000'000, 50'000'000);
        b.run(10ms);
        ASSERT_EQ(b.drive().error_code(), 0) << i;
        if (i > 20) ASSERT_EQ(b.drive().ram(0x1DB0) >> 4, 0x031u);
        if (i > 20) worst = std::max(worst, std::fabs(place(b.now) - b.drive().actual()));
    }
    EXPECT_LT(worst, 314'000 * 0.030) << "a period of the client, and 1.5 of the drive, behind at 314,000 increments/s";
    EXPECT_TRUE(b.stream_ends.empty());
    // No new set-point arrives: the last one is held, without an error of the drive.
    b.stream(50'000, 1'000'000, 50'000'000);
    b.run(1s);
    EXPECT_EQ(b.drive().error_code(), 0);
    EXPECT_EQ(b.drive().actual(), 50'000);
    // Other exchanges are refused, with this reason.
    const Ticket t = b.submit(ReadParameter{*page().find("14BEh")});
    b.run(50ms);
    ASSERT_EQ(b.results[t].size(), 1u);
    EXPECT_EQ(b.results[t].front().reason, Reason::busy);
    // A halt ends the stream; afterwards other exchanges are possible again.
    b.stream(500'000, 1'000'000, 50'000'000);
    b.run(100ms);
    EXPECT_TRUE(b.ask(Halt{}).outcome == Outcome::accepted);
    b.run(500ms);
    EXPECT_EQ(b.drive().error_code(), 0);
    const auto rest = b.drive().actual();
    EXPECT_LT(rest, 400'000);
    b.run(500ms);
    EXPECT_EQ(b.drive().actual(), rest);
    EXPECT_EQ(b.drive().ram(0x1DB0) >> 4, 0x017u);
    EXPECT_EQ(b.ask(ReadParameter{*page().find("14BEh")}).outcome, Outcome::done);
    Move m;
    m.target = 10'000;
    m.velocity = 1'000'000;
    m.acceleration = m.deceleration = 50'000'000;
    EXPECT_EQ(b.ask(m).outcome, Outcome::accepted);
    b.run(2s);
    EXPECT_EQ(b.drive().actual(), 10'000);
}

TEST(LinmotAdapter, AStreamThatTheDriveEndsIsSaid) {
    LineBench b(1, 115'200, {{"set_points", "auto"}});  // the line can keep the period
    b.run(1s);
    ASSERT_TRUE(b.enable());
    for (int i = 0; i < 20; ++i) {
        b.stream(i * 100);
        b.run(10ms);
    }
    ASSERT_EQ(b.hand("silent", Value{true}), "");
    b.run(30ms);
    ASSERT_EQ(b.hand("silent", Value{false}), "");
    b.run(100ms);
    EXPECT_TRUE(b.stream_ends.empty()) << "answers that are lost are no gap: the drive has heard all of it";
    b.now += 30ms;  // the host is delayed: a gap for the drive
    b.run(300ms);
    ASSERT_FALSE(b.stream_ends.empty());
    EXPECT_NE(b.stream_ends.front().text.find("0083h"), std::string::npos) << b.stream_ends.front().text;
    EXPECT_TRUE(b.feedback.begin()->second.fault);
}

TEST(LinmotAdapter, AStreamIsNotBegunWhereItsPeriodCannotBeHeld) {
    struct Case {
        std::size_t drives;
        std::uint32_t bit_rate;
    };
    for (const Case c : {Case{1, 0}, Case{1, 57'600}, Case{2, 115'200}}) {
        SCOPED_TRACE(testing::Message() << c.drives << " at " << c.bit_rate);
        const auto reported = [](const LineBench& of) {
            return std::ranges::any_of(of.notices, [](const Notice& n) { return n.text.find("cannot hold") != std::string::npos; });
        };
        EXPECT_FALSE(reported(LineBench(c.drives, c.bit_rate, {{"set_points", "auto"}}))) << "it may be so";
        LineBench b(c.drives, c.bit_rate, {{"set_points", "stream"}});
        EXPECT_TRUE(reported(b));
        b.run(1s);
        ASSERT_TRUE(b.enable());
        for (int i = 1; i <= 50; ++i) {
            b.stream(i * 100);
            b.run(10ms);
        }
        EXPECT_EQ(b.drive().ram(0x1DB0) >> 4, 0x010u) << "moves";
        EXPECT_EQ(b.drive().error_code(), 0);
    }
}

TEST(LinmotAdapter, PollsFillTheWire) {
    // 115200 baud: a default request and its response are 23 bytes, 2.0 ms.
    LineTiming quick;
    quick.poll_period = 1ms;
    LineBench b(4, 115200, {}, quick);
    b.run(2s);
    const auto before = b.adapter->counters().exchanges;
    b.run(10s);
    const double wire = static_cast<double>(b.adapter->counters().exchanges - before) * 23 * 10 / 115200 / 10;
    EXPECT_GE(wire, 0.95);
    EXPECT_LE(wire, 1.0 + 1e-3);
}

TEST(LinmotAdapter, ReadingAllParametersTakesTheTimeOfTheWire) {
    LineTiming calm;
    calm.poll_period = 1s;
    LineBench b(1, 115200, {}, calm);
    b.run(1s);
    for (const char* n : {"1", "2", "3"})
        ASSERT_TRUE(good(b.ask(WriteParameter{*page().find(fmt::format("table[{}]", n)), Value{std::string("VAI Stop: deceleration=1")}})));
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("curve[1]"), Value{std::string("x=time; length=0.5; points=0 1 4 10 20 30")}})));
    const Instant begin = b.now;
    double bytes = 0;
    std::size_t elements = 0;
    std::vector<Ticket> open;
    for (std::uint16_t i = 0; i < page().parameters().size(); ++i) {
        const Parameter& p = page().parameters()[i];
        const bool rom = p.id.ends_with(".rom");
        if (p.id == "WarnWord") continue;
        for (std::uint16_t n = 0; n < std::max<std::uint16_t>(p.count, 1); ++n) {
            const auto element = static_cast<std::uint16_t>(p.count ? p.first + n : 0);
            // For existing items: the size, then 4 bytes at a time: 64 of an entry; 70 of a curve's description, 4 of each of its points.
            const double exchanges = p.count == 0 || element > 3 ? 1 : p.count == 255 ? 1 + 16 : element == 1 ? 1 + 18 + 6 : 1;
            bytes += p.count ? exchanges * (9 + 14) : p.wire.contains("item") ? 7 + 16 : rom ? 9 + 14 : 9 + 20;
            ++elements;
            open.push_back(b.submit(ReadParameter{{i, element}}));
            if (open.size() < 32) continue;
            for (const Ticket t : open) {
                while (b.results[t].empty())
                    b.run(100us);
                EXPECT_NE(b.results[t][0].reason, Reason::busy);
            }
            open.clear();
        }
    }
    for (const Ticket t : open) {
        while (b.results[t].empty())
            b.run(100us);
    }
    const double took = seconds(b.now - begin), wire = bytes * 10 / 115200;
    EXPECT_LE(took, wire * 1.1) << "of " << wire << " s";
    EXPECT_GE(took, wire) << "the time of the wire itself";
    EXPECT_GT(elements, 350u) << "each of the 255 entries and 100 curves";
}

}  // namespace
}  // namespace axisgate::linmot::test
