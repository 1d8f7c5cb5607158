// Adapter of the PA-CONTROL: the line, its timing and its options.
// In: setup, bytes. Out: calls of the one Drive, and its frames. Timing that the site does not give is chosen here.
// Never decides about the control: that is Drive's.
#include "adapters/pacontrol/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/drive/option_reader.hpp"
#include "gateway/drive/tickets.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr drive::Timing timing_defaults{.reply_timeout = std::chrono::milliseconds(200), .poll_period = std::chrono::milliseconds(50)};
}  // namespace

std::string check_address(std::string_view address) {
    if (address == "com1") return {};
    const bool printable = std::ranges::all_of(address, [](char c) { return c >= 0x20 && c < 0x7F; });
    return fmt::format("{} is not an address: the serial port of a PA-CONTROL is point to point and has none; write com1",
                       address.empty() ? "nothing"
                       : printable     ? address
                                       : "this");
}

LineAdapter::LineAdapter(const Catalogue& of_family, LineKind) : catalogue_(of_family), elements_(of_family) {}

void LineAdapter::read_form(const LineSetup& setup, Turn& t) {
    line_.timing = drive::timing_of(setup.timing, timing_defaults);
    line_.bit_rate = setup.bit_rate;
    line_.bits_per_byte = setup.bits_per_byte;
    drive::OptionReader read(setup.options);
    line_.check = check_mode_named(read.word("check", {"learn", "compute", "zero"})).value_or(CheckMode::learn);
    line_.strict = read.flag("strict", false);
    for (std::string& fault : read.take_faults())
        t.out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0, std::move(fault), t.now});
}

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    read_form(setup, t);
    const auto fault = [&](const DriveSetup& s) -> std::string {
        const Drive* other = drives_.at(0);
        if (!other || !check_address(s.address).empty()) return check_address(s.address);
        return fmt::format("the line belongs to drive {} already: a PA-CONTROL has a serial port of its own", other->setup().name);
    };
    drives_.fit_axes(setup, [&](Drive& d, const DriveSetup& s) { d.set_axes(s, t); });
    const auto fresh = drives_.fit(
        setup, [&](Drive& d) { d.line_down(t, fmt::format("drive {} was removed or changed", d.setup().name)); }, fault,
        [&](const DriveSetup& s, std::size_t) { return std::make_unique<Drive>(catalogue_, elements_, counters_, line_, s); }, out);
    for (Drive* d : fresh)
        if (up_) d->line_up(t);
    pump(t);
}

void LineAdapter::pump(Turn& t) {
    last_ = t.now;
    drives_.each([&](Drive& d) { d.pump(t); });
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    Turn t{now, out};
    if (std::exchange(up_, up) != up) drives_.each([&](Drive& d) { up ? d.line_up(t) : d.line_down(t, "the line is down"); });
    pump(t);
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    Turn t{now, out};
    Drive* d = drives_.of(command.axis);
    if (!d) return drive::Tickets::refuse(command, Reason::line_down, "this axis is not on the line, or its channel is not 1 to 16", out);
    d->submit(command, t);
    pump(t);
}

void LineAdapter::on_frame(const Frame& frame, Instant now, Out& out) {
    Turn t{now, out};
    if (!up_) return;
    if (frame.kind != Frame::Kind::bytes) {
        ++counters_.garbled;
        return;
    }
    drives_.each([&](Drive& d) { d.on_bytes(frame.data(), t); });
    pump(t);
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    drives_.each([&](Drive& d) { d.on_deadline(t); });
    pump(t);
}

Instant LineAdapter::deadline() const {
    const Drive* d = drives_.at(0);
    return d ? std::max(d->deadline(last_), last_) : never;
}

}  // namespace axisgate::pacontrol
