// Order, pipelining and bounds of one client, without a socket.
#include <gtest/gtest.h>

#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/session.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using test::adu;
using test::bytes;
using test::hex;
using Work = Session::Work;

struct Client : SessionWaker {
    explicit Client(Responder& responder, DoorPort& port)
        : port_(port), session(std::make_unique<Session>(responder, *this, std::make_shared<const std::string>("client"))) {}
    /// Sends bytes and processes them. Returns the immediate answers.
    std::string send(std::string_view data) {
        const auto b = bytes(data);
        EXPECT_EQ(session->input().feed(b), b.size());
        return work();
    }
    std::string work() {
        out->size = 0;
        last = session->work(port_.now(), *out);
        return hex(std::span(out->bytes).first(out->size));
    }
    void wake(Session&) override { ++wakes; }

    DoorPort& port_;
    std::unique_ptr<Session> session;
    std::unique_ptr<AnswerBuffer> out = std::make_unique<AnswerBuffer>();
    Work last = Work::need_bytes;
    int wakes = 0;
};

struct SessionTest : testing::Test {
    SessionTest() {
        for (std::uint16_t n = 1; n <= 3; ++n)
            axes[n] = port.add_axis(n, &test::catalogue());
        port.edit(axes[1], [](AxisPicture& p) { p.statusword = 0x0250; });
    }
    test::FakePort port;
    test::ResponderDoor door{port};
    Responder& responder = door.responder;
    Client client{responder, port};
    AxisId axes[4] = {};
};

const std::string reading = "03 00 00 00 01", reading_answer = "03 02 02 50", switching_on = "06 00 20 00 0F";
std::string join(std::initializer_list<std::string> parts) {
    std::string out;
    for (const auto& p : parts)
        out += (out.empty() ? "" : " ") + p;
    return out;
}

TEST_F(SessionTest, AnswersWithTheSameTransactionAndUnit) {
    EXPECT_EQ(client.send(adu(0x1234, reading, 255)), adu(0x1234, reading_answer, 255));
    EXPECT_EQ(client.send(adu(0xFFFF, "64", 0)), adu(0xFFFF, "E4 01", 0));
    EXPECT_EQ(client.send(adu(1, reading, 7)), adu(1, "83 0A", 7));
    EXPECT_EQ(client.last, Work::need_bytes);
}

TEST_F(SessionTest, AllRequestsOfOneArrivalAreAnsweredTogether) {
    EXPECT_EQ(client.send(join({adu(1, reading), adu(2, "11"), adu(3, reading, 0)})),
              join({adu(1, reading_answer), adu(2, "11 0C 01 FF 61 78 69 73 67 61 74 65 20 30"), adu(3, reading_answer, 0)}));
}

TEST_F(SessionTest, ByteByByteGivesTheSameAnswers) {
    const auto stream =
        bytes(join({adu(1, reading), adu(2, "17 00 00 00 01 00 20 00 01 02 00 0F"), adu(3, "2B 0E 01 02"), adu(4, "08 00 00 AA BB")}));
    std::string got;
    for (const auto b : stream) {
        const std::string now = client.send(hex(std::span(&b, 1)));
        if (!now.empty()) got += (got.empty() ? "" : " ") + now;
        while (port.answer())
            got += " " + client.work();
    }
    EXPECT_EQ(got,
              join({adu(1, reading_answer), adu(2, "17 02 02 50"), adu(3, "2B 0E 01 83 00 00 01 02 01 30"), adu(4, "08 00 00 AA BB")}));
}

TEST_F(SessionTest, AWriteIsAnsweredWhenTheDriveHas) {
    EXPECT_EQ(client.send(adu(5, switching_on)), "");
    EXPECT_EQ(client.last, Work::need_bytes);
    EXPECT_EQ(client.session->in_flight(), 1u);
    port.answer();
    EXPECT_EQ(client.wakes, 1);
    EXPECT_EQ(client.work(), adu(5, switching_on));
    EXPECT_EQ(client.session->in_flight(), 0u);
}

TEST_F(SessionTest, AReadBehindAWriteWaitsAndSeesIt) {
    EXPECT_EQ(client.send(join({adu(5, switching_on), adu(6, "03 00 20 00 01"), adu(7, reading)})), "");
    EXPECT_EQ(client.last, Work::waits_for_results);
    EXPECT_EQ(client.session->requests(), 1u);
    port.answer();
    EXPECT_EQ(client.work(), join({adu(5, switching_on), adu(6, "03 02 00 0F"), adu(7, reading_answer)}));
}

