// Line bench: the adapter and real twins on a TwinBus, in virtual time: every byte takes its time on the wire, both ways.
// In: drives, a rate, commands, and what a bad cable does to the bytes on their way to the gateway. Out: feedback, results, what was
// sent and when. Never reaches round the wire, but to move a shaft by hand.
#pragma once

#include <functional>

#include "adapters/mcode/tests/fake_drive.hpp"
#include "adapters/mcode/twin/twin.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::mcode::test {

struct LineBench : LineEvents, BenchCommands<LineBench> {
    struct Sent {
        Instant at;
        std::string bytes;
    };
    LineAdapter adapter{catalogue()};
    std::unique_ptr<TwinBus> bus;
    LineSetup setup;
    Instant now = at_ns(1'000'000'000);
    Out out;
    std::vector<Sent> sent, late;
    std::uint64_t bytes_out = 0, bytes_in = 0, replies = 0;
    std::vector<Notice> notices;
    std::map<AxisId, AxisFeedback> feedback;
    std::map<AxisId, Instant> seen;
    std::map<AxisId, Duration> longest_gap;
    std::map<AxisId, std::int64_t> place;  ///< where the shaft is: another position in a feedback is another drive's
    int wrong = 0;
    bool echo = false;                                 ///< a converter that gives the gateway its own bytes back
    std::function<std::string(std::string)> on_cable;  ///< what becomes of bytes to the gateway
    std::function<std::string(std::string)> on_way;    ///< what becomes of bytes to the drives
    Duration hold{};                                   ///< they come so much later
    std::function<void(AxisId, const AxisFeedback&)> on_feedback;

    explicit LineBench(std::string_view names, std::uint32_t rate, std::map<std::string, std::string> options = {},
                       std::string_view twins = {}) {
        const bool single = names == "!";
        bus = std::make_unique<TwinBus>(TwinBusOptions{LineKind::bytes, rate, 10, single});
        setup.id = LineId{0};
        setup.bit_rate = rate;
        setup.options = options;
        for (std::size_t i = 0; i < names.size(); ++i) {
            DriveSetup d;
            d.id = DriveId{static_cast<std::uint16_t>(i)};
            d.name = "d" + std::to_string(i);
            d.address = std::string(1, names[i]);
            d.axes.push_back({AxisId{static_cast<std::uint16_t>(i)}, 1});
            setup.drives.push_back(d);
        }
        if (twins.empty()) twins = names;
        for (std::size_t i = 0; i < twins.size(); ++i) {
            TwinSetup t;
            t.address = std::string(1, twins[i]);
            t.bit_rate = rate;
            t.options = options;
            t.freedoms = freedoms_of(catalogue(), options);
            const DriveId key{static_cast<std::uint16_t>(i)};
            bus->add(key, make_twin(catalogue(), t), {}, now);
        }
        bus->open(*this, now);
        adapter.configure(setup, now, out);
        drain();
    }
    /// Gives a drive a position of its own, to be told from the others'.
    void put(std::size_t drive, std::int64_t position) {
        EXPECT_EQ(wait(SetPosition{position}, drive).outcome, Outcome::done);
        run(1s);
        EXPECT_EQ(feedback[AxisId{static_cast<std::uint16_t>(drive)}].position, position);
    }
    /// From now on a feedback of this axis with another position counts as `wrong`.
    void expect(std::size_t drive) {
        place[AxisId{static_cast<std::uint16_t>(drive)}] = feedback[AxisId{static_cast<std::uint16_t>(drive)}].position;
    }
    void hand(std::size_t drive, const std::string& name, const Value& v) {
        EXPECT_EQ(bus->set_hand(DriveId{static_cast<std::uint16_t>(drive)}, name, v, now), "") << name;
    }

    void on_frame(const Frame& f) override {
        now = std::max(now, f.at);
        std::string bytes(reinterpret_cast<const char*>(f.data().data()), f.size);
        bytes_in += f.size;
        if (on_cable) bytes = on_cable(std::move(bytes));
        if (hold > Duration::zero())
            late.push_back({now + hold, bytes});
        else
            receive(bytes);
    }
    void on_line_state(bool up, const std::string&) override { adapter.on_line(up, now, out); }
    void on_sent(const Frame& f) override {
        now = std::max(now, f.at);
        bytes_out += f.size;
        if (echo) receive(std::string(reinterpret_cast<const char*>(f.data().data()), f.size));
    }
    void receive(const std::string& bytes) {
        if (bytes.empty()) return;
        for_each_run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, [&](Frame f) {
            f.at = now;
            adapter.on_frame(f, now, out);
        });
    }
    void drain() {
        for (const auto& f : out.feedback) {
            feedback[f.axis] = f.value;
            if (on_feedback) on_feedback(f.axis, f.value);
            if (const auto it = place.find(f.axis); it != place.end() && f.value.position != it->second) ++wrong;
            if (seen.contains(f.axis)) longest_gap[f.axis] = std::max(longest_gap[f.axis], now - seen[f.axis]);
            seen[f.axis] = now;
        }
        results.insert(results.end(), out.results.begin(), out.results.end());
        links.insert(links.end(), out.links.begin(), out.links.end());
        notices.insert(notices.end(), out.notices.begin(), out.notices.end());
        auto frames = std::move(out.frames);
        out.clear();
        for (const auto& tx : frames) {
            const std::string bytes(reinterpret_cast<const char*>(tx.frame.data().data()), tx.frame.size);
            sent.push_back({now, bytes});
            if (!on_way) {
                EXPECT_TRUE(bus->send(tx.frame, tx.priority, now));
                continue;
            }
            const std::string rest = on_way(bytes);
            if (rest.empty()) continue;
            EXPECT_TRUE(bus->send(Frame::run({reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()}), tx.priority, now));
        }
    }
    void run(Duration d) {
        const Instant end = now + d;
        for (int guard = 0; guard < 2'000'000; ++guard) {
            Instant due = std::min(adapter.deadline(), bus->deadline());
            if (!late.empty()) due = std::min(due, late.front().at);
            if (due > end) break;
            now = std::max(now, due);
            if (bus->deadline() <= now) {
                bus->on_deadline(now);
            } else if (!late.empty() && late.front().at <= now) {
                const std::string bytes = late.front().bytes;
                late.erase(late.begin());
                receive(bytes);
            } else {
                adapter.on_deadline(now, out);
            }
            drain();
        }
        now = end;
    }
};

/// A line of a program, as a native command.
inline Native line(std::string_view s) { return {{s.begin(), s.end()}, true}; }

}  // namespace axisgate::mcode::test
