// Adapter of the UIM342: the line: who is on it, whose turn it is, what arrives.
// In: calls of the line's owner. Out: turns of nodes; each call ends with pump(), so that places of the window that are free are given
// away. Never lets silent drives fill the window: a quarter of its places (at least one, never all but one of two or more) is theirs.
#include "adapters/uim342/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "gateway/core/wire_time.hpp"

namespace axisgate::uim342 {
namespace {
constexpr std::uint8_t in_commands = 1, in_polls = 2, in_probes = 4;
constexpr std::uint8_t commands_per_poll = 8;

std::optional<std::uint8_t> address_of(std::string_view text) {
    unsigned v = 0;
    const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (ec != std::errc{} || p != text.data() + text.size() || v < first_node || v > last_node) return std::nullopt;
    return static_cast<std::uint8_t>(v);
}

bool same(const DriveSetup& a, const DriveSetup& b) {
    if (a.id != b.id || a.name != b.name || a.address != b.address || a.options != b.options || a.axes.size() != b.axes.size())
        return false;
    return std::ranges::equal(a.axes, b.axes,
                              [](const AxisSetup& x, const AxisSetup& y) { return x.id == y.id && x.channel == y.channel; });
}
}  // namespace

std::string check_address(std::string_view address) {
    if (address_of(address)) return {};
    return fmt::format("{} is not an address: a UIM342 has a node ID 5..126 (PP[7]; 5 when new)", address.empty() ? "nothing" : address);
}

LineAdapter::LineAdapter(const Catalogue& of_family, LineKind on) : Bus(of_family, on) {}

void LineAdapter::take_timing(const LineSetup& setup) {
    const bool can = kind == LineKind::can;
    using std::chrono::milliseconds;
    timing = drive::timing_of(setup.manners, can ? drive::Timing{.reply_timeout = milliseconds(50), .poll_period = milliseconds(20)}
                                                 : drive::Timing{.reply_timeout = milliseconds(200), .poll_period = milliseconds(50)});
    bit_rate = setup.bit_rate;

    // On a slow line fewer exchanges fit into the time that each may take: no more are begun than half of it holds.
    const Duration exchange = can ? wire_time(2 * 160, bit_rate) : wire_time(32u * setup.bits_per_byte, bit_rate);
    const std::string wanted = option(setup.options, "in_flight", "");
    std::size_t n = 0;
    std::from_chars(wanted.data(), wanted.data() + wanted.size(), n);
    window_ = n == 0 ? drive::fitting(timing.reply_timeout / 2, exchange, 1, can ? 16 : 4) : std::min<std::size_t>(n, drive::slot_limit);
    if (timing.pause > Duration::zero() && !can) window_ = 1;  // silence between an answer and the next request: one at a time
    probe_window_ = std::max<std::size_t>(1, window_ / 4);
    // Grace: a drive's own time to answer, and two exchanges.
    overtaken.set(static_cast<std::uint32_t>(drive::fitting(timing.reply_timeout / 4, exchange, 2, 16)), milliseconds(2) + 2 * exchange);

    const CrcMode crc = crc_mode_named(option(setup.options, "crc", "12")).value_or(CrcMode::twelve);
    if (crc != crc_ || setup_.id == no_line) {
        crc_ = crc;
        framer_ = UiFramer(crc);
        other_crc_told_ = false;
    }
}

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    take_timing(setup);
    if (const auto crc = setup.options.find("crc"); crc != setup.options.end() && !crc_mode_named(crc->second)) {
        out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0,
                               fmt::format("option crc = {}: write 12, 13, auto or none; 12 is used", crc->second), now});
    }
    if (const auto n = setup.options.find("in_flight");
        n != setup.options.end() && std::to_string(window_) != n->second && timing.pause <= Duration::zero()) {
        out.notices.push_back(
            {Severity::warning, no_drive, no_axis, "setup", 0,
             fmt::format("option in_flight = {}: write a whole number 1..{}; {} is used", n->second, drive::slot_limit, window_), now});
    }
    // Removed and changed ones first, so that their addresses are free.
    for (auto& n : nodes_) {
        if (!n) continue;
        const bool keep = std::ranges::any_of(setup.drives, [&](const DriveSetup& d) { return same(d, n->setup()); });
        if (keep) continue;
        if (joint_.kind != Joint::Kind::none && std::ranges::find(joint_.members, n.get()) != joint_.members.end()) {
            end_joint(Outcome::failed, Reason::line_down, fmt::format("drive {} was removed", n->name()), 0, t);
        }
        n->remove(t, fmt::format("drive {} was removed or changed", n->name()));
        by_id_[n->address()] = nullptr;
        heap_.set(n->slot(), never);
        n.reset();
    }
    std::vector<Drive*> fresh;
    for (const DriveSetup& d : setup.drives) {
        if (std::ranges::any_of(nodes_, [&](const auto& n) { return n && same(d, n->setup()); })) continue;
        const auto address = address_of(d.address);
        if (!address || by_id_[*address]) {
            out.links.push_back({d.id, false, 0, Duration{},
                                 !address ? check_address(d.address)
                                          : fmt::format("ID {} belongs to drive {} already", d.address, by_id_[*address]->name())});
            continue;
        }
        std::size_t slot = 0;
        while (slot < nodes_.size() && nodes_[slot])
            ++slot;
        if (slot == nodes_.size()) nodes_.emplace_back();
        nodes_[slot] = std::make_unique<Drive>(static_cast<Bus&>(*this), d, *address, slot);
        by_id_[*address] = nodes_[slot].get();
        fresh.push_back(nodes_[slot].get());
    }
    setup_ = setup;
    by_axis_.clear();
    clear_rings();
    for (auto& n : nodes_) {
        if (n && n->axis() != no_axis) by_axis_.emplace_back(n->axis(), n.get());
    }
    std::ranges::sort(by_axis_, {}, [](const auto& p) { return p.first; });
    if (up_) {
        for (Drive* n : fresh)
            n->line_up(t);
    }
    touched_ = true;
    finish_turn(t);
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    Turn t{now, out};
    if (up == up_) return;
    up_ = up;
    framer_.reset();
    other_crc_told_ = false;
    quiet_until_ = now;
    if (!up && joint_.kind != Joint::Kind::none) end_joint(Outcome::failed, Reason::line_down, "the line went down", 0, t);
    for (auto& n : nodes_) {
        if (n) up ? n->line_up(t) : n->line_down(t, "the line is down");
    }
    // Nobody waits for a place on a line that is down, and nobody may keep a deadline there; on one that comes up each asks anew.
    clear_rings();
    overtaken.clear();
    touched_ = true;
    finish_turn(t);
}

