// The adapter on a simulated CAN bus with simulated nodes, in virtual time. Tests give commands and add frames of their own, and read
// results, feedback and notices.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "adapters/cia402/adapter.hpp"
#include "adapters/cia402/twin/twin.hpp"
#include "gateway/protocols/canopen/message.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::cia402_drive::test {
using namespace std::chrono_literals;

inline const Catalogue& page() {
    static const Catalogue c = [] {
        std::vector<std::string> faults;
        std::ifstream in(AXISGATE_SOURCE_DIR "/schema/families/cia402.json");
        std::stringstream text;
        text << in.rdbuf();
        auto read = Catalogue::parse(text.str(), faults);
        if (!read) std::abort();
        return std::move(*read);
    }();
    return c;
}

class LineBench : private LineEvents {
public:
    Instant now = at_ns(1'000'000'000);
    std::unique_ptr<TwinBus> bus;
    LineSetup setup;
    LineAdapter adapter;
    std::map<Ticket, std::vector<Result>> results;
    AxisFeedback axis;  ///< newest feedback of any axis
    std::map<AxisId, AxisFeedback> of_axis;
    std::vector<AxisFeedback> feedback;
    std::vector<Notice> notices;
    std::vector<Out::StreamEnd> stream_ends;
    DriveLink link;
    std::map<DriveId, DriveLink> of_drive;
    std::function<void(const Frame&)> crossed;  ///< called with each frame of the bus when its last bit was transmitted
    bool deaf = false;                          ///< frames of the gateway do not reach the bus
    unsigned gateway_node = 127;
    int heartbeats = 0;  ///< sent by the gateway under that number

    /// One drive; `twins` simulated nodes with its number are on the bus.
    explicit LineBench(int twins = 1) : LineBench(page(), 1) {
        TwinSetup t;
        t.address = "5";
        t.kind = LineKind::can;
        for (int i = 0; i < twins; ++i)
            bus->add(DriveId{static_cast<std::uint16_t>(i)}, twin::make_twin(t), {}, now);
        open();
    }
    /// A family that is based on this one: its node 5 with `axes` axes. Its twin is added to the bus before `open`.
    LineBench(const Catalogue& catalogue, int axes, std::map<std::string, std::string> options = {}) : adapter(catalogue) {
        TwinBusOptions o;
        o.kind = LineKind::can;
        o.bit_rate = 1'000'000;
        bus = std::make_unique<TwinBus>(o);
        setup.id = LineId{0};
        setup.name = "can0";
        setup.kind = LineKind::can;
        setup.bit_rate = o.bit_rate;
        DriveSetup d;
        d.id = DriveId{0};
        d.name = "servo";
        d.address = "5";
        for (int k = 0; k < axes; ++k)
            d.axes.push_back({AxisId{static_cast<std::uint16_t>(k)}, k + 1});
        d.options = std::move(options);
        setup.drives.push_back(d);
    }
    void open() {
        Out out;
        adapter.configure(setup, now, out);
        take(out);
        bus->open(*this, now);
    }
    ~LineBench() override { bus->close(); }

    void run(Duration d) {
        const Instant end = now + d;
        for (;;) {
            const Instant at = std::min(bus->deadline(), adapter.deadline());
            if (at > end) break;
            now = std::max(now, at);
            if (bus->deadline() <= now) bus->on_deadline(now);
            if (adapter.deadline() > now) continue;
            Out out;
            adapter.on_deadline(now, out);
            take(out);
        }
        now = end;
    }
    /// A frame that no simulated node has sent.
    void inject(const Frame& f) {
        Out out;
        adapter.on_frame(f, now, out);
        take(out);
    }
    /// Applies the changed site.
    void configure() {
        Out out;
        adapter.configure(setup, now, out);
        take(out);
    }
    [[nodiscard]] double speed(int drive = 0) { return bus->twin(DriveId{static_cast<std::uint16_t>(drive)})->mechanics(1, now).velocity; }
    void follow(const SetPoint& p) {
        Out out;
        adapter.on_set_point(p, now, out);
        take(out);
    }
    Result ask(CommandBody body, Duration limit = 10s, int number = 0) {
        Command c;
        c.ticket = ++tickets_;
        c.axis = AxisId{static_cast<std::uint16_t>(number)};
        c.body = std::move(body);
        const Ticket t = c.ticket;
        Out out;
        adapter.on_command(c, now, out);
        take(out);
        for (const Instant end = now + limit; results[t].empty() && now < end;)
            run(1ms);
        EXPECT_EQ(results[t].size(), 1u) << "one command, one result";
        return results[t].empty() ? Result{} : results[t][0];
    }
    [[nodiscard]] std::ptrdiff_t reported(std::string_view kind) const { return std::ranges::count(notices, kind, &Notice::kind); }
    [[nodiscard]] bool enable() { return good(ask(Enable{})); }
    static Move to(std::int64_t target) {
        Move m;
        m.target = target;
        m.velocity = 10'000;
        m.acceleration = m.deceleration = 50'000;
        return m;
    }

private:
    void take(const Out& out) {
        for (const auto& f : out.frames) {
            if (f.frame.id == 0x700u + gateway_node && f.frame.kind == Frame::Kind::can) ++heartbeats;
            if (!deaf) (void)bus->send(f.frame, f.priority, now);
        }
        for (const auto& f : out.feedback)
            feedback.push_back(of_axis[f.axis] = axis = f.value);
        for (const auto& r : out.results)
            results[r.ticket].push_back(r);
        for (const auto& l : out.links)
            of_drive[l.drive] = link = l;
        notices.insert(notices.end(), out.notices.begin(), out.notices.end());
        stream_ends.insert(stream_ends.end(), out.stream_ends.begin(), out.stream_ends.end());
    }
    void on_frame(const Frame& f) override {
        now = std::max(now, f.at);
        if (crossed) crossed(f);
        inject(f);
    }
    void on_line_state(bool up, const std::string&) override {
        Out out;
        adapter.on_line(up, now, out);
        take(out);
    }
    void on_sent(const Frame& f) override {
        if (crossed) crossed(f);
    }
    Ticket tickets_ = 0;
};

}  // namespace axisgate::cia402_drive::test
