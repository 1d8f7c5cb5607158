// The command table of a simulated drive: linked entries, waits, variables, branches.
// In: entries of 64 bytes, conditions. Out: motion commands one after the other. Never more than one sequence; an entry takes a cycle.
#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {
namespace {
constexpr int most_starts = 16;  ///< entries that start one another at one instant; the next one waits a cycle, as one that is linked does
}

/// Offsets in an entry: 0 version, 2 linked entry (FFFFh: none), 4 header, 6 parameters.
void Drive::start_entry(std::uint16_t id, Instant now) {
    const auto it = table.find(id);
    if (it == table.end() || (setup_.series == Series::b1100 && id > 31)) {
        end_table();
        return raise(0x8A, now);
    }
    entry_ = id;
    waiting_ = 0;
    branch_ = 0;
    wait_until_ = never;
    Bytes b{};
    for (std::size_t i = 0; i < b.size() && i + 4 < it->second.size(); ++i)
        b[i] = it->second[i + 4];
    const std::uint16_t running = entry_;
    ++starts_;
    execute(at16(b, 0), b, true, now);
    --starts_;
    if (entry_ == running) step_at_ = now + cycle;
}

void Drive::step_table(Instant now) {
    const auto it = table.find(entry_);
    waiting_ = 0;
    if (it == table.end()) return end_table();
    std::uint16_t next = static_cast<std::uint16_t>(it->second[2] | it->second[3] << 8);
    if (branch_ != 0) next = branch_;
    if (next == 0 || next == 0xFFFF || state_ != operation_enabled) return end_table();
    start_entry(next, now);
}

bool Drive::wait_over(Instant now) {
    if (entry_ == 0) return false;
    switch (waiting_) {
        case 0:
            return now >= step_at_;
        case 0x2110:
            return !motion_active();
        case 0x2120:
            return in_target();
        case 0x2130:
        case 0x2140:
            return wait_edge_;
        case 0x2100:
        case 0x2180:
        case 0x2190:
            return now >= wait_until_;
        default:
            break;
    }
    const auto sub = static_cast<std::uint8_t>(waiting_ >> 4 & 0x0F);
    const auto value = watched(sub);
    if (!value) return true;
    const double level = sub >= 0x0E ? signed16(wait_bytes_, 2) : signed32(wait_bytes_, 2);
    return (sub & 1) == 0 ? *value > level : *value < level;
}

/// What the waits 22xh and the branches 258h..25Fh look at, by the pair of sub IDs of 22h.
std::optional<double> Drive::watched(std::uint8_t sub) const {
    const Point d = demand_at(now_), a = actual_at(now_);
    switch (sub / 2) {
        case 0:
            return d.position;
        case 1:
            return a.position + offset_;
        case 2:
            return d.position - (a.position + offset_);
        case 3:
            return std::fabs(d.position - (a.position + offset_));
        case 4:
            return d.velocity / 10;  // 1e-6 m/s
        case 5:
            return a.velocity / 10;
        case 7:
            return static_cast<double>(outside_.current);
        default:
            return std::nullopt;
    }
}

void Drive::table_command(std::uint16_t header, const Bytes& b, bool from_table, Instant now) {
    const auto master = static_cast<std::uint8_t>(header >> 8);
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    const auto add = [&](std::uint16_t upid, std::uint32_t v) { memory.set_ram(upid, memory.ram(upid) + v); };  // wraps (choice O-17)
    const auto branch = [&](bool holds, std::size_t at) {
        const std::uint16_t to = at16(b, holds ? at : at + 2);
        if (from_table)
            branch_ = to;
        else
            start_entry(to, now);  // sent directly: the chosen entry starts (choice O-16)
    };
    switch (master) {
        case 0x20:
            if (sub == 0 && starts_ < most_starts) return start_entry(at16(b, 2), now);
            if (sub == 0) {  // an entry may start itself: it does so for ever, a round per cycle
                branch_ = at16(b, 2);
                return;
            }
            if (sub <= 2) {
                event_ = {};
                event_.kind = sub == 1 ? Event::Kind::rising : Event::Kind::falling;
                event_.what = Event::What::table;
                event_.order.value = at16(b, 2);
                return;
            }
            if (const auto it = table.find(at16(b, 2)); it != table.end()) {
                const std::size_t at = at16(b, 4), n = sub == 8 ? 2 : 4;
                for (std::size_t i = 0; i < n && at + i < it->second.size(); ++i)
                    it->second[at + i] = b[6 + i];
            } else {
                raise(0x8A, now);
            }
            return;
        case 0x21:
        case 0x22:
            if (!from_table) return;  // sent directly, a wait has no effect (choice O-16)
            waiting_ = header & 0xFFF0;
            wait_bytes_ = b;
            wait_edge_ = false;
            wait_until_ = never;
            if (master == 0x21 && (sub == 0 || sub >= 8)) {
                const double ticks = sub == 0 ? at32(b, 2) : std::max(0.0, memory.number(sub == 8 ? 0x1E72 : 0x1E73));
                wait_until_ = now + Duration{static_cast<std::int64_t>(ticks * 100'000)};
            }
            return;
        case 0x24:
            switch (sub) {
                case 0:
                    return memory.set_ram(0x1E72, at32(b, 2));
                case 1:
                    return add(0x1E72, at32(b, 2));
                case 2:
                    return memory.set_ram(0x1E73, at32(b, 2));
                case 3:
                    return add(0x1E73, at32(b, 2));
                case 8:
                case 9:
                    if (const auto* f = memory.facts(at16(b, 2)); f && f->live())
                        memory.set_ram(at16(b, 2), memory.ram(sub == 8 ? 0x1E72 : 0x1E73));
                    return;
                case 0x0C:
                    return memory.set_ram(0x1E72, ram(at16(b, 2)));
                case 0x0D:
                    return memory.set_ram(0x1E73, ram(at16(b, 2)));
                default:
                    if (const auto* f = memory.facts(at16(b, 2)); f && f->writable_rom())
                        return memory.set_rom(at16(b, 2), memory.ram(at16(b, 2)));
                    return raise(0x58, now);
            }
        case 0x25: {
            const double var = memory.number((sub == 0 || sub == 1 || sub == 6) ? 0x1E72 : 0x1E73);
            if (sub <= 3) return branch((sub & 1) == 0 ? var < signed32(b, 2) : var > signed32(b, 2), 6);
            if (sub <= 7) return branch(var < static_cast<double>(static_cast<std::int32_t>(ram(at16(b, 2)))), 4);
            const auto value = watched(static_cast<std::uint8_t>(sub < 0x0E ? (sub - 8) / 2 * 2 : 0x0E)).value_or(0);
            return branch((sub & 1) == 0 ? value < signed32(b, 2) : value > signed32(b, 2), 6);
        }
        case 0x26: {
            if (sub == 0) return branch(static_cast<double>(outside_.analog) < signed32(b, 2), 6);
            const std::uint16_t word = sub == 2 ? outside_.x4_inputs : sub == 3 ? std::uint16_t{0} : sub == 4 ? status_word() : warn_word();
            return branch((word & at16(b, 2)) == at16(b, 4), 6);
        }
        default:
            return;
    }
}

}  // namespace axisgate::linmot::twin