TEST_F(SessionTest, AStopIsNotHeldUpByASlowWrite) {
    // Target on axis 1, then halt on axis 2: the second command is sent before the first has its result.
    EXPECT_EQ(client.send(join({adu(1, "10 00 22 00 02 04 00 00 00 64"), adu(2, "06 00 60 01 0F")})), "");
    ASSERT_EQ(port.commands.size(), 2u);
    EXPECT_EQ(port.commands[1].axis, axes[2]);
    EXPECT_EQ(std::get<ProcessData>(port.commands[1].body).controlword, 0x010F);
}

TEST_F(SessionTest, AnswersStayInOrderWhenResultsDoNot) {
    EXPECT_EQ(client.send(join({adu(1, switching_on), adu(2, "06 00 60 00 0F"), adu(3, "06 00 00 00 01"), adu(4, "06 00 A0 00 0F")})), "");
    ASSERT_EQ(port.commands.size(), 3u) << "the third is refused without a command";
    std::rotate(port.commands.begin(), port.commands.begin() + 1, port.commands.end());  // axes 2, 3, 1
    port.refuse(Reason::no_answer);
    EXPECT_EQ(client.work(), "");
    port.answer();
    EXPECT_EQ(client.work(), "");
    EXPECT_EQ(client.wakes, 0) << "nothing can be sent before the first answer";
    port.refuse(Reason::wrong_state);
    EXPECT_EQ(client.wakes, 1);
    EXPECT_EQ(client.work(), join({adu(1, "86 04"), adu(2, "86 0B"), adu(3, "86 02"), adu(4, "06 00 A0 00 0F")}));
}

TEST_F(SessionTest, WhatReadsWaitsForWritesAndHoldsUpWhatFollows) {
    for (const std::string waits :
         {"16 00 20 FF FF 00 00", "17 00 00 00 01 00 20 00 01 02 00 0F", "01 00 00 00 01", "11", "2B 0E 01 00", "64"}) {
        Client c(responder, port);
        EXPECT_EQ(c.send(join({adu(1, switching_on), adu(2, waits), adu(3, switching_on)})), "");
        EXPECT_EQ(c.last, Work::waits_for_results) << waits;
        EXPECT_EQ(port.commands.size(), 1u) << waits;
        while (port.answer())
            c.work();
        EXPECT_EQ(c.session->in_flight(), 0u);
        EXPECT_EQ(c.session->requests(), 3u);
    }
}

TEST_F(SessionTest, NothingIsBegunBehindAReadWrite) {
    EXPECT_EQ(client.send(join({adu(1, "17 00 20 00 01 00 20 00 01 02 00 0F"), adu(2, "06 00 20 00 1F")})), "");
    EXPECT_EQ(port.commands.size(), 1u);
    port.answer();
    EXPECT_EQ(client.work(), adu(1, "17 02 00 0F")) << "its read does not see the later write";
    port.answer();
    EXPECT_EQ(client.work(), adu(2, "06 00 20 00 1F"));
}

TEST_F(SessionTest, AtMost32WritesAreOnTheirWay) {
    std::string stream;
    for (std::uint16_t i = 0; i < 40; ++i)
        stream += adu(i, switching_on) + " ";
    EXPECT_EQ(client.send(stream), "");
    EXPECT_EQ(client.last, Work::waits_for_results);
    EXPECT_EQ(port.commands.size(), Session::max_in_flight);
    std::string got;
    for (int i = 0; i < 40; ++i) {
        EXPECT_TRUE(port.answer());
        const auto now = client.work();
        EXPECT_EQ(now, adu(static_cast<std::uint16_t>(i), switching_on));
        EXPECT_LE(port.commands.size(), Session::max_in_flight);
    }
    EXPECT_EQ(client.wakes, 40);
}

TEST_F(SessionTest, ParameterChannelWritesKeepTheirPlaceInTheOrder) {
    EXPECT_EQ(client.send(join({adu(1, switching_on), adu(2, "10 00 30 00 03 06 00 00 00 00 00 01"), adu(3, "06 00 32 00 01")})), "");
    ASSERT_EQ(port.commands.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<ReadParameter>(port.commands[1].body)) << "the exchange has begun";
    port.answer();
    EXPECT_EQ(client.work(), join({adu(1, switching_on), adu(2, "10 00 30 00 03"), adu(3, "86 06")}));
}

