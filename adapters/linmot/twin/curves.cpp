#include "adapters/linmot/twin/curves.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"

namespace axisgate::linmot::twin {
namespace {
constexpr std::size_t most_block = 64 * 1024;  ///< bytes of a curve's data block
}  // namespace

const Curve* curve_of(const Curves& curves, std::uint16_t id) {
    const auto it = curves.find(id);
    return it == curves.end() || it->second.points() < 2 ? nullptr : &it->second;
}

Instant Play::end() const noexcept { return begun + span_ms(seconds * 1000); }

std::optional<Point> Play::at(const Curves& curves, Instant now) const {
    const Curve* c = curve_of(curves, curve);
    if (!c || seconds <= 0) return std::nullopt;
    const Followed f = c->at(axisgate::seconds(now - begun) / seconds);
    return Point{offset + scale * f.position, scale * f.slope / seconds};
}

/// 040 defaults, 041 from the set-point, 042 to a position, 043 to a position in a given time, 044 scales, 045 time and amplitude
/// [L1511-1614].
Fault lay(Play& play, const Curves& curves, std::uint8_t sub, const Bytes& b, double here, Instant now) {
    Play p;
    p.active = true;
    p.curve = at16(b, 2);
    const Curve* c = curve_of(curves, p.curve);
    if (!c) return 0x62;
    p.begun = now;
    p.seconds = c->x_length() * 1e-5;
    switch (sub) {
        case 0:
            break;
        case 1:
            p.offset = here - c->first();
            break;
        case 2:
        case 3: {
            const double span = c->last() - c->first();
            if (span == 0) return 0x89;
            p.scale = (signed32(b, 4) - here) / span;
            p.offset = here - c->first() * p.scale;
            if (std::fabs(p.scale) > 20) return 0x89;  // -2000..2000 % [L1545-1547]
            if (sub == 3) p.seconds = signed32(b, 8) * 1e-5;
            break;
        }
        case 4:
            p.offset = signed32(b, 4);
            p.seconds *= at16(b, 8) / 10'000.0;
            p.scale = signed16(b, 10) / 1000;
            break;
        default:
            p.offset = signed32(b, 4);
            p.seconds = signed32(b, 8) * 1e-5;
            p.scale = signed16(b, 12) / 1000;
            break;
    }
    p.seconds = std::max(p.seconds, 1e-4);
    play = p;
    return 0;
}

Fault modify(Curves& curves, std::uint8_t sub, const Bytes& b) {
    const std::uint16_t id = at16(b, 2);
    if (id < 1 || id > 100) return 0x62;
    if (sub == 0) {
        if (at16(b, 4) == 0x0FFF)
            curves.erase(id);  // not defined (E-22)
        else
            curves.try_emplace(id);
        return 0;
    }
    const auto it = curves.find(id);
    if (it == curves.end()) return 0x62;
    auto& block = sub <= 2 ? it->second.info : it->second.data;
    const std::size_t at = at16(b, 4), n = sub == 1 ? 2 : sub == 2 || sub == 4 ? 4 : sub == 5 ? 8 : 12;
    if (at + n > most_block) return 0;  // the drive does not detect wrong offsets [L1777-1780]; the memory of the model ends here
    if (block.size() < at + n) block.resize(at + n);
    std::copy_n(b.begin() + 6, n, block.begin() + static_cast<std::ptrdiff_t>(at));
    return 0;
}

}  // namespace axisgate::linmot::twin
