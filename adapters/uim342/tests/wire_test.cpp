// Wire tests of the UIM342: every golden message of vectors.txt through packing, unpacking and framing, and the traps of the identifier.
#include "adapters/uim342/wire.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include "adapters/uim342/wire_instructions.hpp"
#include "adapters/uim342/wire_uimessage.hpp"

namespace axisgate::uim342 {
namespace {

std::vector<std::uint8_t> bytes_of(std::istringstream& in, std::vector<bool>* free = nullptr) {
    std::vector<std::uint8_t> v;
    std::string word;
    while (in >> word && word[0] != '#' && word != "=") {
        if (word == "xx") {
            v.push_back(0);
            if (free) free->push_back(true);
            continue;
        }
        unsigned n = 0;
        const auto [p, ec] = std::from_chars(word.data(), word.data() + word.size(), n, 16);
        if (ec != std::errc{} || p != word.data() + word.size() || n > 0xFF) break;
        v.push_back(static_cast<std::uint8_t>(n));
        if (free) free->push_back(false);
    }
    return v;
}

Message message_of(const std::vector<std::uint8_t>& b) {
    EXPECT_GE(b.size(), 3u);
    EXPECT_EQ(b.size(), 3u + b[2]);
    return message(b[0], b[1], std::span(b).subspan(3));
}

void check_can(std::istringstream& in, const Message& current, bool to_drive, bool has_free) {
    std::string id;
    in >> id;
    const auto want = static_cast<std::uint32_t>(std::stoul(id, nullptr, 16));
    const auto data = bytes_of(in);
    const Frame f = to_drive ? to_can(current) : Frame::can_extended(can_id(current.id, host_id, current.cw), current.data());
    EXPECT_EQ(f.id, want);
    EXPECT_EQ(f.size, data.size());
    if (!has_free) {
        EXPECT_TRUE(std::ranges::equal(f.data(), data));
    }
    const auto back = from_can(Frame::can_extended(want, data));
    ASSERT_TRUE(back);
    EXPECT_EQ(to_drive ? back->consumer : back->producer, current.id);
    EXPECT_EQ(to_drive ? back->producer : back->consumer, host_id);
    EXPECT_EQ(back->message.cw, current.cw);
    EXPECT_EQ(back->message.dl, current.dl);
}

void check_table(std::istringstream& in) {
    const auto b = bytes_of(in);
    ASSERT_EQ(b.size(), 17u);
    // Entry i of the table named "low" is the high half of the CRC of one byte, started at 0 (it feeds crcH).
    for (std::size_t k = 0; k < 16; ++k) {
        unsigned c = (b[0] + k) & 0xFF;
        for (int bit = 0; bit < 8; ++bit)
            c = c & 1u ? c >> 1 ^ 0xA001u : c >> 1;
        EXPECT_EQ(c >> 8, b[k + 1]) << "entry " << b[0] + k;
    }
}

void check_stream(std::istringstream& in) {
    const auto b = bytes_of(in);
    UiFramer framer;
    int good = 0, junk = 0;
    framer.push(
        b, [&](const UiCheck&, const UiBytes&) { ++good; }, [&](std::uint8_t) { ++junk; });
    EXPECT_GT(good, 0);
    EXPECT_EQ(static_cast<std::size_t>(good) * uimessage_size + static_cast<std::size_t>(junk) + framer.pending().size(), b.size());
}

TEST(Uim342Vectors, EveryMessageInEveryForm) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/adapters/uim342/vectors.txt");
    ASSERT_TRUE(file) << "adapters/uim342/vectors.txt is missing";
    std::string line, name;
    Message current;
    bool to_drive = true, has_free = false;
    int cases = 0, messages = 0, cans = 0, uims = 0, crcs = 0, rows = 0, streams = 0;
    const auto check_uim = [&](std::istringstream& in, CrcMode mode) {
        const auto b = bytes_of(in);
        ASSERT_EQ(b.size(), uimessage_size);
        UiBytes raw{};
        std::copy(b.begin(), b.end(), raw.begin());
        EXPECT_EQ(to_uimessage(current, mode), raw);
        const UiCheck c = check_uimessage(raw, mode);
        EXPECT_TRUE(c.good);
        EXPECT_EQ(c.proved, mode);
        EXPECT_EQ(c.message, current);
        ++uims;
    };
    while (std::getline(file, line)) {
        std::istringstream in(line);
        std::string word;
        if (!(in >> word) || word[0] == '#') continue;
        SCOPED_TRACE(name + ": " + line);
        if (word == "case") {
            in >> name;
            ++cases;
        } else if (word == ">" || word == "<" || word == "<~") {
            if (line.find("none") != std::string::npos) continue;
            std::vector<bool> free;
            const auto b = bytes_of(in, &free);
            current = message_of(b);
            to_drive = word == ">";
            has_free = word == "<~";
            ++messages;
            if (to_drive) {
                // What a host may write is an instruction that the table knows, except where the case is about a wrong one.
                if (form_of(current) == Form::unknown) {
                    EXPECT_TRUE(name.find("error") != std::string::npos || name.find("printed") != std::string::npos) << name;
                }
            } else {
                EXPECT_EQ(current.cw & ack_bit, 0);
                EXPECT_NE(instruction(current.cw), nullptr);
            }
        } else if (word == "can>" || word == "can<") {
            check_can(in, current, word == "can>", has_free);
            ++cans;
        } else if (word == "uim>" || word == "uim<") {
            check_uim(in, CrcMode::twelve);
        } else if (word == "uim13>" || word == "uim13<") {
            check_uim(in, CrcMode::thirteen);
        } else if (word == "plain>" || word == "plain<") {
            check_uim(in, CrcMode::none);
        } else if (word == "crc") {
            const auto b = bytes_of(in);
            std::string value;
            in >> value;
            EXPECT_EQ(crc16(b), std::stoul(value, nullptr, 16)) << value;
            ++crcs;
        } else if (word == "crclow") {
            check_table(in);
            ++rows;
        } else if (word == "stream>") {
            check_stream(in);
            ++streams;
        } else {
            EXPECT_TRUE(word == "wire" || word == "node" || word == "state" || word == "hand" || word == "wait" || word == "note") << word;
        }
    }
    // The file has not been emptied.
    EXPECT_GE(cases, 80);
    EXPECT_GE(messages, 200);
    EXPECT_GE(cans, 200);
    EXPECT_GE(uims, 80);
    EXPECT_GE(crcs, 5);
    EXPECT_EQ(rows, 16);
    EXPECT_GE(streams, 1);
}

/// The answer that stands behind a request in the vectors is its answer, or its refusal; and no other request's.
TEST(Uim342Vectors, AnswersMatchTheirRequests) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/adapters/uim342/vectors.txt");
    std::string line, name;
    std::optional<Message> request;
    int pairs = 0, refusals = 0;
    while (std::getline(file, line)) {
        std::istringstream in(line);
        std::string word;
        if (!(in >> word)) continue;
        SCOPED_TRACE(name + ": " + line);
        if (word == "case") {
            in >> name;
            request.reset();
        } else if (word == ">") {
            request = message_of(bytes_of(in));
        } else if (word == "hand" || word == "wait" || word == "stream>") {
            request.reset();
        } else if ((word == "<" || word == "<~") && request && line.find("none") == std::string::npos) {
            const Message m = message_of(bytes_of(in));
            if (m.cw == cw::RT || !request->wants_ack()) {
                EXPECT_EQ(m.cw == cw::RT ? match(*request, m) : Match::no, Match::no);
                continue;
            }
            const auto how = match(*request, m);
            const bool error = m.cw == cw::ER && request->function() != cw::ER;
            if (request->function() == cw::ER) {
                EXPECT_NE(how, Match::no);
            } else {
                EXPECT_EQ(how, error ? Match::error : Match::answer);
            }
            error ? ++refusals : ++pairs;
            if (how == Match::answer && form_of(*request) == Form::set && word == "<") {
                EXPECT_TRUE(echoes(*request, m));
            }
            request.reset();
        }
    }
    EXPECT_GE(pairs, 80);
    EXPECT_GE(refusals, 30);
}

