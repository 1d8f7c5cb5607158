// Adapter of the UIM342: the line: who is on it, whose turn it is, what arrives.
// In: calls of the line's owner. Out: what its drives send and report; each call ends with the free places of the window being given away.
// Never lets silent drives fill the window: a quarter of its places (at least one) is theirs.
#include "adapters/uim342/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/text.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/drive/option_reader.hpp"

namespace axisgate::uim342 {
namespace {
std::optional<std::uint8_t> address_of(std::string_view text) {
    const auto v = parse_whole(text, first_node, last_node);
    return v ? std::optional(static_cast<std::uint8_t>(*v)) : std::nullopt;
}
}  // namespace

std::string check_address(std::string_view address) {
    if (address_of(address)) return {};
    return fmt::format("{} is not an address: a UIM342 has a node ID 5..126 (PP[7]; 5 when new)", address.empty() ? "nothing" : address);
}

void LineAdapter::take(const LineSetup& setup, Turn& t) {
    const bool can = kind == LineKind::can;
    using std::chrono::milliseconds;
    Bus::take(setup, can ? drive::Timing{.reply_timeout = milliseconds(50), .poll_period = milliseconds(20)}
                         : drive::Timing{.reply_timeout = milliseconds(200), .poll_period = milliseconds(50)});

    // On a slow line fewer exchanges fit into the time that each may take: no more are begun than half of it holds.
    const Duration exchange = can ? wire_time(2 * 160, bit_rate) : wire(32);
    drive::OptionReader read(setup.options);
    drive::TurnRules rules;
    rules.window = static_cast<std::size_t>(read.whole(
        "in_flight", 1, drive::slot_limit, static_cast<std::int64_t>(drive::fitting(timing.reply_timeout / 2, exchange, 1, can ? 16 : 4))));
    if (timing.pause > Duration::zero() && !can) rules.window = 1;  // silence between an answer and the next request: one at a time
    rules.probe_window = std::max<std::size_t>(1, rules.window / 4);
    rules.pause = timing.pause;
    rules.overtaken_limit = static_cast<std::uint32_t>(drive::fitting(timing.reply_timeout / 4, exchange, 2, 16));
    rules.overtaken_grace = milliseconds(2) + 2 * exchange;  // a drive's own time to answer, and two exchanges
    turns.set(rules);

    const CrcMode crc = crc_mode_named(read.word("crc", {"12", "13", "auto", "none"})).value_or(CrcMode::twelve);
    if (crc != crc_ || !std::exchange(configured_, true)) {
        crc_ = crc;
        framer_ = UiFramer(crc);
        other_crc_reported_ = false;
    }
    drive::tell_faults(read, t);
}

std::string LineAdapter::fault(const DriveSetup& s, const LineSetup&) const {
    const auto id = address_of(s.address);
    if (!id) return check_address(s.address);
    return by_id_[*id] ? fmt::format("ID {} belongs to drive {} already", s.address, by_id_[*id]->name()) : std::string();
}

std::unique_ptr<Drive> LineAdapter::make(const DriveSetup& s, std::size_t slot, Turn&) {
    const auto id = address_of(s.address).value_or(first_node);
    auto made = std::make_unique<Drive>(static_cast<Bus&>(*this), s, id, slot);
    by_id_[id] = made.get();
    return made;
}

void LineAdapter::leaving(Drive& d, Turn& t) {
    if (std::ranges::find(joint_.members, &d) != joint_.members.end())
        end_joint(Outcome::failed, Reason::line_down, fmt::format("drive {} was removed", d.name()), 0, t);
    TurnsAdapter::leaving(d, t);
    by_id_[d.address()] = nullptr;
}

void LineAdapter::line_changed(Turn& t) {
    framer_.reset();
    other_crc_reported_ = false;
    if (!up() && joint_.kind != Joint::Kind::none) end_joint(Outcome::failed, Reason::line_down, "the line went down", 0, t);
    TurnsAdapter::line_changed(t);
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    const auto* together = std::get_if<StartTogether>(&command.body);
    const auto* action = std::get_if<Action>(&command.body);
    const bool group = action && action->name == "start_group", all = action && action->name == "global_stop";
    if (!up() || !drives().of(command.axis) || !(together || group || all)) return TurnsAdapter::on_command(command, now, out);
    Turn t{now, out};
    if (together) start_together(command, *together, t);
    if (group) start_group(command, action->argument, t);
    if (all) global_stop(command, t);
    end(t);
}

// --- what arrives ----------------------------------------------------------------------------------------------------------------

void LineAdapter::arrived(const Frame& frame, Turn& t) {
    if (kind == LineKind::bytes) {
        if (!is_run(frame)) return;
        framer_.push(
            frame.data(), [&](const UiCheck& check, const UiBytes&) { deliver(check.message, t); },
            [&](std::uint8_t) { ++Bus::counters.garbled; });
        if (framer_.other_seen()) tell_other_crc(t);
    } else {
        const auto m = from_can(frame);
        if (m) deliver(m->message, t);
        if (!m) ++Bus::counters.garbled;  // controller reports, base or remote frames, reserved bits
    }
}

/// Once each time the line comes up: nothing would be heard, and nobody would know why.
void LineAdapter::tell_other_crc(Turn& t) {
    if (other_crc_reported_) return;
    other_crc_reported_ = true;
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
    Drive* d = m.id < by_id_.size() ? by_id_[m.id] : nullptr;
    if (!d) {
        ++Bus::counters.unexpected;  // another master, the gateway itself, or a drive that the setup does not name
        return;
    }
    turns.received(t.now);
    d->on_message(m, t);
    settle(*d, t);
}

void LineAdapter::transmit(const Message& m, Priority priority, Turn& t, Ticket order) {
    if (kind == LineKind::can) {
        t.out.send(to_can(m), priority, order);
        return;
    }
    CrcMode mode = framer_.accepting();
    if (mode == CrcMode::automatic) {
        // Nothing proved yet: a gateway that checks its CRC is silent at the wrong one, so both are tried in turn.
        mode = try_thirteen_ ? CrcMode::thirteen : CrcMode::twelve;
        try_thirteen_ = !try_thirteen_;
    }
    t.out.send(Frame::run(to_uimessage(m, mode)), priority, order);
}

// --- questions of nodes ----------------------------------------------------------------------------------------------------------

std::string LineAdapter::user_of(std::uint8_t id, const Drive& but) const {
    if (id < by_id_.size() && by_id_[id] && by_id_[id] != &but) return fmt::format("{}'s node ID", by_id_[id]->name());
    const Drive* member = drives().find([&](const Drive& d) { return &d != &but && d.known.group == id; });
    return member ? fmt::format("{}'s group ID", member->name()) : std::string();
}

}  // namespace axisgate::uim342