TEST_F(SessionTest, GarbageEndsItAfterWhatCameBefore) {
    EXPECT_EQ(client.send(join({adu(1, reading), "DE AD BE EF 00 00"})), adu(1, reading_answer));
    EXPECT_EQ(client.last, Work::not_modbus);
    Client other(responder, port);
    EXPECT_EQ(other.send(join({adu(1, switching_on), "00 00 00 00 00 01 01"})), "");
    EXPECT_EQ(other.last, Work::waits_for_results) << "the write is still answered";
    port.answer();
    EXPECT_EQ(other.work(), adu(1, switching_on));
    EXPECT_EQ(other.last, Work::not_modbus);
}

TEST_F(SessionTest, TellsHalfRequestsFromWholeOnes) {
    client.send("00 01 00 00 00 06 01 03");
    EXPECT_TRUE(client.session->holds_partial());
    client.send("00 00 00 01");
    EXPECT_FALSE(client.session->holds_partial());
    client.send(join({adu(1, switching_on), adu(2, reading), "00"}));
    EXPECT_FALSE(client.session->holds_partial()) << "not yet known: it waits for the write";
    port.answer();
    client.work();
    EXPECT_TRUE(client.session->holds_partial());
}

TEST_F(SessionTest, AFullOutputIsToldAndNothingIsLost) {
    // 12 requested bytes give 259 bytes of answer: the input holds more than one output.
    std::size_t answered = 0;
    std::string stream;
    for (std::uint16_t i = 0; i < 680; ++i)
        stream += adu(i, "03 00 00 00 7D") + " ";
    const auto all = bytes(stream);
    ASSERT_EQ(client.session->input().feed(all), all.size());
    int rounds = 0;
    std::uint16_t expected = 0;
    do {
        client.out->size = 0;
        client.last = client.session->work(port.now(), *client.out);
        for (std::size_t at = 0; at < client.out->size; at += 259)
            EXPECT_EQ(get16(client.out->bytes.data() + at), expected++);
        answered += client.out->size;
        ++rounds;
    } while (client.last == Work::output_full);
    EXPECT_EQ(answered, 680u * 259);
    EXPECT_EQ(rounds, 3);
}

TEST_F(SessionTest, AClientThatHasGoneIsNotTold) {
    client.send(adu(1, switching_on));
    client.session.reset();
    EXPECT_TRUE(port.answer());
    EXPECT_EQ(responder.writer().counters().results_unclaimed.value(), 1u);
    EXPECT_EQ(responder.writer().waiting(), 0u);
}

TEST_F(SessionTest, OneClientsWritesDoNotHoldUpAnother) {
    Client other(responder, port);
    client.send(join({adu(1, switching_on), adu(2, reading)}));
    EXPECT_EQ(other.send(adu(9, reading)), adu(9, reading_answer));
    other.send(adu(10, "06 00 60 00 06"));
    port.commands.pop_front();  // the first client's drive never answers
    port.answer();
    EXPECT_EQ(other.work(), adu(10, "06 00 60 00 06"));
    EXPECT_EQ(client.work(), "");
}

TEST_F(SessionTest, CommandsNow) {
    const auto moving = [&](AxisId id, bool on, Door authority = modbus::clients) {
        port.edit(id, [&](AxisPicture& p) {
            p.flags = on ? flag_moving : 0;
            p.authority = authority;
        });
    };
    moving(axes[1], true);
    EXPECT_FALSE(client.session->commands_now(port.image())) << "it commanded nothing";
    client.send(adu(1, switching_on));
    moving(axes[1], false);
    EXPECT_TRUE(client.session->commands_now(port.image())) << "a write is on its way";
    port.answer();
    client.work();
    EXPECT_FALSE(client.session->commands_now(port.image())) << "the axis stands still";
    moving(axes[1], true);
    EXPECT_TRUE(client.session->commands_now(port.image()));
    moving(axes[1], true, http::clients);
    EXPECT_FALSE(client.session->commands_now(port.image())) << "somebody else moves it";
    moving(axes[2], true);
    EXPECT_FALSE(client.session->commands_now(port.image())) << "another axis";
    client.send(adu(2, "06 00 60 00 0F"));
    port.refuse(Reason::authority);
    client.work();
    EXPECT_FALSE(client.session->commands_now(port.image())) << "a refused write commands nothing";
    port.remove_axis(1);
    EXPECT_FALSE(client.session->commands_now(port.image()));
}

}  // namespace
}  // namespace axisgate::modbus
