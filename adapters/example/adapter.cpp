// Lines that are not telegrams, or not answers of a drive of the line, are counted.
#include "adapters/example/adapter.hpp"

#include "gateway/core/text.hpp"

namespace axisgate::example {
namespace {
int address_of(std::string_view text) { return static_cast<int>(parse_whole(text, 1, 99).value_or(0)); }
}  // namespace

std::string check_address(std::string_view address) {
    return address_of(address) != 0 ? std::string() : "an example drive has a number from 1 to 99";
}

void LineAdapter::take(const LineSetup& setup, Turn&) {
    bus_.take(setup, {.reply_timeout = std::chrono::milliseconds(60)});
    bus_.on_wire = bus_.wire(2 * longest);
    bus_.turns.set({.pause = bus_.timing.pause});
}

std::string LineAdapter::fault(const DriveSetup& s, const LineSetup&) const {
    const Drive* other = drives().find([&](const Drive& d) { return d.address() == address_of(s.address); });
    return other ? "number " + s.address + " belongs to drive " + other->setup().name : check_address(s.address);
}

std::unique_ptr<Drive> LineAdapter::make(const DriveSetup& s, std::size_t slot, Turn&) {
    return std::make_unique<Drive>(bus_, s, slot, address_of(s.address));
}

void LineAdapter::arrived(const Frame& frame, Turn& t) {
    if (!bus_.is_run(frame)) return;
    lines_.push(drive::text_of(frame), [&](std::string_view line) {
        bool request = false;
        const auto telegram = telegram_of(line, request);
        Drive* d = telegram && !request ? drives().find([&](const Drive& x) { return x.address() == telegram->address; }) : nullptr;
        if (!d) return void(++(telegram ? bus_.counters.unexpected : bus_.counters.garbled));
        d->on_message(*telegram, t);
        settle(*d, t);
    });
}

}  // namespace axisgate::example