TEST(Uim342Wire, IdentifiersOfTheBrief) {
    struct Row {
        std::uint8_t producer, consumer, cw;
        std::uint32_t id;
    };
    for (const Row& r :
         {Row{4, 5, 0x95, 0x04280095}, Row{5, 4, 0x15, 0x05200015}, Row{5, 4, 0x2E, 0x0520002E}, Row{5, 4, 0x0F, 0x0520000F},
          Row{4, 37, 0x95, 0x04284095}, Row{4, 69, 0x95, 0x04288095}, Row{4, 126, 0x95, 0x04F0C095}, Row{4, 32, 0x8B, 0x0400408B},
          Row{37, 4, 0x15, 0x05210015}, Row{126, 4, 0x5A, 0x1E23005A}, Row{4, 0, 0x16, 0x04000016}, Row{4, 10, 0x16, 0x04500016}}) {
        EXPECT_EQ(can_id(r.producer, r.consumer, r.cw), r.id);
        EXPECT_EQ(producer_of(r.id), r.producer);
        EXPECT_EQ(consumer_of(r.id), r.consumer);
    }
    // Every pair of IDs comes back; those that share a SID differ in the EID.
    for (unsigned p = 0; p < 128; ++p) {
        for (unsigned c = 0; c < 128; ++c) {
            const auto id = can_id(static_cast<std::uint8_t>(p), static_cast<std::uint8_t>(c), 0xFF);
            ASSERT_EQ(producer_of(id), p);
            ASSERT_EQ(consumer_of(id), c);
            ASSERT_EQ(id & can_id_reserved, 0u);
        }
    }
}

