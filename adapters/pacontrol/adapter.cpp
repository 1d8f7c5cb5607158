// Adapter of the PA-CONTROL: the line, its timing and its options.
// In: setup, bytes. Out: calls of the one Drive, and its frames. Timing that the site does not give is chosen here.
// Never decides about the control: that is Drive's.
#include "adapters/pacontrol/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>

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
    line_.timing = drive::timing_of(setup.manners, timing_defaults);
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
    last_ = now;
    read_form(setup, t);
    const DriveSetup* mine = nullptr;
    for (const DriveSetup& d : setup.drives) {
        const std::string wrong = check_address(d.address);
        if (wrong.empty() && !mine) {
            mine = &d;
            continue;
        }
        out.links.push_back(
            {d.id, false, 0, Duration{},
             wrong.empty() ? fmt::format("the line belongs to drive {} already: a PA-CONTROL has a serial port of its own", mine->name)
                           : wrong});
    }
    if (drive_) {
        const DriveSetup& was = drive_->setup();
        if (mine && mine->id == was.id && mine->name == was.name && mine->options == was.options) {
            drive_->set_axes(*mine, t);
            drive_->pump(t);
            return;
        }
        if (up_) drive_->line_down(t, fmt::format("drive {} was removed or changed", was.name));
        std::erase_if(out.links, [&](const DriveLink& l) { return l.drive == was.id && !mine; });
        drive_.reset();
    }
    if (!mine) return;
    drive_ = std::make_unique<Drive>(catalogue_, elements_, counters_, line_, *mine);
    if (up_) drive_->line_up(t);
    drive_->pump(t);
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    if (up == up_) return;
    up_ = up;
    if (!drive_) return;
    up ? drive_->line_up(t) : drive_->line_down(t, "the line is down");
    drive_->pump(t);
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    if (!drive_) return drive::Tickets::refuse(command, Reason::line_down, "this axis is not on the line", out);
    drive_->submit(command, t);
    drive_->pump(t);
}

void LineAdapter::on_frame(const Frame& frame, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    if (!up_) return;
    if (frame.kind != Frame::Kind::bytes) {
        ++counters_.garbled;
        return;
    }
    if (!drive_) return;
    drive_->on_bytes(frame.data(), t);
    drive_->pump(t);
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    if (!drive_) return;
    drive_->on_deadline(t);
    drive_->pump(t);
}

Instant LineAdapter::deadline() const { return drive_ ? std::max(drive_->deadline(last_), last_) : never; }

}  // namespace axisgate::pacontrol
