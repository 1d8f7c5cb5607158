// Each form of recorded lines is read back into its frames, and other text is reported with its place.
#include "gateway/runtime/recording.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gateway/wire/frame_export.hpp"

namespace axisgate {
namespace {

struct Read {
    std::vector<RecordedFrame> frames;
    std::vector<std::size_t> faults;
};
Read read(std::string_view text, RecordingFormat format) {
    Read r;
    RecordingEvents events;
    events.frame = [&](const RecordedFrame& f) { r.frames.push_back(f); };
    events.fault = [&](std::size_t place, const std::string& what) {
        EXPECT_FALSE(what.empty());
        r.faults.push_back(place);
    };
    read_recording(text, format, events);
    return r;
}

struct RecordedLine {
    std::string_view name, text;
    RecordingFormat format;
    std::string_view frame;  // to_text; empty: not a line
    std::string_view stamp = {};
    std::optional<bool> to_drive = {};
};
const RecordedLine lines[]{
    {"log", "(1.500000) can0 04280095#01", RecordingFormat::candump, "04280095#01", "(1.500000)"},
    {"log_sent", "(1.5) can0 04280095#01 T", RecordingFormat::candump, "04280095#01", "(1.5)", true},
    {"log_received", "(1.5) can0 123#0102 R", RecordingFormat::candump, "123#0102", "(1.5)", false},
    {"log_date", "(2026-01-02 03:04:05.678901) can0 123#01", RecordingFormat::candump, "123#01", "(2026-01-02 03:04:05.678901)"},
    {"log_remote", "(1.5) can0 00000123#R8", RecordingFormat::candump, "00000123#R", "(1.5)"},
    {"log_report", "(1.5) can0 20000040#0000000000000000", RecordingFormat::candump, "error 00000040#0000000000000000", "(1.5)"},
    {"log_empty", "can0 123#", RecordingFormat::candump, "123#"},
    {"screen", "  can0  04280095   [1]  01", RecordingFormat::candump, "04280095#01"},
    {"screen_none", "can0  04280095   [0]", RecordingFormat::candump, "04280095#"},
    {"screen_remote", "can0  04280095   [0]  remote request", RecordingFormat::candump, "04280095#R"},
    {"screen_text", "can0  123   [2]  41 42   'AB'", RecordingFormat::candump, "123#4142"},
    {"screen_direction", " (1.5)  can0  TX - -  04280095   [1]  01", RecordingFormat::candump, "04280095#01", "(1.5)", true},
    {"text_can", "(1.5) can0 device > 04280095#01", RecordingFormat::candump, "04280095#01", "(1.5)", true},
    {"text_bytes", "(1.5) ttyS1 twin < AA 05 95", RecordingFormat::candump, "AA 05 95", "(1.5)", false},
    {"text_report", "(1.5) can0 device < error 00000040#00", RecordingFormat::candump, "error 00000040#00", "(1.5)", false},
    {"text_in_hex", "(1.5) ttyS1 device > AA 05 95", RecordingFormat::hex, "AA 05 95", "(1.5)", true},
    {"hex", "AA 05 95", RecordingFormat::hex, "AA 05 95"},
    {"hex_to", "> AA:05:95", RecordingFormat::hex, "AA 05 95", {}, true},
    {"hex_time", "(1.5) > AA 05", RecordingFormat::hex, "AA 05", "(1.5)", true},
    {"hex_time_alone", "(1.5) AA 05", RecordingFormat::hex, "AA 05", "(1.5)"},
    {"hex_from", "<AA0595", RecordingFormat::hex, "AA 05 95", {}, false},
    {"trace_can", R"([{"at":"t","to_drive":true,"kind":"can","id":69730453,"extended":true,"remote":false,"data":"01"}])",
     RecordingFormat::trace, "04280095#01", "t", true},
    {"trace_bytes", R"({"frames":[{"at":"t","to_drive":false,"kind":"bytes","id":null,"extended":false,"remote":false,"data":"AA0595"}]})",
     RecordingFormat::trace, "AA 05 95", "t", false},
    {"bad_nine_bytes", "can0 123#010203040506070809", RecordingFormat::candump, ""},
    {"bad_half_byte", "can0 123#1", RecordingFormat::candump, ""},
    {"bad_id", "can0 12345678901#01", RecordingFormat::candump, ""},
    {"bad_short_id", "can0 12#01", RecordingFormat::candump, ""},
    {"bad_stamp", "(1.5 can0 123#01", RecordingFormat::candump, ""},
    {"bad_interface_alone", "can0", RecordingFormat::candump, ""},
    {"bad_can_fd", "can0 123##101", RecordingFormat::candump, ""},
    {"bad_hex", "> AA 0", RecordingFormat::hex, ""},
    {"bad_hex_word", "hello", RecordingFormat::hex, ""},
    {"bad_trace_id", R"([{"kind":"can","id":-1,"data":"01"}])", RecordingFormat::trace, ""},
    {"bad_trace_wide_id", R"([{"kind":"can","id":536870912,"data":"01"}])", RecordingFormat::trace, ""},
    {"bad_trace_data", R"([{"kind":"can","id":1,"data":7}])", RecordingFormat::trace, ""},
    {"bad_trace_long", R"([{"kind":"can","id":1,"data":"010203040506070809"}])", RecordingFormat::trace, ""},
};
class Forms : public testing::TestWithParam<RecordedLine> {};

TEST_P(Forms, IsReadOrSaidToBeWrong) {
    const RecordedLine& c = GetParam();
    const Read r = read(c.text, c.format);
    if (c.frame.empty()) {
        EXPECT_EQ(r.frames.size(), 0u);
        EXPECT_EQ(r.faults, std::vector<std::size_t>{1});
        return;
    }
    EXPECT_TRUE(r.faults.empty());
    ASSERT_EQ(r.frames.size(), 1u);
    EXPECT_EQ(to_text(r.frames[0].frame), c.frame);
    EXPECT_EQ(r.frames[0].stamp, c.stamp);
    EXPECT_EQ(r.frames[0].to_drive, c.to_drive);
}
INSTANTIATE_TEST_SUITE_P(Lines, Forms, testing::ValuesIn(lines), [](const auto& i) { return std::string(i.param.name); });

TEST(Recording, WhatTheApiWritesIsReadBack) {
    std::mt19937 random(7);
    std::vector<TraceEntry> entries(200);
    for (auto& e : entries) {
        Frame& f = e.frame;
        f.kind = static_cast<Frame::Kind>(random() % 3);
        f.extended = f.kind == Frame::Kind::can && random() % 2;
        f.remote = f.kind == Frame::Kind::can && random() % 8 == 0;
        f.id = f.kind == Frame::Kind::bytes
                   ? 0
                   : static_cast<std::uint32_t>(random()) & (f.extended || f.kind == Frame::Kind::can_error ? 0x1FFFFFFFu : 0x7FFu);
        std::vector<std::uint8_t> data(f.remote ? 0 : f.kind == Frame::Kind::bytes ? 1 + random() % 40 : random() % 9);
        for (auto& b : data)
            b = static_cast<std::uint8_t>(random());
        f.assign(data);
        e.to_drive = random() % 2;
        e.simulated = random() % 2;
        e.at_unix_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(random()) * 1000;
    }
    const Read text = read(trace_text(entries, "can0"), RecordingFormat::candump);
    ASSERT_TRUE(text.faults.empty());
    ASSERT_EQ(text.frames.size(), entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        EXPECT_EQ(to_text(text.frames[i].frame), to_text(entries[i].frame)) << i;
        EXPECT_EQ(text.frames[i].to_drive, entries[i].to_drive) << i;
    }
    std::erase_if(entries, [](const TraceEntry& e) { return e.frame.kind == Frame::Kind::bytes; });
    const Read log = read(candump_text(entries, "can0"), RecordingFormat::candump);
    ASSERT_TRUE(log.faults.empty());
    ASSERT_EQ(log.frames.size(), entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        EXPECT_EQ(to_text(log.frames[i].frame), to_text(entries[i].frame)) << i;
        EXPECT_EQ(log.frames[i].frame.kind, entries[i].frame.kind) << i;
    }
}

TEST(Recording, PlacesAreLinesAndEntries) {
    const Read r = read("# a comment\n\n  \r\ncan0 123#01\r\nnonsense\ncan0 124#02\nmore\n", RecordingFormat::candump);
    ASSERT_EQ(r.frames.size(), 2u);
    EXPECT_EQ(r.frames[1].frame.id, 0x124u);
    EXPECT_EQ(r.faults, (std::vector<std::size_t>{5, 7}));
    EXPECT_EQ(read("{]", RecordingFormat::trace).faults, std::vector<std::size_t>{0});
    EXPECT_EQ(read("{\"frames\":7}", RecordingFormat::trace).faults, std::vector<std::size_t>{0});
    EXPECT_EQ(read("[7, {}]", RecordingFormat::trace).faults, (std::vector<std::size_t>{1, 2}));
}

TEST(Recording, StampsAreTimes) {
    std::vector<std::int64_t> times;
    std::vector<std::string> names;
    RecordingEvents events;
    events.frame = [&](const RecordedFrame& f) {
        times.push_back(f.at_ns.value_or(-1));
        names.push_back(f.line);
    };
    events.fault = [](std::size_t, const std::string& text) { ADD_FAILURE() << text; };
    read_recording("(1.5) can0 123#01\n(1970-01-01 00:00:02.000003) can1 123#01\n(x) can0 123#01\n", RecordingFormat::candump, events);
    read_recording("(0.000000004) > 01\n> 02\n", RecordingFormat::hex, events);
    EXPECT_EQ(times, (std::vector<std::int64_t>{1'500'000'000, 2'000'003'000, -1, 4, -1}));
    EXPECT_EQ(names, (std::vector<std::string>{"can0", "can1", "can0", "", ""}));
}

TEST(Recording, CapturesAreReadBackWithTimeDirectionAndInterface) {
    std::vector<TraceEntry> entries(3);
    const std::uint8_t data[]{1, 2, 3};
    entries[0].frame = Frame::can_extended(0x04280095, data);
    entries[1].frame = Frame::run(data);
    entries[2].frame.kind = Frame::Kind::can;
    entries[2].frame.id = 0x123;
    entries[2].frame.remote = true;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        entries[i].at_unix_ns = 1'700'000'000'123'456'789 + static_cast<std::int64_t>(i);
        entries[i].to_drive = i == 1;
        entries[i].simulated = i == 2;
    }
    const std::string capture = pcapng(entries, "can0");
    EXPECT_EQ(recording_format_of(capture), RecordingFormat::pcapng);
    std::vector<RecordedFrame> frames;
    RecordingEvents events;
    std::vector<std::string> faults;
    events.frame = [&](const RecordedFrame& f) { frames.push_back(f); };
    events.fault = [&](std::size_t, const std::string& text) { faults.push_back(text); };
    read_recording(capture + capture, RecordingFormat::pcapng, events);  // a second section, as .axr recordings have one per line
    ASSERT_EQ(frames.size(), 6u);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const TraceEntry& e = entries[i % 3];
        EXPECT_TRUE(frames[i].frame.same(e.frame)) << i;
        EXPECT_EQ(frames[i].at_ns, e.at_unix_ns);
        EXPECT_EQ(frames[i].to_drive, e.to_drive);
        EXPECT_EQ(frames[i].line, i % 3 == 2 ? "can0 (twin)" : "can0");
    }
    EXPECT_TRUE(faults.empty());
    for (std::size_t n = 1; n < capture.size(); ++n) {
        faults.clear();
        read_recording(capture.substr(0, n), RecordingFormat::pcapng, events);
        // A capture that ends between two blocks is one with fewer packets.
        if (n % 4 != 0) EXPECT_EQ(faults.size(), 1u) << n;
    }
}

