#include "adapters/linmot/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

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

std::string check_address(std::string_view address) {
    unsigned id = 0;
    const auto [end, ec] = std::from_chars(address.data(), address.data() + address.size(), id);
    const bool plain = address.size() == 1 || (!address.empty() && address[0] != '0');
    if (ec == std::errc{} && end == address.data() + address.size() && id <= 255 && plain) return {};
    const bool printable = std::ranges::all_of(address, [](char c) { return c >= 0x20 && c < 0x7F; });
    return fmt::format("{} is not the ID of a LinMot drive: write a number 0..255, as its switches or parameters have it",
                       address.empty() ? "nothing"
                       : printable     ? address
                                       : "this");
}

void LineAdapter::take(const LineSetup& setup, Turn& t) {
    bus_.take(setup, defaults);
    bus_.drives = setup.drives.size();
    drive::OptionReader options(setup.options);
    using Kind = ChecksumRule::Kind;
    const auto word = options.word("checksum", {"none", "sum", "crc", "crc_reflected"});
    bus_.checksum.kind = word == "sum" ? Kind::sum : word == "crc" ? Kind::crc : word == "crc_reflected" ? Kind::crc_reflected : Kind::none;
    bus_.checksum.from = options.word("checksum_from", {"0", "3"}) == "3" ? 3 : 0;
    bus_.checksum.start = options.word("checksum_start", {"FFFF", "0000"}) == "0000" ? 0 : 0xFFFF;
    framer_.set(bus_.checksum);
    drive::tell_faults(options, t);
    if (bus_.checksum.kind != Kind::none)
        t.out.notices.push_back(
            {Severity::warning, no_drive, no_axis, "setup", 0,
             fmt::format("checksum {} is not proven on any drive: which bytes it covers and where it starts is not public; only none is",
                         word),
             t.now});
    bus_.turns.set({.pause = bus_.timing.pause});
}

std::string LineAdapter::fault(const DriveSetup& s, const LineSetup&) const {
    if (std::string wrong = check_address(s.address); !wrong.empty()) return wrong;
    const Drive* other = drives().find([&](const Drive& d) { return d.id() == id_of(s); });
    return other ? fmt::format("ID {} belongs to drive {} already", s.address, other->name()) : std::string();
}

std::unique_ptr<Drive> LineAdapter::make(const DriveSetup& s, std::size_t slot, Turn& t) {
    auto made = std::make_unique<Drive>(bus_, s, id_of(s), slot);
    made->tell_setup(made->options.faults, t);
    return made;
}

void LineAdapter::leaving(Drive& d, Turn& t) {
    TurnsAdapter::leaving(d, t);
    if (asked_ == &d) free_line();
}

void LineAdapter::line_changed(Turn& t) {
    TurnsAdapter::line_changed(t);
    bus_.shared.line_changed();
    quiet_until_ = stop_from_ = t.now;
    waits_for_silence_ = false;
    free_line();
}

void LineAdapter::arrived(const Frame& frame, Turn& t) {
    if (!bus_.is_run(frame)) return;
    const std::size_t overlapped = bus_.shared.heard(t.now, frame.size, bus_.wire(1), framer_.pending());
    if (overlapped > 0) ++bus_.counters.garbled;
    framer_.push(
        frame.data().subspan(overlapped), [&](const Telegram& telegram, std::span<const std::uint8_t>) { received(telegram, t); },
        [&](std::span<const std::uint8_t>, std::string_view) { ++bus_.counters.garbled; });
    if (drives().find([](const Drive& d) { return d.stream.on(); })) return;
    quiet_until_ = bus_.shared.silent_at(t.now);
    stop_from_ = bus_.shared.stop_at(t.now);
}

void LineAdapter::received(const Telegram& telegram, Turn& t) {
    Drive* d = asked_;
    if (!d || telegram.id != d->id() || !d->exchanges.answers(telegram)) {
        ++bus_.counters.unexpected;
        if (!d || !d->exchanges.echoes(telegram)) bus_.shared.strange(t.now);
        if (Drive* other = drives().find([&](const Drive& x) { return x.id() == telegram.id; }); other && telegram.main == 0) {
            other->unasked(t);
            settle(*other, t);
        }
        return;
    }
    asked_ = nullptr;
    bus_.turns.received(t.now);
    bus_.turns.ended(d->slot());
    d->on_telegram(telegram, t);
    settle(*d, t);
}

void LineAdapter::free_line() {
    asked_ = nullptr;
    framer_.reset();
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    while (const auto slot = bus_.turns.due(now)) {
        Drive* d = drives().at(*slot);
        if (!d) {
            bus_.turns.remove(*slot);
            continue;
        }
        const bool was = d->waiting();
        d->on_deadline(t);
        if (was && d->exchanges.repeated(t.now)) {
            framer_.reset([&](std::span<const std::uint8_t>, std::string_view) { ++bus_.counters.garbled; });
        } else if (was && !d->waiting()) {
            free_line();
            bus_.turns.ended(*slot);
        }
        settle(*d, t);
    }
    end(t);
}

Instant LineAdapter::deadline() const {
    const Instant at = TurnsAdapter::deadline();
    return waits_for_silence_ ? std::min(at, silent_at_) : at;
}

void LineAdapter::give(Turn& t) {
    const bool stops = drives().find([&](const Drive& d) { return d.wants(t.now) == drive::Want::urgent; }) != nullptr;
    silent_at_ = stops ? stop_from_ : quiet_until_;
    waits_for_silence_ = up() && !asked_ && t.now < silent_at_;
    while (!asked_ && !waits_for_silence_) {
        const auto slot = bus_.turns.next(t.now);
        if (!slot) return;
        Drive* d = drives().at(*slot);
        if (!d) continue;
        const bool probe = d->wants(t.now) == drive::Want::probe;
        framer_.reset([&](std::span<const std::uint8_t>, std::string_view) { ++bus_.counters.garbled; });
        d->go(t);
        if (d->waiting()) {
            asked_ = d;
            bus_.turns.began(*slot, probe);
        }
        settle(*d, t);
    }
}

}  // namespace axisgate::linmot
