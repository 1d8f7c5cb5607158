// Parameters, native language and actions of the UIM342 adapter, late answers, and the bounds that hold under any weather.
#include <fmt/core.h>

#include <random>

#include "adapters/uim342/native.hpp"
#include "adapters/uim342/tests/fake_bench.hpp"

namespace axisgate::uim342::test {
namespace {

struct ReadyForValues {
    Bench b;
    FakeNode& f;
    explicit ReadyForValues(bool on = false, LineKind kind = LineKind::can) : b(kind), f(b.add(5)) {
        b.start(1s);
        if (on) b.ask(Enable{});
        b.run(100ms);
        b.mark();
    }
};

// --- parameters ------------------------------------------------------------------------------------------------------------------

TEST(Uim342Values, EveryParameterOfTheCatalogueIsBoundAndReadable) {
    ReadyForValues r;
    int n = 0;
    for (std::uint16_t i = 0; i < catalogue().parameters().size(); ++i) {
        const Parameter& p = catalogue().parameters()[i];
        if (!p.readable()) continue;
        const Result x = r.b.ask(ReadParameter{{i, p.first}});
        if (p.id.starts_with("ER[")) {
            EXPECT_EQ(x.outcome, Outcome::done) << p.id << " " << x.text;
            continue;
        }
        EXPECT_EQ(x.outcome, Outcome::done) << p.id << ": " << x.text;
        EXPECT_TRUE(known(x.value)) << p.id;
        EXPECT_TRUE(known(r.b.sample(p.id))) << p.id << ": a read is also a sample";
        if (p.type == ValueType::bytes) {
            EXPECT_TRUE(std::holds_alternative<std::string>(x.value)) << p.id;
        } else {
            EXPECT_TRUE(as_integer(x.value)) << p.id;
        }
        ++n;
    }
    EXPECT_GE(n, 100);
}

TEST(Uim342Values, EveryWritableParameterTakesItsValue) {
    ReadyForValues r;
    int n = 0;
    for (std::uint16_t i = 0; i < catalogue().parameters().size(); ++i) {
        const Parameter& p = catalogue().parameters()[i];
        if (!p.writable() || p.id == "MO" || p.id == "SP") continue;
        std::int64_t v = p.allowed.empty() ? static_cast<std::int64_t>(p.min.value_or(0)) + 3 : p.allowed.back().first;
        if (p.max && static_cast<double>(v) > *p.max) v = static_cast<std::int64_t>(*p.max);
        if (p.id == "DI") v = 1;  // what is written is 0 or 1, what is read is the image of all ports
        if (p.id == "PP[7]" || p.id == "PP[8]") v = 90 + (p.id == "PP[8]");
        const Result w = r.b.write(p.id, v);
        EXPECT_EQ(w.outcome, Outcome::done) << p.id << ": " << w.text;
        EXPECT_EQ(w.value, Value{v}) << p.id;
        // JV SP PR PA read back what is, not what was written; DI reads the levels.
        if (p.id == "JV" || p.id == "PR" || p.id == "PA" || p.id == "DI" || p.id == "MF") continue;  // DI.OP1 reads what was written
        EXPECT_EQ(r.b.read(p.id).value, Value{v}) << p.id;
        ++n;
    }
    EXPECT_GE(n, 60);
}

TEST(Uim342Values, GetAndSetAreToldApartByLengthAlone) {
    ReadyForValues r;
    r.b.read("AC");
    r.b.write("AC", 500);
    EXPECT_EQ(r.b.received(5), lines({"99", "99 F4 01 00 00"}));
}

TEST(Uim342Values, GroupValuesGoAsPairs) {
    ReadyForValues r;
    EXPECT_EQ(r.b.read("MF3.AC").value, Value{std::int64_t{503}});
    EXPECT_EQ(r.b.write("MF3.AC", 1000).value, Value{std::int64_t{1000}});
    EXPECT_EQ(r.b.read("AC").value, Value{std::int64_t{10000}}) << "the selection is used up by one message";
    EXPECT_EQ(r.b.received(5), lines({"98 03", "99", "98 03", "99 E8 03 00 00", "99"}));
    EXPECT_EQ(r.b.write("MF6.SP", -250).value, Value{std::int64_t{-250}}) << "SP with a group is taken in jog mode too";
}

TEST(Uim342Values, ALostGroupValueIsRepeatedWithItsSelection) {
    for (const bool executed : {true, false}) {
        ReadyForValues r;
        int lost = 0;
        r.f.script = [&](const Message& m) {
            FakeNode::Verdict v;
            if (m.cw == 0x99 && m.dl == 4 && lost == 0) {
                ++lost;
                v.answer = false;
                v.execute = executed;
            }
            return v;
        };
        EXPECT_EQ(r.b.write("MF3.AC", 1000).outcome, Outcome::done);
        EXPECT_EQ(r.b.received(5), lines({"98 03", "99 E8 03 00 00", "98 03", "99 E8 03 00 00"}))
            << "never the value alone: it would hit group 0";
        EXPECT_EQ(r.f.group[0x0319], le(1000, 4));
        EXPECT_EQ(r.f.values[0x19FF], le(10000, 4));
    }
}

TEST(Uim342Values, AfterAGroupExchangeWithAnUnknownEndGroupZeroIsSelected) {
    for (const bool refused : {true, false}) {
        ReadyForValues r;
        r.f.script = [&](const Message& m) {
            FakeNode::Verdict v;
            if (m.cw == 0x99 && m.dl == 4) {
                if (refused)
                    v.instead = message(5, 0x0F, std::array<std::uint8_t, 6>{0, 0x33, 0x99, 0});  // and leaves MF pending
                else
                    v.answer = v.execute = false;
            }
            return v;
        };
        EXPECT_NE(r.b.write("MF3.AC", 1000).outcome, Outcome::done);
        EXPECT_EQ(r.f.mf, 3) << "the trap is set";
        r.f.script = nullptr;
        r.b.mark();
        EXPECT_EQ(r.b.write("DC", 77).outcome, Outcome::done);
        EXPECT_EQ(r.b.received(5).front(), "98 00");
        EXPECT_EQ(r.f.values[0x1AFF], le(77, 4));
        EXPECT_NE(r.f.group[0x031A], le(77, 4));
    }
}

TEST(Uim342Values, WritingMfItselfDoesNotMisleadWhatFollows) {
    ReadyForValues r;
    EXPECT_EQ(r.b.write("MF", 4).outcome, Outcome::done);
    EXPECT_EQ(r.b.write("AC", 123).outcome, Outcome::done);
    EXPECT_EQ(r.f.values[0x19FF], le(123, 4));
}

TEST(Uim342Values, FlashIsNotWrittenForNothing) {
    ReadyForValues r;
    const Result same = r.b.write("PP[8]", 10);
    EXPECT_EQ(same.outcome, Outcome::done);
    EXPECT_EQ(r.b.received(5), lines({"81 08"}));
    EXPECT_NE(same.text.find("not written"), std::string::npos) << same.text;
    r.b.mark();
    const Result other = r.b.write("PP[8]", 11);
    EXPECT_EQ(r.b.received(5), lines({"81 08", "81 08 0B"}));
    EXPECT_NE(other.text.find("restart"), std::string::npos) << other.text;
}

TEST(Uim342Values, IdsOfOneNetworkMustDiffer) {
    Bench b;
    b.add(5);
    b.add(6).values[0x0108] = le(20, 1);
    b.start();
    b.mark();
    EXPECT_EQ(b.write("PP[7]", 6).reason, Reason::out_of_range) << "d6's node ID";
    EXPECT_EQ(b.write("PP[7]", 20).reason, Reason::out_of_range) << "d6's group";
    EXPECT_EQ(b.write("PP[7]", 10).reason, Reason::out_of_range) << "its own group";
    EXPECT_EQ(b.write("PP[8]", 5).reason, Reason::out_of_range) << "its own node ID";
    EXPECT_EQ(b.write("PP[8]", 6).reason, Reason::out_of_range);
    EXPECT_TRUE(b.received(5).empty());
    EXPECT_EQ(b.write("PP[8]", 20).outcome, Outcome::done) << "a group may have several members";
}

TEST(Uim342Values, WhereAWriteIsKeptIsSaid) {
    ReadyForValues off;
    EXPECT_EQ(off.b.write("AC", 11).text, "");
    EXPECT_NE(off.b.write("MT[0]", 32).text.find("restart"), std::string::npos);
    ReadyForValues on(true);
    for (const char* id : {"AC", "DC", "SS", "SD", "BL", "QE[1]", "MT[1]", "TG[0]", "IL[3]", "IE[0]", "MF3.AC"}) {
        EXPECT_NE(on.b.write(id, id[0] == 'I' ? 1 : 15).text.find("RAM"), std::string::npos) << id;
    }
    EXPECT_EQ(on.b.write("IC[1]", 0).text, "") << "kept always";
    EXPECT_EQ(on.b.write("DI", 1).text, "");
}

TEST(Uim342Values, AlternateRangeOfRampsAsTimes) {
    ReadyForValues r;
    EXPECT_EQ(r.b.write("AC", 60001).outcome, Outcome::done) << "a rate";
    r.b.write("IC[4]", 1);
    r.b.mark();
    for (const char* id : {"AC", "DC", "MF2.DC"}) {
        const Result x = r.b.write(id, 60001);
        EXPECT_EQ(x.outcome, Outcome::refused) << id;
        EXPECT_EQ(x.reason, Reason::out_of_range);
        EXPECT_NE(x.text.find("1..60000 ms"), std::string::npos) << x.text;
    }
    EXPECT_TRUE(r.b.received(5).empty());
    EXPECT_EQ(r.b.write("AC", 60000).outcome, Outcome::done);
}

TEST(Uim342Values, MotorOnAsAParameterStopsFirst) {
    ReadyForValues r;
    EXPECT_EQ(r.b.write("MO", 1).outcome, Outcome::done);
    EXPECT_EQ(r.b.received(5), lines({"97", "95 01"}));
    EXPECT_EQ(r.b.feedback().power, AxisFeedback::Power::on);
    EXPECT_EQ(r.b.write("MO", 0).value, Value{std::int64_t{0}});
    EXPECT_EQ(r.b.feedback().power, AxisFeedback::Power::off);
}

TEST(Uim342Values, TheDrivesRefusalIsPassedOn) {
    ReadyForValues r;
    r.f.script = [](const Message& m) { return FakeNode::refuse_if(m.cw == 0x9C && m.dl == 4, 0x3C); };
    const Result x = r.b.write("SD", 5);
    EXPECT_EQ(x.outcome, Outcome::refused);
    EXPECT_EQ(x.reason, Reason::drive_refused);
    EXPECT_EQ(x.code, 0x3C);
    EXPECT_NE(x.text.find("raise SD"), std::string::npos) << x.text;
}

TEST(Uim342Values, WhatTheDriveTookIsTheValue) {
    ReadyForValues r;
    r.f.script = [](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x99 && m.dl == 4) v.instead = message(5, 0x19, std::array<std::uint8_t, 4>{0x10, 0x27});
        return v;
    };
    const Result x = r.b.write("AC", 99999);
    EXPECT_EQ(x.outcome, Outcome::done);
    EXPECT_EQ(x.value, Value{std::int64_t{10000}});
    EXPECT_NE(x.text.find("instead of 99999"), std::string::npos) << x.text;
}

TEST(Uim342Values, UnknownAndReadOnlyPoints) {
    ReadyForValues r;
    EXPECT_EQ(r.b.ask(ReadParameter{{9999, 0}}).reason, Reason::unknown_point);
    EXPECT_EQ(r.b.ask(WriteParameter{{9999, 0}, Value{std::int64_t{1}}}).reason, Reason::unknown_point);
    EXPECT_EQ(r.b.write("ML", 1).reason, Reason::not_writable);
    EXPECT_EQ(r.b.write("MS[0].STOP", 1).reason, Reason::not_writable);
    EXPECT_EQ(r.b.write("DV[2]", 1).reason, Reason::not_writable);
    EXPECT_EQ(r.b.ask(WriteParameter{Bench::point("AC"), Value{std::string("x")}}).reason, Reason::out_of_range);
    EXPECT_TRUE(r.b.received(5).empty());
}

// --- late answers ----------------------------------------------------------------------------------------------------------------

TEST(Uim342Late, AnAnswerOfAnEarlierWriteIsNotTakenForThatOfALaterOne) {
    // All three attempts of AC=1000 are answered very late: when AC=2000 waits for its own answer.
    ReadyForValues r;
    const Instant until = r.b.now + 165ms;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x99 && m.d[0] == 0xE8) v.latency = std::max<Duration>(until - r.b.now, 200us);
        return v;
    };
    const Result first = r.b.write("AC", 1000);
    EXPECT_EQ(first.outcome, Outcome::failed);
    EXPECT_EQ(first.reason, Reason::no_answer);
    EXPECT_NE(first.text.find("not known"), std::string::npos);
    const Result second = r.b.write("AC", 2000);
    EXPECT_EQ(second.outcome, Outcome::done) << second.text;
    EXPECT_EQ(second.value, Value{std::int64_t{2000}});
    EXPECT_EQ(second.text, "") << "and not \"the drive took 1000\"";
    EXPECT_EQ(r.f.values[0x19FF], le(2000, 4));
    EXPECT_TRUE(r.b.link()->online);
}

