// Adapter of the LinMot drives: the line: who may send now, and whose answer came.
// In: calls from outside. Out: what the drives give back. Never decides about a drive.
#include "adapters/linmot/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/linmot/family.hpp"
#include "gateway/drive/option_reader.hpp"

namespace axisgate::linmot {
namespace {
constexpr drive::Timing defaults{.reply_timeout = std::chrono::milliseconds(60),
                                 .poll_period = std::chrono::milliseconds(20),
                                 .pause = {},
                                 .retries = 2,
                                 .silent_limit = 3,
                                 .pause_min = std::chrono::milliseconds(200),
                                 .pause_max = std::chrono::seconds(5)};
std::uint8_t id_of(const DriveSetup& s) { return static_cast<std::uint8_t>(std::stoul(s.address)); }
}  // namespace

LineAdapter::LineAdapter(const Catalogue& of_family) : bus_(of_family) {}

void LineAdapter::take_manners(const LineSetup& setup, Turn& t) {
    bus_.timing = drive::timing_of(setup.timing, defaults);
    bus_.bit_rate = setup.bit_rate;
    bus_.bits_per_byte = setup.bits_per_byte;
    bus_.drives = setup.drives.size();
    drive::OptionReader options(setup.options);
    using Kind = ChecksumRule::Kind;
    const auto word = options.word("checksum", {"none", "sum", "crc", "crc_reflected"});
    bus_.checksum.kind = word == "sum" ? Kind::sum : word == "crc" ? Kind::crc : word == "crc_reflected" ? Kind::crc_reflected : Kind::none;
    bus_.checksum.from = options.word("checksum_from", {"0", "3"}) == "3" ? 3 : 0;
    bus_.checksum.start = options.word("checksum_start", {"FFFF", "0000"}) == "0000" ? 0 : 0xFFFF;
    framer_.set(bus_.checksum);
    for (auto& fault : options.take_faults())
        t.out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0, std::move(fault), t.now});
    if (bus_.checksum.kind != Kind::none)
        t.out.notices.push_back(
            {Severity::warning, no_drive, no_axis, "setup", 0,
             fmt::format("checksum {} is not proven on any drive: which bytes it covers and where it starts is not public; only none is",
                         word),
             t.now});
    turns_.set({.window = 1, .probe_window = 1, .pause = bus_.timing.pause});
}

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    take_manners(setup, t);
    const auto fresh = roster_.fit(
        setup,
        [&](Drive& d) {
            d.remove(t, fmt::format("drive {} was removed or changed", d.name()));
            turns_.remove(d.slot());
            if (asked_ == &d) free_line();
        },
        [&](const DriveSetup& s) -> std::string {
            if (std::string wrong = check_address(s.address); !wrong.empty()) return wrong;
            const Drive* other = roster_.find([&](const Drive& d) { return d.id() == id_of(s); });
            return other ? fmt::format("ID {} belongs to drive {} already", s.address, other->name()) : std::string();
        },
        [&](const DriveSetup& s, std::size_t slot) { return std::make_unique<Drive>(bus_, s, id_of(s), slot); }, out);
    turns_.forget_wishes();
    for (Drive* d : fresh) {
        d->begin(t);
        if (up_) d->line_up(t);
    }
    roster_.each([&](Drive& d) { settle(d, t); });
    pump(t);
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    if (up == up_) return;
    up_ = up;
    framer_.reset();
    asked_ = nullptr;
    turns_.line_changed(now);
    roster_.each([&](Drive& d) { up ? d.line_up(t) : d.line_down(t, "the line is down"); });
    roster_.each([&](Drive& d) { settle(d, t); });
    pump(t);
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    Drive* d = roster_.of(command.axis);
    if (!d) return drive::Tickets::refuse(command, Reason::line_down, "this axis is not on the line", out);
    d->submit(command, t);
    settle(*d, t);
    pump(t);
}

void LineAdapter::on_set_point(const SetPoint& p, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    Drive* d = roster_.of(p.axis);
    if (!d) return;
    d->follow(p);
    settle(*d, t);
    pump(t);
}

void LineAdapter::on_frame(const Frame& frame, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    if (!up_) return;
    if (frame.kind != Frame::Kind::bytes) {
        ++bus_.counters.garbled;
        return;
    }
    framer_.push(
        frame.data(), [&](const Telegram& telegram, std::span<const std::uint8_t>) { heard(telegram, t); },
        [&](std::span<const std::uint8_t>, std::string_view) { ++bus_.counters.garbled; });
    pump(t);
}

void LineAdapter::heard(const Telegram& telegram, Turn& t) {
    Drive* d = asked_;
    if (!d || telegram.id != d->id() || !d->exchanges.answers(telegram)) {
        ++bus_.counters.unexpected;
        if (Drive* other = roster_.find([&](const Drive& x) { return x.id() == telegram.id; }); other && telegram.main == 0) {
            other->unasked(t);
            settle(*other, t);
        }
        return;
    }
    asked_ = nullptr;
    turns_.heard(t.now);
    turns_.ended(d->slot());
    d->on_telegram(telegram, t);
    settle(*d, t);
}

void LineAdapter::free_line() {
    asked_ = nullptr;
    framer_.reset();
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    while (const auto slot = turns_.due(now)) {
        Drive* d = roster_.at(*slot);
        if (!d) {
            turns_.remove(*slot);
            continue;
        }
        const bool was = d->waiting();
        d->on_deadline(t);
        if (was && d->exchanges.repeated(t.now)) {
            framer_.reset([&](std::span<const std::uint8_t>, std::string_view) { ++bus_.counters.garbled; });
        } else if (was && !d->waiting()) {
            free_line();
            turns_.ended(*slot);
        }
        settle(*d, t);
    }
    pump(t);
}

void LineAdapter::settle(Drive& d, Turn& t) {
    turns_.settle(d.slot(), up_ && !d.waiting() ? d.wants(t.now) : drive::Want::nothing, d.deadline(), d.waiting() ? never : d.wish());
}

void LineAdapter::pump(Turn& t) {
    if (!up_) return;
    while (!asked_) {
        const auto slot = turns_.next(t.now);
        if (!slot) return;
        Drive* d = roster_.at(*slot);
        if (!d) continue;
        const bool probe = d->wants(t.now) == drive::Want::probe;
        framer_.reset([&](std::span<const std::uint8_t>, std::string_view) { ++bus_.counters.garbled; });
        d->go(t);
        if (d->waiting()) {
            asked_ = d;
            turns_.began(*slot, probe);
        }
        settle(*d, t);
    }
}

Instant LineAdapter::deadline() const { return up_ ? std::max(turns_.deadline(), last_) : never; }

}  // namespace axisgate::linmot