void LineAdapter::clear_rings() noexcept {
    commands_.clear();
    polls_.clear();
    probes_.clear();
    for (auto& n : nodes_) {
        if (n) n->in_ring = 0;
    }
}

void LineAdapter::answer(const Command& c, Outcome outcome, Reason reason, std::string text, Turn& t) {
    if (c.ticket != no_ticket) t.out.results.push_back({c.ticket, c.axis, outcome, reason, 0, std::move(text), {}, {}});
}

Drive* LineAdapter::node_of(AxisId axis) const noexcept {
    const auto it = std::ranges::lower_bound(by_axis_, axis, {}, [](const auto& p) { return p.first; });
    return it != by_axis_.end() && it->first == axis ? it->second : nullptr;
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    Turn t{now, out};
    Drive* n = node_of(command.axis);
    if (!n) {
        answer(command, Outcome::refused, Reason::line_down,
               "this axis is not on the line, or its drive's address or channel is wrong (a UIM342 has one axis)", t);
        return;
    }
    const auto* together = std::get_if<StartTogether>(&command.body);
    const auto* action = std::get_if<Action>(&command.body);
    if (!up_) {
        n->submit(command, t);  // refuses with the reason
    } else if (together) {
        start_together(command, *together, t);
    } else if (action && action->name == "start_group") {
        start_group(command, action->argument, t);
    } else if (action && action->name == "global_stop") {
        global_stop(command, t);
    } else {
        n->submit(command, t);
        settle(*n, t);
    }
    finish_turn(t);
}

// --- what arrives ----------------------------------------------------------------------------------------------------------------

void LineAdapter::on_frame(const Frame& frame, Instant now, Out& out) {
    if (!up_) return;
    Turn t{now, out};
    if (kind == LineKind::bytes) {
        if (frame.kind != Frame::Kind::bytes) {
            ++Bus::counters.garbled;
            return;
        }
        framer_.push(
            frame.data(), [&](const UiCheck& check, const UiBytes&) { deliver(check.message, t); },
            [&](std::uint8_t) { ++Bus::counters.garbled; });
        if (framer_.other_seen()) tell_other_crc(t);
    } else {
        const auto m = from_can(frame);
        if (!m) {
            ++Bus::counters.garbled;  // controller reports, base or remote frames, reserved bits
            return;
        }
        deliver(m->message, t);
    }
    finish_turn(t);
}

/// Once each time the line comes up: nothing would be heard, and nobody would know why.
void LineAdapter::tell_other_crc(Turn& t) {
    if (other_crc_told_) return;
    other_crc_told_ = true;
    const auto words = [](CrcMode m) {
        return m == CrcMode::twelve     ? "12 bytes (ID to d8)"
               : m == CrcMode::thirteen ? "13 bytes (AA to d8)"
                                        : "nothing: frames without a CRC";
    };
    const CrcMode seen = *framer_.other_seen();
    t.out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0,
                             fmt::format("frames arrive whose CRC covers {}, and this line takes {}: write option crc = {} or auto for it",
                                         words(seen), words(framer_.accepting()), name_of(seen)),
                             t.now});
}

