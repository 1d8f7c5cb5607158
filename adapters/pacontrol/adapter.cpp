// Adapter of the PA-CONTROL: the line and its manners.
// In: setup, bytes. Out: calls of the one Drive, and its frames. Manners that the site does not give are chosen here.
// Never decides about the control: that is Drive's.
#include "adapters/pacontrol/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::pacontrol {

std::string check_address(std::string_view address) {
    if (address == "com1") return {};
    const bool printable = std::ranges::all_of(address, [](char c) { return c >= 0x20 && c < 0x7F; });
    return fmt::format("{} is not an address: the serial port of a PA-CONTROL is point to point and has none; write com1",
                       address.empty() ? "nothing"
                       : printable     ? address
                                       : "this");
}

LineAdapter::LineAdapter(const Catalogue& of_family, LineKind) : catalogue_(of_family), elements_(of_family) {}

void LineAdapter::take_manners(const LineSetup& setup, Turn& t) {
    const LineManners& m = setup.manners;
    const Manners own;
    const auto or_else = [](Duration d, Duration otherwise) { return d > Duration::zero() ? d : otherwise; };
    manners_.reply_timeout = or_else(m.reply_timeout, own.reply_timeout);
    manners_.poll_period = or_else(m.poll_period, own.poll_period);
    manners_.pause = std::max(m.pause, Duration::zero());
    manners_.retries = m.retries < 0 ? own.retries : std::min(m.retries, 10);
    manners_.silent_limit = std::clamp(m.silent_limit, 1, 1000);
    manners_.pause_min = or_else(m.retry_pause_min, own.pause_min);
    manners_.pause_max = std::max(manners_.pause_min, m.retry_pause_max);
    manners_.bit_rate = setup.bit_rate;
    manners_.bits_per_byte = setup.bits_per_byte;
    const std::string check = option(setup.options, "check", "learn"), strict = option(setup.options, "strict", "off");
    manners_.check = check_mode_named(check).value_or(CheckMode::learn);
    manners_.strict = strict == "on" || strict == "true";
    const auto complain = [&](std::string text) {
        t.out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0, std::move(text), t.now});
    };
    if (!check_mode_named(check)) complain(fmt::format("option check = {}: write compute, zero or learn; learn is used", check));
    if (!manners_.strict && strict != "off" && strict != "false")
        complain(fmt::format("option strict = {}: write on or off; off is used", strict));
}

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    last_ = now;
    take_manners(setup, t);
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
    drive_ = std::make_unique<Drive>(catalogue_, elements_, counters_, manners_, *mine);
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
    if (!drive_) {
        if (command.ticket != no_ticket) {
            out.results.push_back(
                {command.ticket, command.axis, Outcome::refused, Reason::line_down, 0, "this axis is not on the line", {}, {}});
        }
        return;
    }
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