TEST(Uim342Late, AMissingBeginIsNotAnsweredByItsPredecessor) {
    ReadyForValues r(true);
    int begins = 0;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x96) {
            if (++begins == 1)
                v.latency = 70ms;  // comes when the first one has been given up
            else
                v.answer = v.execute = false;  // the second one is lost
        }
        return v;
    };
    Move m;
    m.target = 100;
    m.velocity = 10;
    EXPECT_EQ(r.b.ask(m).reason, Reason::no_answer);
    m.target = 200;
    const Result second = r.b.ask(m);
    EXPECT_EQ(second.outcome, Outcome::failed) << "its BG was not acknowledged, whatever came of the first one";
    EXPECT_EQ(second.reason, Reason::no_answer);
    EXPECT_EQ(begins, 2);
}

TEST(Uim342Late, ARepeatedRequestTakesEitherAnswerOnce) {
    ReadyForValues r;
    int n = 0;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x99 && n++ == 0) v.latency = 60ms;  // 10 ms after the repeat was sent
        return v;
    };
    const auto before = r.b.adapter.counters();
    const Result x = r.b.read("AC");
    EXPECT_EQ(x.value, Value{std::int64_t{10000}});
    // The second copy's answer is on its way: a write of the same instruction must not take it for its own.
    const Result w = r.b.write("AC", 7);
    EXPECT_EQ(w.value, Value{std::int64_t{7}}) << w.text;
    EXPECT_EQ(r.b.adapter.counters().retries, before.retries + 1);
    EXPECT_GE(r.b.adapter.counters().unexpected, before.unexpected + 1);
}

