// The bench with a drive that uses the freedoms of the page, and what it shows of the control words.
#pragma once

#include <algorithm>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "adapters/cia402/tests/line_bench.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::cia402_drive::test {
using Options = std::map<std::string, std::string>;

struct Manners : LineBench {
    std::vector<std::uint16_t> words;  ///< control words that were sent to the drive
    int pre_operational = 0, started = 0;

    explicit Manners(const Options& of_twin = {}, Options of_drive = {}) : LineBench(page(), 1, std::move(of_drive)) {
        TwinSetup t;
        t.address = "5";
        t.kind = LineKind::can;
        t.freedoms = freedoms_of(page(), of_twin);
        // No freedom of this page: with slow SDO answers of the twin's own, this makes its PDOs alone late.
        if (const auto late = of_twin.find("reply_ms"); late != of_twin.end()) t.freedoms["reply_ms"] = std::stoll(late->second);
        bus->add(DriveId{0}, with_common_freedoms(twin::make_twin(t, nullptr, page().freedoms()), t), {}, now);
        crossed = [this](const Frame& f) { note(f); };
        open();
    }
    void note(const Frame& f) {
        const auto d = f.data();
        if (f.id == 0x605 && d.size() == 8 && d[0] >> 5 == 1 && d[1] == 0x40 && d[2] == 0x60)
            words.push_back(static_cast<std::uint16_t>(d[4] | d[5] << 8));
        if (f.id == 0 && d.size() == 2 && d[1] == 5) ++(d[0] == 128 ? pre_operational : started);
    }
    void be(const char* freedom, std::int64_t value) { ASSERT_EQ(bus->set_hand(DriveId{0}, freedom, Value{value}, now), ""); }
    /// Another gateway on the same bus, without any knowledge of the first one.
    void restart_gateway() {
        adapter.~LineAdapter();
        new (&adapter) LineAdapter(page());
        Out out;
        adapter.configure(setup, now, out);
        adapter.on_line(true, now, out);
        forward(out);
    }
    void forward(const Out& out) {
        for (const auto& f : out.frames)
            (void)bus->send(f.frame, f.priority, now);
    }
    /// Another master on the bus.
    void others(const Frame& f) { (void)bus->send(f, Priority::command, now); }
    [[nodiscard]] double place() { return bus->twin(DriveId{0})->mechanics(1, now).position; }
    Result line(std::string_view text) {
        Native n;
        n.send.assign(text.begin(), text.end());
        return ask(std::move(n));
    }
};
inline Move speed(std::int64_t target) {
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = target;
    m.acceleration = m.deceleration = 50'000;
    return m;
}
inline SetPoint led_to(std::int64_t value, std::int64_t velocity) {
    SetPoint p;
    p.axis = AxisId{0};
    p.value = value;
    p.velocity = velocity;
    p.acceleration = p.deceleration = 1'000'000;
    return p;
}

}  // namespace axisgate::cia402_drive::test