TEST(Uim342Wire, FramesThatAreNotSimpleCan) {
    const std::array<std::uint8_t, 1> data{1};
    Frame f = Frame::can_extended(0x05200015, data);
    EXPECT_TRUE(from_can(f));
    Frame base = f;
    base.extended = false;
    EXPECT_FALSE(from_can(base));
    Frame remote = f;
    remote.remote = true;
    EXPECT_FALSE(from_can(remote));
    Frame report = f;
    report.kind = Frame::Kind::can_error;
    EXPECT_FALSE(from_can(report));
    EXPECT_FALSE(from_can(Frame::can_extended(0x05200115, data))) << "reserved bit 8";
    EXPECT_FALSE(from_can(Frame::can_extended(0x05202015, data))) << "reserved bit 13";
    EXPECT_FALSE(from_can(Frame::can_extended(0x05240015, data))) << "bit 18";
    EXPECT_FALSE(from_can(Frame::run(data)));
}

TEST(Uim342Wire, Numbers) {
    const std::array<std::uint8_t, 4> b{0x18, 0xFC, 0xFF, 0xFF};
    EXPECT_EQ(get_i32(b.data()), -1000);
    EXPECT_EQ(get_i24(b.data()), -1000);
    EXPECT_EQ(get_u16(b.data()), 0xFC18);
    const std::array<std::uint8_t, 4> c{0x04, 0x03, 0x02, 0x01};
    EXPECT_EQ(get_u32(c.data()), 0x01020304u);
    const std::array<std::uint8_t, 3> low{0x00, 0x00, 0x80}, high{0xFF, 0xFF, 0x7F};
    EXPECT_EQ(get_i24(low.data()), -8388608);
    EXPECT_EQ(get_i24(high.data()), 8388607);
}

TEST(Uim342Wire, StatusOfThePrintedExample) {
    const Message m = message(5, cw::MS, std::array<std::uint8_t, 8>{0x00, 0x3D, 0x03, 0x00, 0x18, 0xFC, 0xFF, 0xFF});
    const Status s = status_of(m);
    EXPECT_EQ(s.mode, 1);
    EXPECT_TRUE(s.on && s.in1 && s.in2 && s.in3 && s.stop && s.paif);
    EXPECT_FALSE(s.op1 || s.tlif || s.lock || s.err);
    EXPECT_EQ(s.relative_position, -1000);
    EXPECT_EQ(s.raw, 0x00033Du);
    for (const auto& [byte, bit, flag] :
         {std::tuple{1, 0x40, &Status::op1}, {2, 0x08, &Status::tlif}, {2, 0x20, &Status::lock}, {2, 0x80, &Status::err}}) {
        Message one = message(5, cw::MS, std::array<std::uint8_t, 8>{});
        one.d[static_cast<std::size_t>(byte)] = static_cast<std::uint8_t>(bit);
        const Status t = status_of(one);
        EXPECT_TRUE(t.*flag);
        EXPECT_FALSE(t.on || t.stop || t.paif);
    }
}

