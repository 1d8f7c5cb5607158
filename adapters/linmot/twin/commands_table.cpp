// The interpreter, third part: the command table, its variables, waits and branches (motion commands of 20h to 26h). Errors 0058h and
// 008Ah. The number of entries that start each other at one instant is bounded.
#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/commands.hpp"

namespace axisgate::linmot::twin {

void Interpreter::start_entry(std::uint16_t id, Instant now) {
    const auto b = body_.table.begin(id, body_.setup.series == Series::b1100 ? 31 : 0xFFFF);
    if (!b) return states_.raise(0x8A, now);
    execute(at16(*b, 0), *b, true, now);
    body_.table.begun(id, now);
}

void Interpreter::step_table(Instant now) {
    if (!body_.table.runs() || !body_.table.over(watched(now), now)) return;
    const auto to = body_.table.next();
    if (!to) return;
    if (states_.state() != operation_enabled) return body_.table.end();
    start_entry(*to, now);
}

Watched Interpreter::watched(Instant now) const {
    return {body_.demand.at(now), body_.follower.actual(now), static_cast<double>(body_.outside.current), states_.moves(now),
            body_.follower.in_target(now)};
}

Fault Interpreter::table(std::uint16_t header, const Bytes& b, bool from_table, Instant now) {
    const auto master = static_cast<std::uint8_t>(header >> 8);
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    const Memory& memory = body_.memory;
    const auto branch = [&](bool holds, std::size_t at) {
        const std::uint16_t to = at16(b, holds ? at : at + 2);
        if (from_table)
            body_.table.branch(to);
        else
            start_entry(to, now);  // sent directly: the selected entry starts (choice O-16)
        return Fault{0};
    };
    switch (master) {
        case 0x20:
            return entry(sub, b, now);
        case 0x21:
        case 0x22:
            if (from_table) body_.table.wait(header, b, now);  // sent directly, a wait has no effect (choice O-16)
            return 0;
        case 0x24:
            return variable(sub, b);
        case 0x25: {
            const double var = memory.number((sub == 0 || sub == 1 || sub == 6) ? 0x1E72 : 0x1E73);
            if (sub <= 3) return branch((sub & 1) == 0 ? var < signed32(b, 2) : var > signed32(b, 2), 6);
            if (sub <= 7) return branch(var < static_cast<double>(static_cast<std::int32_t>(body_.ram(at16(b, 2)))), 4);
            const auto value = watched(now).value(static_cast<std::uint8_t>(sub < 0x0E ? (sub - 8) / 2 * 2 : 0x0E)).value_or(0);
            return branch((sub & 1) == 0 ? value < signed32(b, 2) : value > signed32(b, 2), 6);
        }
        case 0x26: {
            if (sub == 0) return branch(static_cast<double>(body_.outside.analog) < signed32(b, 2), 6);
            const std::uint16_t word = sub == 2   ? body_.outside.x4_inputs
                                       : sub == 3 ? std::uint16_t{0}
                                       : sub == 4 ? states_.status_word(now)
                                                  : states_.warn_word(now);
            return branch((word & at16(b, 2)) == at16(b, 4), 6);
        }
        default:
            return 0;
    }
}

/// 200 starts an entry, 201 and 202 at an edge; 208 and 209 change one.
Fault Interpreter::entry(std::uint8_t sub, const Bytes& b, Instant now) {
    const std::uint16_t id = at16(b, 2);
    if (sub == 0) {
        if (body_.table.may_start())
            start_entry(id, now);
        else  // an entry may start itself: it then runs for ever, once per cycle
            body_.table.branch(id);
        return 0;
    }
    if (sub <= 2) return arm(sub == 1 ? Armed::Kind::rising : Armed::Kind::falling, Armed::What::table, 0, b), Fault{0};
    return body_.table.change(id, at16(b, 4), std::span(b).subspan(6, sub == 8 ? 2 : 4)) ? 0 : 0x8A;
}

Fault Interpreter::variable(std::uint8_t sub, const Bytes& b) {
    Memory& memory = body_.memory;
    const auto add = [&](std::uint16_t upid, std::uint32_t v) { memory.set_ram(upid, memory.ram(upid) + v); };  // wraps (choice O-17)
    const auto* facts = memory.facts(at16(b, 2));
    switch (sub) {
        case 0:
            return memory.set_ram(0x1E72, at32(b, 2)), Fault{0};
        case 1:
            return add(0x1E72, at32(b, 2)), Fault{0};
        case 2:
            return memory.set_ram(0x1E73, at32(b, 2)), Fault{0};
        case 3:
            return add(0x1E73, at32(b, 2)), Fault{0};
        case 8:
        case 9:
            if (facts && facts->live()) memory.set_ram(at16(b, 2), memory.ram(sub == 8 ? 0x1E72 : 0x1E73));
            return 0;
        case 0x0C:
            return memory.set_ram(0x1E72, body_.ram(at16(b, 2))), Fault{0};
        case 0x0D:
            return memory.set_ram(0x1E73, body_.ram(at16(b, 2))), Fault{0};
        default:
            if (!facts || !facts->writable_rom()) return 0x58;
            return memory.set_rom(at16(b, 2), memory.ram(at16(b, 2))), Fault{0};
    }
}

}  // namespace axisgate::linmot::twin
