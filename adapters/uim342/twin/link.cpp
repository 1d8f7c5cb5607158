// Link: telegrams as frames of a CAN bus or bytes of a serial line.
// In: telegrams, the instant at which they leave. Out: frames.
#include "adapters/uim342/twin/link.hpp"

#include <algorithm>

namespace axisgate::uim342::twin {
namespace {
constexpr std::uint8_t cw_notification = 0x5A;
}  // namespace

Acceptance Link::acceptance() const noexcept {
    if (kind != LineKind::can) return {};
    const auto of = [](std::uint8_t id) { return Acceptance::Filter{can_id(0, 0x7F, 0), can_id(0, id, 0)}; };
    return {{of(node), of(global_id), of(group)}, 3};
}

void Link::send(const Telegram& telegram, Instant at, Out& out) const {
    if (silent || !on_the_bus()) return;
    Frame f = kind == LineKind::can ? write_can(telegram) : Frame::run(write_message(telegram, form));
    f.at = at;
    out.send(f);
}

void Link::notify(std::span<const std::uint8_t> data, Instant at, Out& out) const {
    Telegram t;
    t.producer = node;
    t.consumer = notifies;
    t.cw = cw_notification;
    t.dl = static_cast<std::uint8_t>(data.size());
    std::copy(data.begin(), data.end(), t.d.begin());
    send(t, at, out);
}

}  // namespace axisgate::uim342::twin