TEST(Uim342Late, ALateErrorSlotIsNoErrorReport) {
    ReadyForValues r;
    r.f.last_error = {0, 0x33, 0x81, 5, 0, 0};
    int n = 0;
    r.f.script = [&](const Message& m) { return m.cw == 0x8F && n++ == 0 ? FakeNode::late(60ms) : FakeNode::Verdict{}; };
    EXPECT_EQ(r.b.native("ER[0]").outcome, Outcome::done) << "answered after its repeat was sent: a second answer follows";
    r.b.run(300ms);
    EXPECT_EQ(r.b.notices_of("error_report"), 0u);
    EXPECT_FALSE(r.b.feedback().fault);
}

TEST(Uim342Late, ALateRefusalIsNotThatOfTheNextInstruction) {
    ReadyForValues r;
    int n = 0;
    const Instant until = r.b.now + 165ms;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x99 && m.dl == 4 && n++ < 3) {
            v.error = 0x33;
            v.latency = std::max<Duration>(until - r.b.now, 200us);
        }
        return v;
    };
    EXPECT_EQ(r.b.write("AC", 1).reason, Reason::no_answer);
    EXPECT_EQ(r.b.write("AC", 2).outcome, Outcome::done);
    r.b.run(300ms);
    EXPECT_FALSE(r.b.feedback().fault) << "the late report was about ours";
}

