#include "adapters/uim342/twin/device_reports.hpp"

#include <algorithm>

#include "adapters/uim342/twin/telegrams.hpp"
#include "gateway/core/specimen.hpp"

namespace axisgate::uim342::twin {
namespace {
constexpr std::uint8_t code_arrived = 0x29;
}

/// Alarms have no enable bit: they are always sent.
void DeviceReports::raise(Alarm alarm, Instant at, Out& out) {
    d_.flags_.err = true;
    notify({0, static_cast<std::uint8_t>(alarm), 0, 0, 0}, at, out);
}

/// A specimen's notification can be late, or missing.
void DeviceReports::notify(std::initializer_list<std::uint8_t> data, Instant at, Out& out) {
    ++d_.notified_;
    const bool lost =
        d_.manners_.notification_lost > 0 &&
        static_cast<std::int64_t>(specimen_draw(d_.manners_.seed, "notification", d_.notified_) % 1000) < d_.manners_.notification_lost;
    if (lost) return;
    if (d_.manners_.notification_late == Duration::zero()) return d_.link_.notify({data.begin(), data.size()}, at, out);
    if (d_.notices_.size() >= Device::most_notices) return;
    Device::Notice n{at + d_.manners_.notification_late, {}, static_cast<std::uint8_t>(data.size())};
    std::copy(data.begin(), data.end(), n.data.begin());
    d_.notices_.push_back(n);
}

void DeviceReports::arrive(Instant at, Out& out) {
    d_.arrive_at_ = never;
    d_.flags_.paif = true;
    if (d_.memory_.ram().ie[3] == 0) return;
    const auto p = static_cast<std::uint32_t>(d_.axis_.position(at));
    const auto byte = [p](int n) { return static_cast<std::uint8_t>(p >> (8 * n)); };
    notify({code_arrived, 0, 0, 0, byte(0), byte(1), byte(2), byte(3)}, at, out);
}

/// Remembers the changes of MS[0] for as long as a specimen shows them late.
void DeviceReports::keep_status(Instant at) {
    if (d_.manners_.status_late == Duration::zero()) return;
    const auto bits = status_bits(d_);
    if (!d_.statuses_.empty() && d_.statuses_.back().bits == bits) return;
    d_.statuses_.push_back({at, bits});
    while (d_.statuses_.size() > Device::most_statuses || (d_.statuses_.size() > 1 && d_.statuses_[1].at + d_.manners_.status_late <= at))
        d_.statuses_.pop_front();
}

void DeviceReports::send_status(Instant at, Out& out) const {
    Telegram t;
    t.producer = d_.link_.node;
    t.consumer = d_.link_.notifies;
    t.cw = MS;
    fill_status(d_, t, at);
    d_.link_.send(t, at, out);
}

/// ML [L1143-1148]: d3 and d7:d6 are the factory's, the firmware versions in d5:d4 are not published.
void DeviceReports::fill_model(const Device& d, Telegram& reply) noexcept {
    reply.cw = ML;
    reply.dl = 8;
    std::copy(d.identity_.model.begin(), d.identity_.model.end(), reply.d.begin());
    put(reply, 4, d.manners_.firmware, 2);
}

/// MS[0] [L879-905], as a specimen shows it late.
void DeviceReports::fill_status(const Device& d, Telegram& reply, Instant now) noexcept {
    auto bits = status_bits(d);
    if (!d.statuses_.empty()) bits = d.statuses_.front().bits;
    for (const Device::Status& s : d.statuses_)
        if (s.at + d.manners_.status_late <= now) bits = s.bits;
    reply.d = {0, bits[0], bits[1], 0, 0, 0, 0, 0};
    put(reply, 4, static_cast<std::uint32_t>(d.axis_.relative(now)), 4);
    reply.dl = 8;
}

/// d1 and d2 of MS[0].
std::array<std::uint8_t, 2> DeviceReports::status_bits(const Device& d) noexcept {
    const auto bit = [](bool on, int n) { return on ? 1u << n : 0u; };
    return {static_cast<std::uint8_t>(bit(d.wanted_.ptp, 0) | bit(d.axis_.driver_on(), 2) | (unsigned{d.inputs_.latched()} << 3) |
                                      bit(d.flags_.output, 6)),
            static_cast<std::uint8_t>(bit(!d.axis_.moving(), 0) | bit(d.flags_.paif, 1) | bit(d.flags_.tlif, 3) | bit(d.flags_.lock, 5) |
                                      bit(d.flags_.err, 7))};
}

/// Sent even if no acknowledgement was asked for; d2 keeps bit 7 of the instruction [L1183]. Spends a pending MF.
void DeviceReports::report(Fault fault, const Telegram& t, std::uint8_t sub, Instant now, Out& out) {
    d_.wanted_.pending_group = 0;
    d_.flags_.err = true;
    const std::uint8_t cw = d_.manners_.error_keeps_bit7 ? t.cw : t.function();
    d_.history_.add({static_cast<std::uint8_t>(fault), cw, sub});
    if (!t.wants_ack() && !d_.manners_.unasked_errors) return;
    Telegram error;
    error.producer = d_.link_.node;
    error.consumer = t.producer;
    error.cw = ER;
    error.dl = 6;
    error.d = {0, static_cast<std::uint8_t>(fault), cw, sub, 0, 0, 0, 0};
    d_.link_.send(error, now, out);
}

}  // namespace axisgate::uim342::twin