TEST(Uim342Wire, NotificationsReadD0First) {
    // On CAN an input event has one byte; whatever stands behind it must not be looked at.
    const auto n = notification_of(message(5, cw::RT, std::array<std::uint8_t, 1>{0x04}));
    EXPECT_EQ(n.kind, Notification::Kind::input);
    EXPECT_EQ(n.input, 2);
    EXPECT_TRUE(n.rising);
    const std::array<std::uint8_t, 8> done{0x29, 0, 0, 0, 0x18, 0xFC, 0xFF, 0xFF};
    const auto d = notification_of(message(5, cw::RT, done));
    EXPECT_EQ(d.kind, Notification::Kind::finished);
    EXPECT_TRUE(d.has_position);
    EXPECT_EQ(d.position, -1000);
    EXPECT_FALSE(notification_of(message(5, cw::RT, std::span(done).first(5))).has_position);
    const auto alarm = notification_of(message(5, cw::RT, std::array<std::uint8_t, 5>{0x00, 0x1D}));
    EXPECT_EQ(alarm.kind, Notification::Kind::alarm);
    EXPECT_EQ(alarm.code, 0x1D);
    EXPECT_EQ(notification_of(message(5, cw::RT, std::array<std::uint8_t, 1>{0x00})).kind, Notification::Kind::unknown);
    EXPECT_EQ(notification_of(message(5, cw::RT)).kind, Notification::Kind::unknown);
    EXPECT_EQ(notification_of(message(5, cw::RT, std::array<std::uint8_t, 1>{0x07})).kind, Notification::Kind::unknown);
}

TEST(Uim342Wire, Models) {
    const auto model = [](std::uint8_t a, std::uint8_t b, std::uint8_t c) {
        return model_of(message(5, cw::ML, std::array<std::uint8_t, 8>{a, b, c}));
    };
    EXPECT_EQ(model(0x20, 0x0A, 0x11).name, "UIM342XS");
    EXPECT_EQ(model(0x21, 0x0A, 0x11).name, "UIM342S");
    EXPECT_EQ(model(0x22, 0x14, 0x13).name, "UIM342C02");
    EXPECT_EQ(model(0x22, 0x28, 0x13).name, "UIM342C04");
    EXPECT_EQ(model(0x22, 0x50, 0x13).name, "UIM342C08");
    EXPECT_EQ(model(0x22, 0x50, 0x19).name, "UIM342H08");
    EXPECT_TRUE(model(0x19, 0x0D, 0).gateway);
    EXPECT_TRUE(model(0x33, 0, 0).name.empty());
    EXPECT_TRUE(model_of(message(5, cw::ML, std::array<std::uint8_t, 2>{0x20, 0x0A})).name.empty());
}

// --- GET, SET and answers --------------------------------------------------------------------------------------------------------

TEST(Uim342Instructions, TheTableHasTheRegisterOfTheManual) {
    EXPECT_EQ(all_instructions().size(), 29u);
    for (const auto& i : all_instructions()) {
        EXPECT_EQ(instruction(i.cw), &i);
        EXPECT_EQ(instruction(i.cw | ack_bit), &i);
        EXPECT_EQ(instruction_named(i.name), &i);
        EXPECT_EQ(i.indexed, !i.indices.empty()) << i.name;
    }
    EXPECT_EQ(instruction(0x02), nullptr);
    EXPECT_EQ(instruction_named("XY"), nullptr);
    EXPECT_EQ(instruction_named("mo"), instruction(cw::MO));
    EXPECT_FALSE(instruction(cw::BG)->repeatable);
    EXPECT_TRUE(instruction(cw::ST)->repeatable);
}