TEST(Uim342Late, AnswersOfBeforeTheSilenceDoNotCountAfterIt) {
    // A gateway that was stuck for seconds delivers everything at once.
    ReadyForValues r;
    r.f.position = 111;
    r.b.run(200ms);
    bool stuck = true;
    const Instant release = r.b.now + 3s;
    r.f.script = [&](const Message&) { return FakeNode::late(stuck ? std::max<Duration>(release - r.b.now, 0ns) : Duration(200us)); };
    ASSERT_TRUE(r.b.run_until([&] { return !r.b.link()->online; }, 2s));
    r.f.position = 222;  // moved by hand meanwhile
    stuck = true;
    ASSERT_TRUE(r.b.run_until([&] { return r.b.link()->online; }, 5s));
    stuck = false;
    r.b.run(1s);
    EXPECT_EQ(r.b.feedback().position, 222);
}

// --- native ----------------------------------------------------------------------------------------------------------------------

TEST(Uim342Native, TextAndBytes) {
    ReadyForValues r;
    Result x = r.b.native("MO=1");
    EXPECT_EQ(x.outcome, Outcome::done);
    EXPECT_EQ(x.text, "MO = 1 (driver on)");
    EXPECT_EQ(x.bytes, (std::vector<std::uint8_t>{0x15, 0x01, 0x01}));
    EXPECT_EQ(r.b.native("jv = -1000").text, "DV[2] = -1000 (desired speed)");
    EXPECT_EQ(r.b.native("MT[0]").text, "MT[0] = 16");
    EXPECT_EQ(r.b.native("IL[0]=0x8086").text, "IL[0] = 0x8086 (falling: origin, then stop; rising: none)");
    EXPECT_EQ(r.b.native("PR;PA").text, "PR = 0; PA = 0");
    EXPECT_EQ(r.b.native("SN").text, "SN = 67305985, manufacturer 1541, vendor 2055");
    EXPECT_EQ(r.b.native("ST").text, "ST done");
    x = r.b.native_hex({0x95, 0x00});
    EXPECT_EQ(x.bytes, (std::vector<std::uint8_t>{0x15, 0x01, 0x01}));
    x = r.b.native_hex({0x98, 1, 3, 0x99, 0});
    EXPECT_EQ(x.bytes, (std::vector<std::uint8_t>{0x18, 1, 3, 0x19, 4, 0xF7, 1, 0, 0}));
}

