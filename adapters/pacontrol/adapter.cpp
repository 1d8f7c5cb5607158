// Adapter of the PA-CONTROL: the line, its timing and its options.
// In: setup, bytes. Out: calls of the one Drive, and its frames. Timing that the site does not give is chosen here.
// Never decides about the control: that is Drive's.
#include "adapters/pacontrol/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/drive/option_reader.hpp"

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

void LineAdapter::take(const LineSetup& setup, Turn& t) {
    bus_.take(setup, timing_defaults);  // the reply time-out counts besides the time that the bytes take
    drive::OptionReader read(setup.options);
    bus_.check = check_mode_named(read.word("check", {"learn", "compute", "zero"})).value_or(CheckMode::learn);
    bus_.strict = read.flag("strict", false);
    drive::tell_faults(read, t);
}

std::string LineAdapter::fault(const DriveSetup& s, const LineSetup&) const {
    const Drive* other = drives().at(0);
    if (!other || !check_address(s.address).empty()) return check_address(s.address);
    return fmt::format("the line belongs to drive {} already: a PA-CONTROL has a serial port of its own", other->setup().name);
}

std::unique_ptr<Drive> LineAdapter::make(const DriveSetup& s, std::size_t, Turn&) { return std::make_unique<Drive>(bus_, s); }

void LineAdapter::end(Turn& t) {
    last_ = t.now;
    drives().each([&](Drive& d) { d.pump(t); });
}

void LineAdapter::arrived(const Frame& frame, Turn& t) {
    if (bus_.is_run(frame)) drives().each([&](Drive& d) { d.port.on_bytes(frame.data(), t); });
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    drives().each([&](Drive& d) { d.on_deadline(t); });
    end(t);
}

Instant LineAdapter::deadline() const {
    const Drive* d = drives().at(0);
    return d ? std::max(d->deadline(last_), last_) : never;
}

}  // namespace axisgate::pacontrol
