#include "adapters/mcode/twin/delivery.hpp"

#include <algorithm>

namespace axisgate::mcode::twin {

void deliver(const Reply& r, bool party, const Manners& m, Instant now, Transmitter& tx) {
    tx.say(r.head, now);
    if (party && !r.data.empty()) tx.pause(m.party_gap, tx.end(now));
    std::string_view rest = r.data;
    while (m.listing_pause > Duration::zero()) {
        const auto end = rest.find("\r\n");
        if (end == std::string_view::npos || end + 2 == rest.size()) break;
        tx.say(rest.substr(0, end + 2), now);
        tx.pause(m.listing_pause, tx.end(now));
        rest.remove_prefix(end + 2);
    }
    tx.say(rest, now);
    tx.say(r.tail, now);
    if (!r.prompt.empty()) tx.pause(m.prompt_late, tx.end(now));
    tx.say(r.prompt, now);
}

std::string sign_on(const Manners& m, const LinkFlags& flags, bool network) {
    if (!m.sign_on || network || flags.py) return {};
    return std::string("\r\nCopyright 2016 by Schneider Electric Motion\r\nAll Rights Reserved\r\n") + (flags.em == 0 ? ">" : "");
}

void load_chatter(const Manners& m, Program& program) {
    if (m.chatter_ms == 0) return;
    std::int32_t address = 1;
    const std::string hold = "H " + std::to_string(m.chatter_ms);
    for (const std::string_view line : {std::string_view("LB SU"), std::string_view("LB G0"), std::string_view("PR \"Pos \",P"),
                                        std::string_view(hold), std::string_view("BR G0")})
        (void)program.enter(line, address);
}

}  // namespace axisgate::mcode::twin
