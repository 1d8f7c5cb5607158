// The adapter on a simulated line with twins, in virtual time. It collects results, feedback, notices and links.
#pragma once

#include <gtest/gtest.h>

#include <map>

#include "adapters/linmot/adapter.hpp"
#include "adapters/linmot/tests/page.hpp"
#include "adapters/linmot/tests/vectors.hpp"
#include "adapters/linmot/twin/device.hpp"
#include "adapters/linmot/twin/twin.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::linmot::test {
using namespace std::chrono_literals;

class LineBench final : private LineEvents {
public:
    LineSetup setup;
    Instant now = at_ns(1'000'000'000);
    std::unique_ptr<TwinBus> bus;
    std::unique_ptr<LineAdapter> adapter = std::make_unique<LineAdapter>(page());
    std::map<Ticket, std::vector<Result>> results;
    std::map<AxisId, AxisFeedback> feedback;
    std::vector<Notice> notices;
    std::map<DriveId, DriveLink> links;
    std::vector<Sample> samples;
    std::vector<Out::StreamEnd> stream_ends;
    std::vector<Frame> sent;  ///< by the adapter, since the test has cleared it
    std::uint64_t answers = 0;

    explicit LineBench(std::size_t drives = 1, std::uint32_t bit_rate = 115200, std::map<std::string, std::string> options = {},
                       LineTiming timing = {}, std::map<std::string, std::string> line_options = {}) {
        TwinBusOptions o;
        o.bit_rate = bit_rate;
        bus = std::make_unique<TwinBus>(o);
        setup.id = LineId{0};
        setup.name = "line";
        setup.bit_rate = bit_rate;
        setup.timing = timing;
        setup.options = std::move(line_options);
        for (std::size_t i = 0; i < drives; ++i) {
            DriveSetup d;
            d.id = DriveId{static_cast<std::uint16_t>(i)};
            d.name = "d" + std::to_string(i + 1);
            d.address = std::to_string(17 + i);
            d.axes = {{AxisId{static_cast<std::uint16_t>(i)}, 1}};
            d.options = options;
            setup.drives.push_back(d);
            TwinSetup t;
            t.address = d.address;
            t.options = setup.options;
            for (const auto& [k, v] : options)
                t.options[k] = v;
            t.freedoms = freedoms_of(page(), t.options);
            bus->add(d.id, twin::make_twin(page(), t), {}, now);
        }
        Out out;
        adapter->configure(setup, now, out);
        take(out);
        bus->open(*this, now);
    }
    ~LineBench() override { bus->close(); }

    twin::Drive& drive(std::size_t i = 0) { return static_cast<twin::Device*>(bus->twin(DriveId{static_cast<std::uint16_t>(i)}))->drive(); }
    std::string hand(const std::string& name, const Value& v, std::size_t i = 0) {
        return bus->set_hand(DriveId{static_cast<std::uint16_t>(i)}, name, v, now);
    }

    void run(Duration d) {
        const Instant end = now + d;
        for (;;) {
            const Instant at = std::min(bus->deadline(), adapter->deadline());
            if (at > end) break;
            now = std::max(now, at);
            if (bus->deadline() <= now) bus->on_deadline(now);
            if (adapter->deadline() <= now) {
                Out out;
                adapter->on_deadline(now, out);
                take(out);
            }
        }
        now = end;
    }
    Ticket submit(CommandBody body, std::size_t axis = 0) {
        Command c;
        c.ticket = ++tickets_;
        c.axis = AxisId{static_cast<std::uint16_t>(axis)};
        c.body = std::move(body);
        Out out;
        const Ticket t = c.ticket;
        adapter->on_command(c, now, out);
        take(out);
        return t;
    }
    /// A streamed position set-point.
    void stream(std::int64_t place, std::optional<std::int64_t> velocity = {}, std::optional<std::int64_t> ramp = {}) {
        SetPoint p;
        p.axis = AxisId{0};
        p.value = place;
        p.velocity = velocity;
        p.acceleration = p.deceleration = ramp;
        p.at = now;
        Out out;
        adapter->on_set_point(p, now, out);
        take(out);
    }
    /// Waits for the result of one command.
    Result ask(CommandBody body, std::size_t axis = 0, Duration limit = 15s) {
        const Ticket t = submit(std::move(body), axis);
        const Instant end = now + limit;
        while (results[t].empty() && now < end)
            run(1ms);
        EXPECT_EQ(results[t].size(), 1u);
        return results[t].empty() ? Result{} : results[t][0];
    }
    Result act(const std::string& name, const boost::json::object& arguments = {}, std::size_t axis = 0);
    const AxisFeedback& axis(std::size_t i = 0) { return feedback[AxisId{static_cast<std::uint16_t>(i)}]; }
    bool enable(std::size_t i = 0) { return good(ask(Enable{}, i)); }

private:
    void take(const Out& out) {
        for (const auto& f : out.frames)
            sent.push_back(f.frame), (void)bus->send(f.frame, f.priority, now);
        for (const auto& f : out.feedback)
            feedback[f.axis] = f.value;
        for (const auto& r : out.results)
            results[r.ticket].push_back(r);
        for (const auto& l : out.links)
            links[l.drive] = l;
        notices.insert(notices.end(), out.notices.begin(), out.notices.end());
        samples.insert(samples.end(), out.samples.begin(), out.samples.end());
        stream_ends.insert(stream_ends.end(), out.stream_ends.begin(), out.stream_ends.end());
    }
    void on_frame(const Frame& frame) override {
        ++answers;
        now = std::max(now, frame.at);
        Out out;
        adapter->on_frame(frame, now, out);
        take(out);
    }
    void on_line_state(bool up, const std::string&) override {
        Out out;
        adapter->on_line(up, now, out);
        take(out);
    }
    void on_sent(const Frame&) override {}
    std::uint64_t tickets_ = 0;
};

}  // namespace axisgate::linmot::test
