// Answers are sent in the order of the requests. Writes may be outstanding together, so that a slow write does not delay a stop behind it;
// a read waits for the writes before it.
#include "gateway/doors/modbus/session.hpp"
#include "gateway/doors/modbus/words.hpp"

#include <algorithm>

namespace axisgate::modbus {

Session::~Session() { abandon(); }

void Session::abandon() noexcept {
    if (count_ > 0) responder_.writer().forget(*this);
    count_ = 0;
}

void Session::put_header(std::uint8_t* adu, std::uint16_t transaction, std::uint8_t unit, std::size_t pdu_size) noexcept {
    put16(adu, transaction);
    put16(adu + 2, 0);
    put16(adu + 4, static_cast<std::uint16_t>(pdu_size + 1));
    adu[6] = unit;
}

Session::Work Session::work(Instant now, AnswerBuffer& out) {
    partial_ = false;
    at_once_ = 0;
    for (;;) {
        if (out.room() < max_adu) return Work::output_full;
        if (count_ > 0 && slots_[head_].late.outstanding == 0) {
            const Slot& slot = slots_[head_];
            std::uint8_t* const adu = out.bytes.data() + out.size;
            const std::size_t size = responder_.finish(slot.late, now, adu + mbap_size);
            if (size == 2 && (adu[mbap_size] & function::exception_bit) != 0) ++exceptions_;
            put_header(adu, slot.transaction, slot.late.unit, size);
            out.size += mbap_size + size;
            responder_.counters().request_times.observe(now - slot.begun);
            head_ = index(1);
            --count_;
            continue;
        }
        Adu adu;
        switch (framer_.peek(adu)) {
            case AduFramer::Verdict::need_more:
                partial_ = framer_.buffered() > 0;
                return Work::need_bytes;
            case AduFramer::Verdict::bad_protocol:
            case AduFramer::Verdict::bad_length:
                // The requests before the garbage are still answered.
                return count_ > 0 ? Work::waits_for_results : Work::not_modbus;
            case AduFramer::Verdict::adu:
                break;
        }
        if (count_ > 0) {
            const bool read_waits = slots_[index(count_ - 1)].late.reads;
            if (count_ == max_in_flight || read_waits || !Responder::may_overtake_waiting(adu.pdu)) return Work::waits_for_results;
        }
        framer_.pop();
        begin(adu, now, out);
    }
}

void Session::begin(const Adu& adu, Instant now, AnswerBuffer& out) {
    ++requests_;
    if (is_write(adu.pdu[0])) ++writes_;
    const std::size_t at = index(count_);
    Slot& slot = slots_[at];
    slot.transaction = adu.transaction;
    slot.begun = now;
    slot.late = {};
    std::uint8_t* const bytes = out.bytes.data() + out.size;
    const std::size_t size =
        responder_.answer(client_, static_cast<std::uint8_t>(at), adu.unit, adu.pdu, now, bytes + mbap_size, slot.late);
    if (size > 0 && count_ == 0) {
        if (size == 2 && (bytes[mbap_size] & function::exception_bit) != 0) ++exceptions_;
        put_header(bytes, adu.transaction, adu.unit, size);
        out.size += mbap_size + size;
        ++at_once_;
        return;
    }
    if (size > 0) {  // known already, but earlier answers are not: it is queued behind them
        slot.late.unit = adu.unit;
        slot.late.outstanding = 0;
        slot.late.reads = false;
        slot.late.exception = Exception::none;
        slot.late.echo_size = static_cast<std::uint8_t>(size);
        std::copy_n(bytes + mbap_size, size, slot.late.echo.begin());
    }
    ++count_;
}

void Session::on_written(std::uint8_t slot, AxisId axis, Verdict verdict) {
    slots_[slot].late.on_written(exception_of(verdict));
    if (verdict == Verdict::good) {
        const std::uint16_t number = responder_.port().image().picture(axis).number;
        if (number < commanded_.size()) commanded_.set(number);
    }
    if (slot == head_ && slots_[slot].late.outstanding == 0) waker_.wake(*this);
}

bool Session::commands_now(const Image& image) const {
    if (count_ > 0) return true;
    if (commanded_.none()) return false;
    for (std::size_t number = 1; number < commanded_.size(); ++number) {
        if (!commanded_[number]) continue;
        const AxisId id = image.by_number(static_cast<std::uint32_t>(number));
        if (id == no_axis) continue;
        const AxisPicture& p = image.picture(id);
        // Its lease may have ended while the axis still moves by its command.
        const bool by_modbus = p.authority == clients || std::string_view(p.authority_commander.data()).starts_with("modbus ");
        if ((p.flags & flag_moving) != 0 && by_modbus) return true;
    }
    return false;
}

}  // namespace axisgate::modbus
