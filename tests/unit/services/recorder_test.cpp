// Trends in their ring, and the container of recordings: complete, truncated, altered.
#include <gtest/gtest.h>

#include <algorithm>

#include "gateway/axis/image.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/services/recorder/trends.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

const AxisId left{1}, right{2};

PictureRecord at_position(std::int64_t position, std::int64_t behind = 0) {
    PictureRecord p;
    p.current = true;
    p.position = position;
    p.demand = position + behind;
    p.demand_source = DemandSource::drive;
    p.velocity = 10;
    p.statusword = 0x27;
    return p;
}

TEST(Trends, GivesBackWhatWasTold) {
    Trends t(1 << 20, 10min);
    for (int i = 0; i < 2000; ++i)
        t.add(left, at_position(i * i * 1000003LL - 500, i % 7 - 3), Instant(i * 10ms));
    const auto all = t.read(left, Instant(0s), Instant(100s), 0);
    ASSERT_EQ(all.columns.size(), 2000u);
    EXPECT_FALSE(all.thinned);
    for (int i = 0; i < 2000; ++i) {
        const auto& r = all.columns[static_cast<std::size_t>(i)].low;
        ASSERT_EQ(r.at, Instant(i * 10ms));
        ASSERT_EQ(r.position, i * i * 1000003LL - 500);
        ASSERT_EQ(r.following_error(), i % 7 - 3);
        ASSERT_EQ(r.statusword, 0x27);
    }
    EXPECT_NEAR(all.rate_hz, 100, 2);
}

TEST(Trends, WhatDoesNotChangeCostsNothing) {
    Trends t(1 << 20, 10min);
    t.add(left, at_position(5), Instant(1s));
    const auto before = t.bytes();
    for (int i = 1; i < 5000; ++i)
        t.add(left, at_position(5), Instant(1s + i * 10ms));
    EXPECT_EQ(t.bytes(), before);
    const auto r = t.read(left, Instant(20s), Instant(30s), 100);
    ASSERT_EQ(r.columns.size(), 1u);  // the valid row, with the instant of the beginning
    EXPECT_EQ(r.columns[0].low.at, Instant(20s));
    EXPECT_EQ(r.columns[0].low.position, 5);
    EXPECT_EQ(r.newest, Instant(1s + 4999 * 10ms));
}