TEST(Uim342Native, RefusalsAndWrongText) {
    ReadyForValues r;
    Result x = r.b.native("MT[9]");
    EXPECT_EQ(x.outcome, Outcome::refused);
    EXPECT_EQ(x.code, 0x34);
    EXPECT_EQ(x.bytes, (std::vector<std::uint8_t>{0x0F, 6, 0, 0x34, 0x90, 9, 0, 0}));
    r.b.mark();
    for (const char* bad : {"",     ";",    "XX", "MO=2x",         "MO=", "MT",   "MT[",     "MT[x]", "MT[300]",  "AC[1]",
                            "BG=1", "ML=1", "RT", "JV=3000000000", "MF",  "MF=3", "MF=3;BG", "DI=2",  "SY[2];MO", "PR;PR;PR;PR;PR",
                            "AC=-1"}) {
        const Result y = r.b.native(bad);
        EXPECT_EQ(y.outcome, Outcome::refused) << bad;
        EXPECT_FALSE(y.text.empty()) << bad;
    }
    for (const auto& bytes : {std::vector<std::uint8_t>{}, {0x95}, {0x95, 2, 1}, {0x95, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9}}) {
        EXPECT_EQ(r.b.native_hex(bytes).outcome, Outcome::refused);
    }
    EXPECT_TRUE(r.b.received(5).empty());
}

TEST(Uim342Native, GroupPairInOneLine) {
    ReadyForValues r;
    EXPECT_EQ(r.b.native("MF=3;AC=1000").text, "MF = 3; AC = 1000");
    EXPECT_EQ(r.f.group[0x0319], le(1000, 4));
    EXPECT_EQ(r.b.read("AC").value, Value{std::int64_t{10000}}) << "the cache of group 0 was not touched either";
}

