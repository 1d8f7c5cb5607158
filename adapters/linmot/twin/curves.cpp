// Time curves of a simulated drive, and the commands that change curves in its RAM.
// In: info and data blocks, offsets, scales. Out: a demand that runs through the points. Never plays a curve that is not defined.
#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {
namespace {
constexpr std::size_t most_block = 64 * 1024;  ///< bytes of one curve's data block
}  // namespace

void Drive::curve_command(std::uint16_t header, const Bytes& b, Instant now) {
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    if (header >> 8 == 0x05) return modify_curve(sub, b, now);
    const bool on_trigger = sub == 6 || sub == 7 || sub >= 0x0A;
    if (!on_trigger) return start_curve(sub, b, now);
    event_ = {};
    event_.kind = sub == 6 || sub == 0x0A || sub == 0x0E ? Event::Kind::rising : Event::Kind::falling;
    event_.what = Event::What::curve;
    event_.order.sub = sub <= 7 ? 5 : sub <= 0x0C ? 2 : 3;
    event_.bytes = b;
}

/// 040 defaults, 041 from the set point, 042 to a position, 043 the same in a time, 044 scales, 045 time and amplitude [L1511-1614].
void Drive::start_curve(std::uint8_t sub, const Bytes& b, Instant now) {
    const std::uint16_t id = at16(b, 2);
    const auto it = curves.find(id);
    if (it == curves.end() || it->second.points() < 2) return raise(0x62, now);
    const Curve& c = it->second;
    const Point here = demand_at(now);
    const double first = c.point(0), last = c.point(c.points() - 1);
    Play p;
    p.active = true;
    p.curve = id;
    p.begun = now;
    p.seconds = c.x_length() * 1e-5;
    switch (sub) {
        case 0:
            break;
        case 1:
            p.offset = here.position - first;
            break;
        case 2:
        case 3: {
            const double span = last - first;
            if (span == 0) return raise(0x89, now);
            p.scale = (signed32(b, 4) - here.position) / span;
            p.offset = here.position - first * p.scale;
            if (std::fabs(p.scale) > 20) return raise(0x89, now);  // -2000..2000 % [L1545-1547]
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
    stop_play(now);
    streaming_ = false;
    play_ = p;
}

void Drive::modify_curve(std::uint8_t sub, const Bytes& b, Instant now) {
    const std::uint16_t id = at16(b, 2);
    if (id < 1 || id > 100) return raise(0x62, now);
    if (sub == 0) {
        if (at16(b, 4) == 0x0FFF)
            curves.erase(id);  // not defined (E-22)
        else
            curves.try_emplace(id);
        return;
    }
    const auto it = curves.find(id);
    if (it == curves.end()) return raise(0x62, now);
    auto& block = sub <= 2 ? it->second.info : it->second.data;
    const std::size_t at = at16(b, 4), n = sub == 1 ? 2 : sub == 2 || sub == 4 ? 4 : sub == 5 ? 8 : 12;
    if (at + n > most_block) return;  // wrong offsets are not caught [L1777-1780]; the model's memory ends here
    if (block.size() < at + n) block.resize(at + n);
    std::copy_n(b.begin() + 6, n, block.begin() + static_cast<std::ptrdiff_t>(at));
}

}  // namespace axisgate::linmot::twin