TEST(Trends, ThinnedKeepsEveryPeak) {
    Trends t(1 << 22, 1h);
    for (int i = 0; i < 10'000; ++i)
        t.add(left, at_position(i == 4321 ? 1'000'000 : i == 7777 ? -1'000'000 : i % 10, i == 5000 ? 99 : 0), Instant(i * 1ms));
    const auto r = t.read(left, Instant(0s), Instant(10s), 50);
    EXPECT_TRUE(r.thinned);
    ASSERT_EQ(r.columns.size(), 50u);
    std::int64_t highest = 0, lowest = 0, error = 0;
    for (const auto& c : r.columns) {
        highest = std::max(highest, c.high.position);
        lowest = std::min(lowest, c.low.position);
        error = std::max(error, c.greatest_error);
        EXPECT_LE(c.low.position, c.high.position);
    }
    EXPECT_EQ(highest, 1'000'000);
    EXPECT_EQ(lowest, -1'000'000);
    EXPECT_EQ(error, 99);
}

/// The value that a plot of a reduced period draws at an instant: `last` is valid from the end of a column to the next one.
std::int64_t drawn_at(const TrendStretch& s, Instant at) {
    std::int64_t v = 0;
    for (const auto& c : s.columns)
        if (c.first.at <= at) v = at < c.last.at ? c.first.velocity : c.last.velocity;
    return v;
}

TEST(Trends, AThinnedRestIsARest) {
    Trends t(1 << 22, 1h);
    PictureRecord p = at_position(0);
    for (int i = 0; i < 1000; ++i) {
        p.position = i;
        p.velocity = 15;
        t.add(left, p, Instant(i * 10ms));
    }
    p.velocity = 0;
    p.statusword = 0x08;
    t.add(left, p, Instant(10s));
    p.position = 1000;
    p.velocity = 15;
    t.add(left, p, Instant(91s));  // it stood for 81 s
    p.velocity = 0;
    t.add(left, p, Instant(91s + 10ms));
    const auto r = t.read(left, Instant(0s), Instant(100s), 37);
    ASSERT_TRUE(r.thinned);
    for (int s = 13; s < 90; ++s)
        EXPECT_EQ(drawn_at(r, Instant(s * 1s)), 0) << s;
    EXPECT_EQ(drawn_at(r, Instant(100s)), 0);
    EXPECT_EQ(r.columns.back().high.velocity, 15);
    EXPECT_EQ(r.columns.back().last.at, Instant(91s + 10ms));
}

TEST(Trends, WhatNobodyKnowsIsNoneOfItsValues) {
    Trends t(1 << 20, 10min);
    for (int i = 0; i < 100; ++i) {
        PictureRecord p = at_position(i == 50 ? 1'000'000 : i);
        if (i >= 50 && i < 65) p.flags = flag_stale;
        if (i >= 65 && i < 90) p.demand_source = DemandSource::none;
        t.add(left, p, Instant(i * 10ms));
    }
    const auto r = t.read(left, Instant(0s), Instant(1s), 10);
    ASSERT_EQ(r.columns.size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
        const auto& c = r.columns[i];
        EXPECT_EQ(c.gap, i == 5 || i == 6) << i;
        EXPECT_EQ(c.known, i != 5) << i;
        if (c.known) {
            EXPECT_LE(c.high.position, 99) << i;
        }
        EXPECT_EQ(c.demand_known, i < 5 || i == 9) << i;
    }
    EXPECT_FALSE(r.columns[6].first.known());
    EXPECT_TRUE(r.columns[6].known);
}

TEST(Trends, StaysWithinItsBoundsAndIsFair) {
    Trends t(100'000, 10min);
    for (int i = 0; i < 100'000; ++i) {
        t.add(left, at_position(i), Instant(i * 1ms));
        t.add(right, at_position(-i), Instant(i * 1ms));
        ASSERT_LE(t.bytes(), 100'000u + 2 * (Trends::block_bytes + 512));
    }
    const auto a = t.read(left, Instant(0s), Instant(1h), 10), b = t.read(right, Instant(0s), Instant(1h), 10);
    EXPECT_GT(*a.oldest, Instant(50s));
    EXPECT_LT(std::chrono::abs(*a.oldest - *b.oldest), 2s);
    Trends short_one(10 << 20, 1s);
    for (int i = 0; i < 100'000; ++i)
        short_one.add(left, at_position(i), Instant(i * 1ms));
    EXPECT_GT(*short_one.read(left, Instant(0s), Instant(1h), 10).oldest, Instant(96s));
    // The memory of 64 axes in 10 minutes with 20 new values a second each.
    Trends many(48u << 20, 10min);
    for (int i = 0; i < 12'000; ++i) {
        for (std::uint16_t axis = 0; axis < 64; ++axis)
            many.add(AxisId{axis}, at_position(i * 37, i % 5), Instant(i * 50ms));
    }
    EXPECT_EQ(*many.read(left, Instant(0s), Instant(1h), 10).oldest, Instant(0s));
}

TEST(Trends, NothingIsMadeUp) {
    Trends t(1 << 20, 10min);
    EXPECT_TRUE(t.read(left, Instant(0s), Instant(1s), 10).columns.empty());
    t.add(left, PictureRecord{}, Instant(1s));  // never reported
    EXPECT_TRUE(t.read(left, Instant(0s), Instant(2s), 10).columns.empty());
    PictureRecord p = at_position(7);
    p.demand_source = DemandSource::open_loop;
    t.add(left, p, Instant(2s));
    const auto r = t.read(left, Instant(0s), Instant(3s), 10);
    ASSERT_EQ(r.columns.size(), 1u);
    EXPECT_FALSE(r.columns[0].low.demand_known);
    EXPECT_TRUE(t.read(left, Instant(3s), Instant(1s), 10).columns.empty());
}

TEST(Trends, RowsComeBackFromTheDiskAsTheyWere) {
    std::vector<TrendRow> rows;
    for (int i = 0; i < 500; ++i) {
        PictureRecord p = at_position(i * i * 1000003LL - 7, i % 5 - 2);
        p.flags = static_cast<std::uint16_t>(i * 131);
        p.statusword = static_cast<std::uint16_t>(65535 - i);
        if (i % 3 == 0) p.demand_source = DemandSource::none;
        rows.push_back(trend_row(p, Instant(i * 10ms - 3s)));
    }
    const std::string bytes = pack_rows(rows);
    const auto back = unpack_rows(bytes);
    ASSERT_TRUE(back);
    ASSERT_EQ(back->size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        ASSERT_EQ((*back)[i].at, rows[i].at);
        ASSERT_TRUE((*back)[i].same_values(rows[i]));
    }
    // Bytes of any origin: empty, or rows in order of time; never beyond the end.
    for (std::size_t n = 0; n < bytes.size(); n += 7)
        (void)unpack_rows(std::span(bytes).first(n));
    for (std::size_t n = 0; n < 200; ++n) {
        std::string other = bytes.substr(0, 300);
        other[n] = static_cast<char>(other[n] ^ (1 << (n % 8)));
        if (const auto r = unpack_rows(other)) {
            EXPECT_TRUE(std::ranges::is_sorted(*r, {}, &TrendRow::at)) << n;
        }
    }
    EXPECT_FALSE(unpack_rows(std::string(3, '\xFF')));
}

TEST(Trends, WhatWasKnownBeforeComesBeforeWhatIsTold) {
    Trends t(1 << 20, 10min);
    const std::vector<TrendRow> before{trend_row(at_position(5), Instant(-60s)), trend_row(at_position(9), Instant(-50s))};
    t.restore(left, before);
    t.add(left, at_position(20), Instant(2s));
    t.restore(left, before);  // the axis has rows already: nothing happens
    t.add(right, at_position(1), Instant(2s));
    const auto r = t.read(left, Instant(-55s), Instant(10s), 0);
    ASSERT_EQ(r.columns.size(), 3u);
    EXPECT_EQ(r.columns[0].low.position, 5);
    EXPECT_EQ(r.columns[1].low.position, 9);
    EXPECT_EQ(r.columns[2].low.position, 20);
}

std::string recording() {
    AxrWriter w;
    w.begin(axr_meta);
    w.add(std::string_view(R"({"name": "crash"})"));
    w.begin(axr_records);
    w.add(std::string_view("abc"));
    w.add(std::string_view("def"));
    return w.finish();
}

TEST(Axr, IsReadAsItWasWritten) {
    const std::string file = recording();
    EXPECT_TRUE(
        file.starts_with(std::string_view("\x89"
                                          "AXR\r\n\x1A\n\x01\x00",
                                          10)));
    const Axr a = read_axr(file);
    ASSERT_EQ(a.fault, "");
    const auto records = a.section(axr_records);
    EXPECT_EQ(std::string(records.begin(), records.end()), "abcdef");
    EXPECT_FALSE(a.has(axr_inputs));
    std::string fault;
    EXPECT_EQ(axr_head(std::span<const char>(file).first(100), fault), R"({"name": "crash"})") << fault;
}

TEST(Axr, CutOffAtAnyByteIsSaid) {
    const std::string file = recording();
    for (std::size_t n = 8; n < file.size(); ++n)
        ASSERT_NE(read_axr(std::span<const char>(file).first(n)).fault.find("cut off"), std::string::npos) << n;
    EXPECT_EQ(read_axr(std::string_view("PK\x03\x04")).fault, "this is no recording of axisgate (.axr)");
}

TEST(Axr, AlteredInAnyByteIsSaid) {
    const std::string file = recording();
    for (std::size_t n = 16; n < file.size(); ++n) {
        std::string other = file;
        other[n] = static_cast<char>(other[n] ^ 0x20);
        const Axr a = read_axr(other);
        ASSERT_NE(a.fault, "") << n;
        ASSERT_TRUE(a.sections.empty());
    }
    EXPECT_NE(read_axr(file + "x").fault.find("altered"), std::string::npos);
    std::string newer = file;
    newer[8] = 2;
    EXPECT_EQ(read_axr(newer).fault, "the recording is of version 2; this program reads version 1");
}

TEST(Axr, NamesOfRecordings) {
    EXPECT_EQ(check_recording_name("before-tuning_2.1"), "");
    for (const char* bad : {"", ".hidden", "a/b", "..", "ä", "a b"})
        EXPECT_NE(check_recording_name(bad), "") << bad;
    EXPECT_NE(check_recording_name(std::string(65, 'a')), "");
}

}  // namespace
}  // namespace axisgate
