// Bench for twin tests: one or several drives on one CAN bus, in virtual time, spoken to in the manual's own notation.
// In: texts such as "95 01" (control word and data). Out: what the drives sent, as "15 01" (own node) or "6:15 01" (others).
// Shares no packing code with the twin or the adapter.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/uim342/twin/twin.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::uim342::test {

using Lines = std::vector<std::string>;

/// Data of a frame without data: an address, because Frame copies from it.
inline constexpr std::array<std::uint8_t, 1> no_byte{};
inline constexpr std::span<const std::uint8_t> no_data{no_byte.data(), 0};

inline std::vector<std::uint8_t> hex(std::string_view text) {
    std::vector<std::uint8_t> bytes;
    std::istringstream in{std::string(text)};
    std::string word;
    while (in >> word)
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    return bytes;
}

inline std::string text(std::span<const std::uint8_t> bytes) {
    std::string s;
    for (const std::uint8_t b : bytes) {
        char two[4];
        std::snprintf(two, sizeof two, "%02X", b);
        if (!s.empty()) s += ' ';
        s += two;
    }
    return s;
}

/// Four bytes, low first, as text.
inline std::string le32(std::int64_t v) {
    const auto u = static_cast<std::uint32_t>(v);
    const std::array<std::uint8_t, 4> b{static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(u >> 8), static_cast<std::uint8_t>(u >> 16),
                                        static_cast<std::uint8_t>(u >> 24)};
    return text(b);
}
inline std::string le16(int v) {
    const std::array<std::uint8_t, 2> b{static_cast<std::uint8_t>(v & 0xFF), static_cast<std::uint8_t>((v >> 8) & 0xFF)};
    return text(b);
}

inline TwinSetup can_setup(std::string address = "5") {
    TwinSetup s;
    s.address = std::move(address);
    s.kind = LineKind::can;
    return s;
}

inline std::unique_ptr<Twin> make(const TwinSetup& setup) {
    static const Catalogue catalogue;
    return make_twin(catalogue, setup);
}

/// The identifier of section 2.5, built by the manual's two formulas for a master with ID 4 [L632-645].
inline std::uint32_t host_id(unsigned id, unsigned cw) {
    const unsigned sid = ((id << 1) & 0x003Fu) | 0x0100u;
    const unsigned eid = (((id << 1) & 0x00C0u) << 8) | cw;
    return (sid << 18) | eid;
}

class Bench {
public:
    explicit Bench(const TwinSetup& setup = can_setup(), const NonVolatile& memory = {}) { add(setup, memory); }

    Twin& add(const TwinSetup& setup, const NonVolatile& memory = {}) {
        drives_.push_back(make(setup));
        if (drives_.size() == 1) node_ = static_cast<unsigned>(std::stoul(setup.address));
        Out out;
        drives_.back()->power_on(memory, now_, out);
        take(out);
        return *drives_.back();
    }

    Twin& drive(std::size_t i = 0) { return *drives_[i]; }
    Instant now() const { return now_; }
    /// Node that `ask` speaks to.
    void address(unsigned node) { node_ = node; }

    /// Sends an instruction to the node; gives what the drives sent at once.
    Lines send(std::string_view instruction) { return send_to(node_, instruction); }
    Lines send_to(unsigned id, std::string_view instruction) {
        const auto b = hex(instruction);
        return frame(Frame::can_extended(host_id(id, b.at(0)), std::span(b).subspan(1)));
    }
    Lines frame(const Frame& f) {
        const std::size_t before = log_.size();
        for (auto& d : drives_) {
            Out out;
            d->on_frame(f, now_, out);
            take(out);
        }
        return {log_.begin() + static_cast<std::ptrdiff_t>(before), log_.end()};
    }
    /// The one answer to an instruction; a test failure if there is not exactly one.
    std::string ask(std::string_view instruction) {
        const Lines lines = send(instruction);
        EXPECT_EQ(lines.size(), 1u) << instruction << " -> " << testing::PrintToString(lines);
        return lines.empty() ? "" : lines.front();
    }
    /// Instructions whose answers do not matter, but that must not be refused.
    void setup(std::initializer_list<std::string_view> instructions) {
        for (const auto i : instructions) {
            for (const auto& line : send(i))
                EXPECT_NE(line.substr(0, 5), "0F 00") << i << " -> " << line;
        }
    }