void LineAdapter::deliver(const Message& m, Turn& t) {
    Drive* n = m.id < by_id_.size() ? by_id_[m.id] : nullptr;
    if (!n) {
        ++Bus::counters.unexpected;  // another master, the gateway itself, or a drive that the setup does not name
        return;
    }
    if (timing.pause > Duration::zero()) quiet_until_ = t.now + timing.pause;
    n->on_message(m, t);
    settle(*n, t);
}

// --- whose turn it is ------------------------------------------------------------------------------------------------------------

void LineAdapter::transmit(const Message& m, Priority priority, Turn& t) {
    if (kind == LineKind::can) {
        t.out.send(to_can(m), priority);
        return;
    }
    CrcMode mode = framer_.accepting();
    if (mode == CrcMode::automatic) {
        // Nothing proved yet: a gateway that checks its CRC is silent at the wrong one, so both are tried in turn.
        mode = try_thirteen_ ? CrcMode::thirteen : CrcMode::twelve;
        try_thirteen_ = !try_thirteen_;
    }
    t.out.send(Frame::run(to_uimessage(m, mode)), priority);
}

/// Puts a node where it belongs after anything has happened to it.
void LineAdapter::settle(Drive& n, Turn& t) {
    switch (n.wants(t.now)) {
        case Drive::Want::nothing:
            break;
        case Drive::Want::command:
            if (!(n.in_ring & in_commands)) {
                n.in_ring |= in_commands;
                commands_.push(n.slot());
            }
            break;
        case Drive::Want::poll:
            if (!(n.in_ring & in_polls)) {
                n.in_ring |= in_polls;
                polls_.push(n.slot());
            }
            break;
        case Drive::Want::probe:
            if (!(n.in_ring & in_probes)) {
                n.in_ring |= in_probes;
                probes_.push(n.slot());
            }
            break;
    }
    // A node that waits for a place is not due by its own wish any more.
    heap_.set(n.slot(), n.in_ring != 0 ? n.due_but_wish() : n.due());
}

void LineAdapter::pump(Turn& t) {
    const auto serve = [&](drive::Ring& ring, std::uint8_t mark) {
        Drive* n = nodes_[ring.pop()].get();
        n->in_ring &= static_cast<std::uint8_t>(~mark);
        const auto want = n->wants(t.now);
        const bool right = mark == in_probes ? want == Drive::Want::probe : want == Drive::Want::command || want == Drive::Want::poll;
        if (right) n->go(t);
        settle(*n, t);
    };
    while (in_flight < window_ && t.now >= quiet_until_) {
        // Commands first, but every ninth place is a poll's; polls and probes in turn, so that a busy line still finds new drives.
        const bool may_probe = !probes_.empty() && probes_in_flight < probe_window_;
        const bool others_wait = !polls_.empty() || may_probe;
        if (!commands_.empty() && !(others_wait && commands_in_a_row_ >= commands_per_poll)) {
            if (commands_in_a_row_ < commands_per_poll) ++commands_in_a_row_;
            serve(commands_, in_commands);
        } else if (may_probe && !(probed_last_ && !polls_.empty())) {
            probed_last_ = true;
            commands_in_a_row_ = 0;
            serve(probes_, in_probes);
        } else if (!polls_.empty() && overtaken.may_begin(t.now)) {
            probed_last_ = false;
            commands_in_a_row_ = 0;
            serve(polls_, in_polls);
        } else {
            break;
        }
    }
}

void LineAdapter::finish_turn(Turn& t) {
    if (!up_) {
        if (touched_) {
            for (auto& n : nodes_) {
                if (n) heap_.set(n->slot(), never);
            }
            touched_ = false;
        }
        return;
    }
    if (touched_) {
        touched_ = false;
        for (auto& n : nodes_) {
            if (n) settle(*n, t);
        }
    }
    pump(t);
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    // Each due node is looked at once: settle gives it a later instant or a place in a ring.
    for (std::size_t n = 0; n < drive::slot_limit && heap_.earliest() <= now; ++n) {
        Drive& node = *nodes_[heap_.first()];
        node.on_deadline(t);
        settle(node, t);
    }
    finish_turn(t);
}

Instant LineAdapter::deadline() const {
    const Instant due = heap_.earliest();
    if (!up_) return due;
    const bool waiting = !commands_.empty() || !polls_.empty() || !probes_.empty();
    if (!waiting || in_flight >= window_) return due;
    // Somebody waits for the silence after an answer to end, or for overtaken ones to have had their chance; else places become free
    // only by calls.
    const Instant chance = polls_.empty() ? never : overtaken.deadline();
    return std::min({due, chance, timing.pause > Duration::zero() ? quiet_until_ : never});
}

// --- questions of nodes ----------------------------------------------------------------------------------------------------------

std::string LineAdapter::user_of(std::uint8_t id, const Drive& but) const {
    for (const auto& n : nodes_) {
        if (n && n.get() != &but && n->address() == id) return fmt::format("{}'s node ID", n->name());
    }
    for (const auto& n : nodes_) {
        if (n && n.get() != &but && n->group() == id) return fmt::format("{}'s group ID", n->name());
    }
    return {};
}

}  // namespace axisgate::uim342