TEST(Recording, TheFormatFollowsFromTheContent) {
    for (const auto& [text, format] : {std::pair{"(1.5) can0 123#01", RecordingFormat::candump},
                                       {"  can0  123  [1]  01", RecordingFormat::candump},
                                       {"# a comment\n(1.5) > AA 05", RecordingFormat::hex},
                                       {"< AA", RecordingFormat::hex},
                                       {"AA 05", RecordingFormat::hex},
                                       {"(1.5) ttyS1 device > AA", RecordingFormat::candump},
                                       {" [{}]", RecordingFormat::trace},
                                       {"\x89"
                                        "AXR\r\n\x1A\n",
                                        RecordingFormat::axr}})
        EXPECT_EQ(recording_format_of(text), format) << text;
}

TEST(Recording, ALongRunOfBytesComesInPieces) {
    std::string text = "> ";
    for (int i = 0; i < 700; ++i)
        text += "5A ";
    const Read r = read(text, RecordingFormat::hex);
    ASSERT_EQ(r.frames.size(), 3u);
    EXPECT_EQ(r.frames[0].frame.size, 256);
    EXPECT_EQ(r.frames[2].frame.size, 700 - 512);
    EXPECT_EQ(r.frames[2].to_drive, true);
}

}  // namespace
}  // namespace axisgate