    /// Time passes; gives what the drives sent by themselves, with `at_ms()` for each.
    Lines pass(Duration d) {
        const std::size_t before = log_.size();
        const Instant end = now_ + d;
        for (;;) {
            Instant next = never;
            for (auto& t : drives_)
                next = std::min(next, t->deadline());
            if (next > end) break;
            now_ = std::max(now_, next);
            for (auto& t : drives_) {
                if (t->deadline() > now_) continue;
                Out out;
                t->on_deadline(now_, out);
                take(out);
            }
        }
        now_ = end;
        return {log_.begin() + static_cast<std::ptrdiff_t>(before), log_.end()};
    }
    Lines pass_ms(double ms) { return pass(Duration{static_cast<std::int64_t>(std::llround(ms * 1e6))}); }

    Lines hand(const std::string& name, const Value& value, std::size_t i = 0) {
        const std::size_t before = log_.size();
        Out out;
        EXPECT_EQ(drives_[i]->set_hand(name, value, now_, out), "") << name;
        take(out);
        return {log_.begin() + static_cast<std::ptrdiff_t>(before), log_.end()};
    }
    Lines inputs(int levels, std::size_t i = 0) { return hand("inputs", std::int64_t{levels}, i); }

    /// Instants of the last frames, seconds.
    double last_at() const { return stamps_.empty() ? -1 : seconds(stamps_.back() - time_zero); }
    Instant last_instant() const { return stamps_.empty() ? never : stamps_.back(); }

    // Readings, by the wire.
    std::int32_t i32_of(std::string_view instruction, std::size_t skip) {
        const auto b = hex(ask(instruction));
        if (b.size() < skip + 4) return INT32_MIN;
        std::uint32_t v = 0;
        for (std::size_t i = 0; i < 4; ++i)
            v |= std::uint32_t{b[skip + i]} << (8 * i);
        return static_cast<std::int32_t>(v);
    }
    std::int32_t position() { return i32_of("A0", 1); }
    std::int32_t relative() { return i32_of("9F", 1); }
    std::int32_t speed() { return i32_of("9D", 1); }
    unsigned status1() { return hex(ask("91 00")).at(2); }  // d1
    unsigned status2() { return hex(ask("91 00")).at(3); }  // d2
    bool stopped() { return (status2() & 1u) != 0; }
    bool in_position() { return (status2() & 2u) != 0; }
    bool stalled() { return (status2() & 8u) != 0; }
    bool locked() { return (status2() & 0x20u) != 0; }
    bool error() { return (status2() & 0x80u) != 0; }
    TwinMechanics mechanics(std::size_t i = 0) { return drives_[i]->mechanics(1, now_); }

private:
    void take(const Out& out) {
        EXPECT_TRUE(out.samples.empty() && out.results.empty() && out.feedback.empty());
        for (const auto& tx : out.frames) {
            const Frame& f = tx.frame;
            EXPECT_TRUE(f.kind == Frame::Kind::can && f.extended && !f.remote);
            EXPECT_LE(f.at, now_);
            const unsigned sid = f.id >> 18;
            const unsigned eid = f.id & 0x3FFFFu;
            const unsigned producer = ((eid >> 11) & 0x60u) | ((sid >> 6) & 0x1Fu);  // [L650]
            const unsigned consumer = ((eid >> 9) & 0x60u) | ((sid >> 1) & 0x1Fu);
            EXPECT_EQ(consumer, 4u);
            EXPECT_EQ(eid & 0x80u, 0u) << "bit 7 of what a device sends is 0 [L528]";
            std::vector<std::uint8_t> all{static_cast<std::uint8_t>(eid & 0xFFu)};
            all.insert(all.end(), f.data().begin(), f.data().end());
            log_.push_back((producer == node_ ? "" : std::to_string(producer) + ":") + text(all));
            stamps_.push_back(f.at);
        }
    }

    std::vector<std::unique_ptr<Twin>> drives_;
    Instant now_ = time_zero + std::chrono::seconds(1);
    unsigned node_ = 5;
    Lines log_;
    std::vector<Instant> stamps_;
};

}  // namespace axisgate::uim342::test