TEST(Uim342Native, WithoutAcknowledgement) {
    ReadyForValues r;
    Result x = r.b.native_hex({0x15, 1, 1});
    EXPECT_EQ(x.outcome, Outcome::done);
    EXPECT_TRUE(x.bytes.empty());
    EXPECT_TRUE(r.f.on);
    EXPECT_EQ(r.b.received(5), lines({"15 01"})) << "and a read behind it shows that no refusal came";
    x = r.b.native_hex({0x15, 1, 7});
    EXPECT_EQ(x.outcome, Outcome::done) << "this fake takes it";
    r.f.script = [](const Message& m) { return FakeNode::refuse_if(m.cw == 0x15, 0x33); };
    x = r.b.native_hex({0x15, 1, 7});
    EXPECT_EQ(x.outcome, Outcome::refused);
    EXPECT_EQ(x.code, 0x33);
    r.b.run(200ms);
    EXPECT_FALSE(r.b.feedback().fault);
}

TEST(Uim342Native, UnknownControlWordsGoThrough) {
    ReadyForValues r;
    const Result x = r.b.native_hex({0x82, 0});
    EXPECT_EQ(x.outcome, Outcome::refused);
    EXPECT_EQ(x.code, 0x32);
}

TEST(Uim342Native, ABeginByHandIsAMotion) {
    ReadyForValues r(true);
    r.f.paif = true;
    r.b.run(200ms);
    r.b.native("PA=100;SP=10;BG");
    EXPECT_FALSE(r.b.feedback().target_reached);
    EXPECT_TRUE(r.b.feedback().moving);
}

TEST(Uim342Native, RebootIsSilentAndBeginsAnew) {
    ReadyForValues r;
    r.b.ask(Home{35});
    r.f.position = 5;
    r.b.run(100ms);
    ASSERT_TRUE(r.b.feedback().referenced);
    r.b.mark();
    const Result x = r.b.native("SY[1]");
    EXPECT_EQ(x.outcome, Outcome::done);
    EXPECT_NE(x.text.find("does not acknowledge"), std::string::npos) << x.text;
    const Ticket waits = r.b.command(ReadParameter{Bench::point("AC")});
    r.f.values[0x19FF] = le(3, 4);
    r.b.run(290ms);
    EXPECT_EQ(r.b.received(5), lines({"7E 01"})) << "left alone while it starts";
    r.b.run(1s);
    EXPECT_EQ(r.b.results[waits].value, Value{std::int64_t{3}});
    EXPECT_FALSE(r.b.feedback().referenced);
    EXPECT_TRUE(r.b.link()->online);
}

TEST(Uim342Action, RebootUntilItIsBack) {
    ReadyForValues r;
    const Ticket t = r.b.command(Action{"reboot", ""}, true);
    r.b.run(200ms);
    EXPECT_FALSE(r.b.results.contains(t));
    r.b.run(500ms);
    ASSERT_TRUE(r.b.results.contains(t));
    EXPECT_EQ(r.b.results[t].outcome, Outcome::done);
    EXPECT_EQ(r.b.ask(Action{"reboot", ""}).outcome, Outcome::accepted);
    r.b.run(500ms);
    r.f.script = [&](const Message& m) {
        if (m.function() == 0x7E) r.f.silent = true;
        return FakeNode::Verdict{};
    };
    const Result never = r.b.ask(Action{"reboot", ""}, true);
    EXPECT_EQ(never.outcome, Outcome::failed) << "it did not come back";
    EXPECT_EQ(never.reason, Reason::no_answer);
}

TEST(Uim342Action, FactoryDefaultsAreReadAgain) {
    ReadyForValues r;
    r.b.write("AC", 5);
    r.f.script = [&](const Message& m) {
        if (m.function() == 0x7E) r.f.values[0x19FF] = le(10000, 4);
        return FakeNode::Verdict{};
    };
    EXPECT_EQ(r.b.ask(Action{"factory_defaults", ""}).outcome, Outcome::accepted);
    r.b.run(300ms);
    EXPECT_EQ(r.b.sample("AC"), Value{std::int64_t{10000}});
    r.f.script = [](const Message& m) { return FakeNode::refuse_if(m.function() == 0x7E, 0x3D); };
    const Result x = r.b.ask(Action{"factory_defaults", ""});
    EXPECT_EQ(x.outcome, Outcome::refused) << "silent when it works, but a refusal is reported";
    EXPECT_EQ(x.code, 0x3D);
}