TEST(Uim342Instructions, DataLengthAloneTellsGetFromSet) {
    EXPECT_EQ(form_of(message(5, 0x99)), Form::get);
    EXPECT_EQ(form_of(message(5, 0x99, std::array<std::uint8_t, 4>{})), Form::set);
    EXPECT_EQ(form_of(message(5, 0x90, std::array<std::uint8_t, 1>{})), Form::get);
    EXPECT_EQ(form_of(message(5, 0x90, std::array<std::uint8_t, 3>{})), Form::set);
    EXPECT_EQ(form_of(message(5, 0x90, std::array<std::uint8_t, 2>{})), Form::unknown);
    EXPECT_EQ(form_of(message(5, 0x9D, std::array<std::uint8_t, 2>{})), Form::set) << "E-10: two data bytes are a SET";
    EXPECT_EQ(form_of(message(5, 0xB7, std::array<std::uint8_t, 2>{})), Form::unknown);
    EXPECT_EQ(form_of(message(5, 0xBD, std::array<std::uint8_t, 4>{})), Form::unknown) << "E-16";
    EXPECT_EQ(form_of(message(5, 0x82)), Form::unknown);
}

TEST(Uim342Instructions, MotionSetsAreAnsweredAsDesiredValues) {
    struct Row {
        std::uint8_t cw, index;
    };
    for (const Row r : {Row{cw::JV, 2}, Row{cw::SP, 2}, Row{cw::PR, 3}, Row{cw::PA, 4}}) {
        const Message request = set(5, r.cw, -1000);
        EXPECT_EQ(request.dl, 4);
        const Message answer = message(5, cw::DV, std::array<std::uint8_t, 5>{r.index, 0x18, 0xFC, 0xFF, 0xFF});
        EXPECT_EQ(match(request, answer), Match::answer);
        EXPECT_TRUE(echoes(request, answer));
        EXPECT_EQ(value_of(request, answer), -1000);
        EXPECT_FALSE(echoes(set(5, r.cw, 1000), answer));
        Message other = answer;
        other.d[0] = static_cast<std::uint8_t>(r.index + 1);
        EXPECT_EQ(match(request, other), Match::no);
        EXPECT_EQ(match(request, message(5, r.cw, std::array<std::uint8_t, 4>{})), Match::no) << "its own control word answers only a GET";
        EXPECT_EQ(match(get(5, r.cw), message(5, r.cw, std::array<std::uint8_t, 4>{})), Match::answer);
        EXPECT_EQ(match(request, message(5, cw::DV, std::array<std::uint8_t, 4>{r.index})), Match::torn);
    }
    // JV=N, SP=N and DV[2] have the same answer; nothing else may share a mark.
    EXPECT_EQ(mark_of(set(5, cw::JV, 1)), mark_of(set(5, cw::SP, 2)));
    EXPECT_EQ(mark_of(set(5, cw::JV, 1)), mark_of(get(5, cw::DV, 2)));
    EXPECT_NE(mark_of(set(5, cw::JV, 1)), mark_of(get(5, cw::JV)));
    EXPECT_NE(mark_of(set(5, cw::PA, 1)), mark_of(set(5, cw::PR, 1)));
    EXPECT_NE(mark_of(get(5, cw::MT, 0)), mark_of(get(5, cw::MT, 1)));
}

