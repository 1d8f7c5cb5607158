#include "adapters/remote/adapter.hpp"

#include <algorithm>

#include "gateway/drive/text_lines.hpp"

namespace axisgate::remote {

std::string LineAdapter::fault(const DriveSetup& s, const LineSetup&) const {
    const Drive* other = drives().find([&](const Drive& d) { return d.setup().address == s.address; });
    return other ? s.address + " is mirrored by " + other->setup().name + " already" : mirror::check_address(s.address);
}

std::unique_ptr<Drive> LineAdapter::make(const DriveSetup& s, std::size_t, Turn&) { return std::make_unique<Drive>(line_, s); }

void LineAdapter::arrived(const Frame& frame, Turn& t) {
    if (frame.kind != Frame::Kind::bytes) return;
    framer_.push(drive::text_of(frame), [&](std::string_view line) {
        if (line.empty()) return;
        const auto telegram = mirror::telegram_of(line);
        const bool ours = telegram && telegram->kind != mirror::Telegram::Kind::request;
        Drive* d = ours ? drives().find([&](const Drive& x) { return x.setup().address == telegram->address; }) : nullptr;
        if (!d) return void(++(telegram ? line_.counters.unexpected : line_.counters.garbled));
        d->on_telegram(*telegram, t);
        d->go(t);
    });
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    drives().each([&](Drive& d) {
        if (d.deadline() > now) return;
        d.on_deadline(t);
        d.go(t);
    });
}

Instant LineAdapter::deadline() const {
    Instant first = never;
    drives().each([&](const Drive& d) { first = std::min(first, d.deadline()); });
    return first;
}

}  // namespace axisgate::remote