TEST(Uim342Action, InstructionsByName) {
    ReadyForValues r(true);
    EXPECT_EQ(r.b.ask(Action{"set_origin", ""}).outcome, Outcome::accepted);
    EXPECT_TRUE(r.b.feedback().referenced);
    EXPECT_EQ(r.b.ask(Action{"motor_driver", "[1]=30"}).outcome, Outcome::accepted);
    EXPECT_EQ(r.f.values[0x1001], le(30, 2));
    EXPECT_EQ(r.b.ask(Action{"AC", "77"}).outcome, Outcome::accepted);
    EXPECT_EQ(r.f.values[0x19FF], le(77, 4));
    EXPECT_EQ(r.b.ask(Action{"MS", "0"}).outcome, Outcome::accepted);
    EXPECT_EQ(r.b.ask(Action{"clear_status", ""}).outcome, Outcome::accepted);
    EXPECT_EQ(r.b.ask(Action{"clear_error", ""}).outcome, Outcome::accepted);
    EXPECT_EQ(r.b.ask(Action{"fly", ""}).reason, Reason::unknown_point);
    EXPECT_EQ(r.b.ask(Action{"stop_motion", ""}, true).outcome, Outcome::done);
}

TEST(Uim342Native, DescribesWhatItDoesNotKnow) {
    EXPECT_EQ(describe_answer(message(5, 0x44, std::array<std::uint8_t, 2>{1, 2})), "unknown control word: 44 02 01 02");
    EXPECT_EQ(describe_answer(message(5, 0x95, std::array<std::uint8_t, 1>{1})),
              "not an answer, bit 7 of the control word is set: 95 01 01");
    EXPECT_EQ(describe_answer(message(5, 0x19, std::array<std::uint8_t, 2>{1, 2})),
              "AC of a length that the manual does not have: 19 02 01 02");
    EXPECT_EQ(describe_answer(message(5, 0x11, std::array<std::uint8_t, 8>{0, 0x3D, 0x03, 0, 0x18, 0xFC, 0xFF, 0xFF})),
              "MS[0] = PTP, driver on, stationary, in position, IN1..3 111, OP1 0, relative position -1000");
    EXPECT_EQ(describe_request(message(5, 0x9D, std::array<std::uint8_t, 2>{0xF0, 0xD8})), "JV=55536 (2 data bytes, zero-extended)");
    EXPECT_EQ(describe_request(message(5, 0x90, std::array<std::uint8_t, 2>{0, 1})),
              "MT with a data length that the manual does not have: 90 02 00 01");
    EXPECT_EQ(describe_request(message(5, 0x7E, std::array<std::uint8_t, 1>{1})), "SY[1] (reboot)");
    EXPECT_EQ(describe_request(message(5, 0x16)), "BG (no acknowledgement)");
}

// --- under any weather -----------------------------------------------------------------------------------------------------------

/// Any command, with values by `roll`, which gives numbers below its argument.
CommandBody any_command(const std::function<unsigned(unsigned)>& roll) {
    const auto all_points = static_cast<std::uint16_t>(catalogue().parameters().size());
    Move m;
    m.kind = static_cast<Move::Kind>(roll(3));
    m.target = static_cast<std::int64_t>(roll(20000)) - 10000;
    m.velocity = 100 + roll(1000);
    if (roll(3) == 0) m.acceleration = 1 + roll(1000);
    m.prepare_only = roll(6) == 0;
    Native n;
    const std::string text = std::array{"MO", "MF=3;AC=5", "SY[1]", "ER[0]", "BG", "XX"}[roll(6)];
    n.send.assign(text.begin(), text.end());
    switch (roll(16)) {
        case 0:
            return Disable{};
        case 1:
            return QuickStop{};
        case 2:
            return Halt{};
        case 3:
            return ResetFault{};
        case 4:
            return Home{static_cast<std::int16_t>(std::array{0, 20, 19, 3}[roll(4)])};
        case 5:
        case 6:
        case 7:
            return m;
        case 8:
            return StartTogether{{AxisId{0}, AxisId{static_cast<std::uint16_t>(roll(3))}, AxisId{2}}};
        case 9:
            return ReadParameter{{static_cast<std::uint16_t>(roll(all_points + 1u)), 0}};
        case 10:
            return WriteParameter{{static_cast<std::uint16_t>(roll(all_points)), 0}, Value{std::int64_t{roll(50)}}};
        case 11:
            return n;
        case 12:
            return Action{std::array{"global_stop", "start_group", "reboot", "clear_status"}[roll(4)], "10"};
        case 13:
            return SetPosition{0};
        default:
            return Enable{};
    }
}