TEST(Uim342Instructions, ErrorReportsAreMatchedByTheirControlWord) {
    const auto report = [](std::uint8_t code, std::uint8_t of, std::uint8_t index, std::uint8_t slot = 0) {
        return message(5, cw::ER, std::array<std::uint8_t, 6>{slot, code, of, index});
    };
    const Message write = set(5, cw::PP, 9, 5);
    EXPECT_EQ(match(write, report(0x33, 0x81, 5)), Match::error);
    EXPECT_EQ(match(write, report(0x33, 0x01, 5)), Match::error) << "with or without bit 7";
    EXPECT_EQ(match(write, report(0x33, 0x86, 5)), Match::no);
    EXPECT_EQ(match(write, report(0x33, 0x81, 7)), Match::no) << "about another index: an older request";
    EXPECT_EQ(match(get(5, cw::AC), report(0x32, 0x99, 0)), Match::error);
    // ER[0] looks like a report about something else; ER[i] of another slot does not.
    EXPECT_EQ(match(get(5, cw::ER, 0), report(0x33, 0x81, 5)), Match::answer);
    EXPECT_EQ(match(get(5, cw::ER, 11), report(0x33, 0x81, 5)), Match::no);
    EXPECT_EQ(match(get(5, cw::ER, 11), report(0x33, 0x81, 5, 11)), Match::answer);
    EXPECT_EQ(match(get(5, cw::ER, 1), report(0x34, 0x8F, 1)), Match::error);
    // DL from 4 on is enough (E-07).
    EXPECT_EQ(match(write, message(5, cw::ER, std::array<std::uint8_t, 4>{0, 0x33, 0x81, 5})), Match::error);
    EXPECT_EQ(match(write, message(5, cw::ER, std::array<std::uint8_t, 3>{0, 0x33, 0x81})), Match::no);
    EXPECT_EQ(match(write, message(5, cw::RT, std::array<std::uint8_t, 2>{0, 0x1D})), Match::no) << "RT is never an answer";
}

TEST(Uim342Instructions, AnswersThatAreTooShort) {
    EXPECT_EQ(match(get(5, cw::AC), message(5, cw::AC, std::array<std::uint8_t, 2>{})), Match::torn);
    EXPECT_EQ(match(get(5, cw::MS, 0), message(5, cw::MS, std::array<std::uint8_t, 7>{})), Match::torn);
    EXPECT_EQ(match(get(5, cw::MT, 1), message(5, cw::MT)), Match::torn);
    EXPECT_EQ(match(act(5, cw::BG), message(5, cw::BG)), Match::answer) << "its four bytes mean nothing";
    EXPECT_EQ(match(get(5, cw::MT, 1), message(5, cw::MT, std::array<std::uint8_t, 3>{2, 1, 0})), Match::no) << "another index";
}

TEST(Uim342Instructions, DigitalOutputIsAsymmetric) {
    const Message m = set(5, cw::DI, 1);
    EXPECT_TRUE(std::ranges::equal(m.data(), std::array<std::uint8_t, 4>{1, 1, 0, 0}));
    EXPECT_TRUE(echoes(m, message(5, cw::DI, std::array<std::uint8_t, 4>{3, 1, 0, 0}))) << "the answer is the levels, not an echo";
}

// --- the byte stream -------------------------------------------------------------------------------------------------------------

struct Received {
    std::vector<Message> messages;
    std::vector<CrcMode> proved;
    std::size_t junk = 0;
};
void feed(UiFramer& f, std::span<const std::uint8_t> bytes, Received& r) {
    f.push(
        bytes,
        [&](const UiCheck& c, const UiBytes&) {
            r.messages.push_back(c.message);
            r.proved.push_back(c.proved);
        },
        [&](std::uint8_t) { ++r.junk; });
}
std::vector<std::uint8_t> stream_of(std::initializer_list<Message> list, CrcMode mode = CrcMode::twelve) {
    std::vector<std::uint8_t> s;
    for (const auto& m : list) {
        const auto b = to_uimessage(m, mode);
        s.insert(s.end(), b.begin(), b.end());
    }
    return s;
}

TEST(Uim342Framer, StartAndEndBytesInsideAndEverySplit) {
    // BL has CW AD, the data hold AA, AD and CC.
    const Message bl = message(5, 0xAD, std::array<std::uint8_t, 4>{0xAA, 0xCC, 0xAD, 0xCC});
    const Message pa = message(5, 0xA0, std::array<std::uint8_t, 4>{0xCC, 0xAA, 0xAA, 0xAA});
    const auto s = stream_of({bl, pa, bl});
    for (std::size_t cut = 0; cut <= s.size(); ++cut) {
        UiFramer f;
        Received r;
        feed(f, std::span(s).first(cut), r);
        feed(f, std::span(s).subspan(cut), r);
        ASSERT_EQ(r.messages, (std::vector{bl, pa, bl})) << "cut at " << cut;
        ASSERT_EQ(r.junk, 0u);
    }
}

