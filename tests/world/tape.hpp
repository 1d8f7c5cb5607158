// Tape keeps both logs of a world's recorder and replays them; Tellings counts how often its axes reported. No record is lost; bounds apply
// only in tests of bounds.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/engine/replay.hpp"
#include "tests/world/world.hpp"

namespace axisgate::test {

/// Both logs of a recorder, as bytes.
struct Tape : FlightTap {
    FlightLog inputs{64u << 20, false};
    FlightLog window;
    explicit Tape(std::size_t window_bytes = 64u << 20) : window(window_bytes, true) {}
    static std::string joined(const FlightLog& log) {
        std::string all;
        for (const auto& c : log.chunks())
            all += c->bytes;
        return all;
    }
    ReplayReport play(std::string_view changed_inputs = {}) const {
        const std::string in = changed_inputs.empty() ? joined(inputs) : std::string(changed_inputs), out = joined(window);
        return replay(families(), {in, out, window.gone_outcomes()});
    }

protected:
    void take(const FlightRecord& r) override {
        window.add(r);
        if (is_input(r.kind)) inputs.add(r);
    }
    void take_site(std::shared_ptr<const SiteInput> input, Instant now) override {
        const std::string packed = pack_site(*input);
        take({FlightKind::site, 0xFFFF, now, packed});
    }
};

/// How often each axis reported, by the age of its data.
struct Tellings final : Tape {
    std::map<AxisId, std::uint64_t> published;
    std::map<AxisId, Instant> last;

private:
    void take(const FlightRecord& r) override {
        Tape::take(r);
        if (r.kind != FlightKind::picture) return;
        const auto p = unpack<PictureRecord>(r.payload);
        const AxisId axis{r.index};
        if (!p || !p->current || r.at - p->age == last[axis]) return;
        last[axis] = r.at - p->age;
        ++published[axis];
    }
};

}  // namespace axisgate::test