/// Now and then a node falls silent or reports something, the line breaks, a drive is taken away.
void disturb(Bench& b, const std::function<unsigned(unsigned)>& roll) {
    if (roll(60) == 0) {
        FakeNode& f = b.fake(std::array<std::uint8_t, 3>{5, 6, 37}[roll(3)]);
        f.silent = !f.silent;
    }
    if (roll(20) == 0) {
        FakeNode& f = b.fake(std::array<std::uint8_t, 3>{5, 6, 37}[roll(3)]);
        roll(2) ? f.finish() : static_cast<void>(f.stop = true);
        b.say(
            message(f.id, cw::RT, std::array<std::uint8_t, 5>{static_cast<std::uint8_t>(roll(8)), static_cast<std::uint8_t>(roll(0x20))}));
    }
    if (roll(150) == 0) {
        b.line(false);
        b.run(10ms);
        b.line(true);
    }
    if (roll(200) == 0) {
        auto keep = b.setup.drives;
        b.setup.drives.erase(b.setup.drives.begin() + roll(3));
        b.configure();
        b.run(20ms);
        b.setup.drives = keep;
        b.configure();
    }
}

/// Whatever is lost, late, refused, removed: every ticket has exactly one result, one instruction at a time per node, and the
/// adapter comes to rest.
TEST(Uim342Weather, EveryTicketHasExactlyOneResult) {
    for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const auto roll = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
        Bench b(seed % 2 ? LineKind::can : LineKind::bytes);
        for (const std::uint8_t id : Bytes{5, 6, 37}) {
            FakeNode& f = b.add(id, {{"home_input", "1"}, {"home_velocity", "100"}, {"home_timeout_s", "1"}});
            f.script = [&](const Message&) {
                FakeNode::Verdict v;
                if (roll(100) < 6) v.answer = false;
                if (roll(100) < 3) v.error = 0x33;
                if (roll(100) < 3) v.execute = v.answer = false;
                if (roll(100) < 6) v.latency = Duration(1ms) * roll(120);
                return v;
            };
        }
        b.lose = [&](const Frame&, bool) { return roll(1000) < 8; };
        b.configure();
        b.line(true);
        std::vector<Ticket> tickets;
        for (int i = 0; i < 1500; ++i) {
            b.run(Duration(100us) * roll(200));
            const auto axis = static_cast<std::uint16_t>(roll(4));  // 3 is nobody
            const CommandBody body = any_command(roll);
            tickets.push_back(b.command(body, roll(3) == 0, axis));
            disturb(b, roll);
        }
        // Fair weather, and everything stops.
        b.lose = nullptr;
        for (auto& [id, f] : b.fakes) {
            f->script = nullptr;
            f->silent = false;
        }
        b.run(8s);
        for (std::uint16_t a = 0; a < 3; ++a)
            b.ask(QuickStop{}, true, a);
        b.run(2s);
        for (const Ticket t : tickets)
            EXPECT_EQ(b.result_count[t], 1) << "ticket " << t - tickets.front();
        for (auto& [id, f] : b.fakes)
            EXPECT_TRUE(f->stop);
        for (std::uint16_t d = 0; d < 3; ++d)
            EXPECT_TRUE(b.link(d) && b.link(d)->online);
        EXPECT_EQ(b.read("AC", 2).outcome, Outcome::done);
    }
}

TEST(Uim342Weather, TheSameCallsGiveTheSameFrames) {
    std::vector<std::string> runs[2];
    for (auto& list : runs) {
        Bench b;
        for (const std::uint8_t id : Bytes{5, 6, 7})
            b.add(id);
        b.start(300ms);
        b.ask(Enable{});
        b.write("AC", 1);
        b.run(100ms);
        for (const auto& s : b.sent)
            list.push_back(fmt::format("{} {} {}", ns_of(s.at), s.message.id, hex(s.message)));
    }
    EXPECT_EQ(runs[0], runs[1]);
}

}  // namespace
}  // namespace axisgate::uim342::test