TEST(Uim342Framer, OneStrangeByteDoesNotLoseTwoFrames) {
    const Message bl = message(5, 0xAD, std::array<std::uint8_t, 4>{0xAA, 0xCC, 0xAD, 0xCC});
    for (const int strange : {0x00, 0xAA, 0xAD, 0xCC, 0x55}) {
        auto s = stream_of({bl, bl});
        s.insert(s.begin(), static_cast<std::uint8_t>(strange));
        UiFramer f;
        Received r;
        feed(f, s, r);
        EXPECT_EQ(r.messages.size(), 2u) << std::hex << strange;
        EXPECT_EQ(r.junk, 1u);
    }
}

TEST(Uim342Framer, LostAndWrongBytesCostOneFrame) {
    const Message a = message(5, 0x11, std::array<std::uint8_t, 8>{0, 0x3D, 3, 0, 0xAA, 0xAA, 0xCC, 0xAA});
    const Message b = message(6, 0x11, std::array<std::uint8_t, 8>{1, 2, 3, 4, 5, 6, 7, 8});
    for (std::size_t at = 0; at < uimessage_size; ++at) {
        auto lost = stream_of({a, b, a});
        lost.erase(lost.begin() + static_cast<std::ptrdiff_t>(uimessage_size + at));
        UiFramer f;
        Received r;
        feed(f, lost, r);
        EXPECT_EQ(r.messages, (std::vector{a, a})) << "without byte " << at;

        auto wrong = stream_of({a, b, a});
        wrong[uimessage_size + at] ^= 0x10;
        UiFramer g;
        Received q;
        feed(g, wrong, q);
        EXPECT_EQ(q.messages, (std::vector{a, a})) << "byte " << at << " changed";
    }
}

TEST(Uim342Framer, CrcRangeIsASetting) {
    const Message m = message(5, 0x15, std::array<std::uint8_t, 1>{1});
    const auto twelve = stream_of({m}), thirteen = stream_of({m}, CrcMode::thirteen), plain = stream_of({m}, CrcMode::none);
    struct Row {
        CrcMode mode;
        bool takes_twelve, takes_thirteen, takes_plain;
    };
    for (const Row row : {Row{CrcMode::twelve, true, false, false}, Row{CrcMode::thirteen, false, true, false},
                          Row{CrcMode::automatic, true, true, false}, Row{CrcMode::none, true, true, true}}) {
        const auto takes = [&](const auto& bytes) {
            UiFramer f(row.mode);
            Received r;
            feed(f, bytes, r);
            return r.messages.size() == 1;
        };
        EXPECT_EQ(takes(twelve), row.takes_twelve) << name_of(row.mode);
        EXPECT_EQ(takes(thirteen), row.takes_thirteen) << name_of(row.mode);
        EXPECT_EQ(takes(plain), row.takes_plain) << name_of(row.mode);
        EXPECT_EQ(crc_mode_named(name_of(row.mode)), row.mode);
    }
    EXPECT_FALSE(crc_mode_named("14"));
    // auto: the first good frame pins the range until the line comes anew.
    UiFramer f(CrcMode::automatic);
    Received r;
    feed(f, thirteen, r);
    EXPECT_EQ(f.accepting(), CrcMode::thirteen);
    feed(f, twelve, r);
    EXPECT_EQ(r.messages.size(), 1u);
    f.reset();
    EXPECT_EQ(f.accepting(), CrcMode::automatic);
    feed(f, twelve, r);
    EXPECT_EQ(r.messages.size(), 2u);
}

TEST(Uim342Framer, LengthsAndIdsThatCannotBe) {
    UiBytes b = to_uimessage(message(5, 0x15, std::array<std::uint8_t, 1>{1}), CrcMode::twelve);
    b[3] = 9;
    put_u16(&b[13], crc16(std::span(b).subspan(1, 12)));
    EXPECT_FALSE(check_uimessage(b, CrcMode::twelve).good);
    b[3] = 1;
    b[1] = 0x80;
    put_u16(&b[13], crc16(std::span(b).subspan(1, 12)));
    EXPECT_FALSE(check_uimessage(b, CrcMode::twelve).good);
}

}  // namespace
}  // namespace axisgate::uim342
