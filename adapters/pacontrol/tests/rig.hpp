// Rig: the adapter against the embedded control on a line with honest wire time (9600 baud 7N1), both as they are, in virtual time.
// In: commands, instants, the tester's hand. Out: what crossed the line and when, results, feedback.
// Never looks inside the adapter; the control's own axes can be looked at, for the truth.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "adapters/pacontrol/adapter.hpp"
#include "adapters/pacontrol/twin/device.hpp"
#include "adapters/pacontrol/twin/twin.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::pacontrol::test {

using namespace std::chrono_literals;

inline constexpr std::uint32_t baud = 9600;
inline constexpr std::uint8_t bits = 9;

/// One axisgate side of the line, one control at the other end.
class Rig : public LineEvents {
public:
    explicit Rig(int axes, std::map<std::string, std::string> model = {}, const Catalogue& catalogue = empty())
        : catalogue_(catalogue), bus_({LineKind::bytes, baud, bits, true}) {
        LineSetup line;
        line.id = LineId{0};
        line.name = "com1";
        line.bit_rate = baud;
        line.bits_per_byte = bits;
        DriveSetup d;
        d.id = DriveId{0};
        d.name = "portal";
        d.address = "com1";
        for (int i = 0; i < axes; ++i)
            d.axes.push_back({AxisId{static_cast<std::uint16_t>(i)}, i + 1});
        line.drives.push_back(d);
        TwinSetup t;
        t.address = "com1";
        t.axes = axes;
        t.bit_rate = baud;
        t.options = std::move(model);
        bus_.add(DriveId{0}, twin::make_twin(catalogue_, t), {}, now);
        call([&](Out& out) { adapter_.configure(line, now, out); });
        bus_.open(*this, now);
        run(2s);
    }
    void on_frame(const Frame& f) override {
        now = std::max(now, f.at);
        received += f.size;
        if (f.data().back() == 0x04) answers.push_back(f.at);
        call([&](Out& out) { adapter_.on_frame(f, now, out); });
    }
    void on_line_state(bool up, const std::string&) override {
        call([&](Out& out) { adapter_.on_line(up, now, out); });
    }
    void on_sent(const Frame& f) override { transmitted += f.size; }

    Ticket command(CommandBody body, int axis, bool until_done = false) {
        Command c;
        c.until_done = until_done;
        c.ticket = ++tickets_;
        c.axis = AxisId{static_cast<std::uint16_t>(axis)};
        c.body = std::move(body);
        call([&](Out& out) { adapter_.on_command(c, now, out); });
        return c.ticket;
    }
    Outcome ask(CommandBody body, int axis) {
        const Ticket t = command(std::move(body), axis);
        for (const Instant end = now + 30s; !results.contains(t) && now < end;)
            step(end);
        EXPECT_TRUE(results.contains(t));
        if (results.contains(t) && results[t].outcome != Outcome::accepted) ADD_FAILURE() << results[t].text;
        return results.contains(t) ? results[t].outcome : Outcome::failed;
    }
    Result answer(Ticket t) {
        for (const Instant end = now + 30s; !results.contains(t) && now < end;)
            step(end);
        EXPECT_TRUE(results.contains(t));
        return results[t];
    }
    void hand(const std::string& name, const Value& value) { EXPECT_EQ(bus_.set_hand(DriveId{0}, name, value, now), ""); }
    [[nodiscard]] std::string notice_of(const std::string& kind) const {
        for (auto it = notices.rbegin(); it != notices.rend(); ++it) {
            if (it->kind == kind) return it->text;
        }
        return {};
    }
    /// The control's own axis, 0 is the first.
    const twin::Axis& axis(int n) { return static_cast<twin::Device&>(*bus_.twin(DriveId{0})).control().axis(n + 1); }
    void run(Duration d) {
        for (const Instant end = now + d; now < end;)
            step(end);
    }
    /// Enabled, and all axes under way for the next half minute.
    void move_all(int axes) {
        for (int i = 0; i < axes; ++i)
            ASSERT_EQ(ask(Enable{}, i), Outcome::accepted);
        for (int i = 0; i < axes; ++i) {
            Move m;
            m.target = 400'000;
            m.velocity = 10'000;
            ASSERT_EQ(ask(m, i), Outcome::accepted);
        }
    }

    struct Handed {
        Instant at;
        std::string text;
    };
    Instant now = time_zero + 1s;
    std::vector<Handed> handed;  ///< what the adapter gave to the line, as text without SOH STX
    std::map<Ticket, Result> results;
    std::map<AxisId, std::set<std::int64_t>> positions;
    std::map<AxisId, AxisFeedback> feedback;
    std::vector<std::pair<AxisId, AxisFeedback>> history;
    std::vector<Notice> notices;
    std::size_t transmitted = 0, received = 0;
    std::vector<Instant> answers;  ///< when the last byte of each acknowledgement came

private:
    template <class F>
    void call(F&& f) {
        Out out;
        f(out);
        for (const auto& tx : out.frames) {
            const auto b = tx.frame.data();
            handed.push_back({now, b.size() > 2 ? std::string(b.begin() + 2, b.end()) : "EOT"});
            EXPECT_TRUE(bus_.send(tx.frame, tx.priority, now));
        }
        for (const auto& r : out.results)
            results[r.ticket] = r;
        for (const auto& x : out.feedback) {
            positions[x.axis].insert(x.value.position);
            feedback[x.axis] = x.value;
            history.emplace_back(x.axis, x.value);
        }
        notices.insert(notices.end(), out.notices.begin(), out.notices.end());
    }
    void step(Instant end) {
        const Instant next = std::min({end, adapter_.deadline(), bus_.deadline()});
        now = std::max(now, next);
        if (bus_.deadline() <= now) {
            bus_.on_deadline(now);
        } else if (adapter_.deadline() <= now) {
            call([&](Out& out) { adapter_.on_deadline(now, out); });
        }
    }

    static const Catalogue& empty() {
        static const Catalogue c;
        return c;
    }
    const Catalogue& catalogue_;
    LineAdapter adapter_{catalogue_, LineKind::bytes};
    TwinBus bus_;
    Ticket tickets_ = 0;
};

}  // namespace axisgate::pacontrol::test
