// The one master of the line, its addresses and its answers. A serial line has one request at a time: any data after a request end the
// permission to answer it, because two nodes would send at once. Writes without an answer continue.
#include "gateway/doors/modbus/rtu_session.hpp"

#include <algorithm>

namespace axisgate::modbus {
namespace {
/// A broadcast may only write. Function 23 also reads, and could not be answered.
constexpr bool may_be_broadcast(std::uint8_t f) noexcept {
    return f == function::write_single_coil || f == function::write_single_register || f == function::write_multiple_coils ||
           f == function::write_multiple_registers || f == function::mask_write_register;
}
}  // namespace

RtuSession::~RtuSession() { responder_.writer().forget(*this); }

std::optional<std::uint8_t> RtuSession::unit_of(std::uint8_t address) const noexcept {
    constexpr std::uint8_t standard = 1;
    if (address == broadcast) return unit_of(address_);
    const bool of_site = address > standard && address <= last_address && image_.unit(address) != nullptr && !image_.is_standard(address);
    if (of_site) return address;
    if (address == address_) return standard;
    return std::nullopt;
}

void RtuSession::on_frame(const RtuFrame& frame, Instant now, bool overtaken) {
    give_up();
    const auto unit = unit_of(frame.address);
    if (!unit) return counters_.foreign.add();
    received_ = begun_ = now;
    const std::uint8_t f = frame.bytes[0];
    if (is_write(f)) counters_.writes.add();
    late_ = {};
    ++generation_;
    if (frame.address == broadcast) {
        counters_.broadcasts.add();
        if (!may_be_broadcast(f)) return;
        (void)responder_.answer(client_, generation_, *unit, frame.pdu(), now, out_.data() + 1, late_);
        late_ = {};
        return;
    }
    const std::size_t size = responder_.answer(client_, generation_, *unit, frame.pdu(), now, out_.data() + 1, late_);
    if (overtaken) return counters_.late_answers.add();
    if (size > 0) return send(frame.address, size, frame.pdu());
    asked_ = frame;
    waits_ = true;
}

void RtuSession::on_written(std::uint8_t slot, AxisId /*axis*/, Verdict verdict) {
    if (verdict == Verdict::good) commanded_ = true;
    if (!waits_ || slot != generation_) return;
    late_.on_written(exception_of(verdict));
    if (late_.outstanding == 0) sink_.answered();
}

void RtuSession::finish(Instant now) {
    if (!waits_ || late_.outstanding > 0) return;
    waits_ = false;
    send(asked_.address, responder_.finish(late_, now, out_.data() + 1), asked_.pdu());
}

void RtuSession::give_up() noexcept {
    if (!waits_) return;
    waits_ = false;
    counters_.late_answers.add();
}

void RtuSession::send(std::uint8_t address, std::size_t pdu_size, std::span<const std::uint8_t> request) {
    out_[0] = address;
    const auto body = std::span(out_).first(1 + pdu_size);
    const std::uint16_t crc = rtu_crc(body);
    out_[1 + pdu_size] = static_cast<std::uint8_t>(crc & 0xFF);
    out_[2 + pdu_size] = static_cast<std::uint8_t>(crc >> 8);
    counters_.answers.add();
    responder_.counters().request_times.observe(responder_.port().now() - begun_);
    sink_.send(std::span(out_).first(3 + pdu_size), std::ranges::equal(body.subspan(1), request));
}

}  // namespace axisgate::modbus
