// The sequence of control words from any state to operation enabled, and the acknowledgement of errors. A drive that another master has
// frozen is not enabled, because the frozen motion would continue.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr Duration enable_limit = std::chrono::seconds(5);  ///< of a drive that answers at once
constexpr int enable_exchanges = 8;                         ///< that may take as long as the line permits
constexpr int looks_per_word = 6;                           ///< then the control word is written again, which has no effect in the drive
constexpr Duration look_again_for_state = std::chrono::milliseconds(10);
}  // namespace

Telegram ControlWord::write(std::uint16_t word) {
    word_ = word;
    known_ = true;
    return request16(drive_.id(), Main::control_word, 0, word);
}

void ControlWord::shown(const Status& s) noexcept {
    if (std::exchange(known_, true)) return;
    // [O-27]
    word_ = static_cast<std::uint16_t>(0x0030 | (s.bit(1) ? 1 : 0) | (s.bit(4) ? 2 : 0) | (s.bit(5) ? 4 : 0) | (s.bit(2) ? 8 : 0) |
                                       (s.state() == state::homing ? cw_home : 0));
    if (s.state() == state::aborting) word_ = static_cast<std::uint16_t>(word_ & ~cw_abort);
}

/// States 0 and 1 need bit 0 low once, state 2 needs it high; state 5 ends after about 300 ms; state 12 is left by /Abort.
std::optional<Telegram> Power::request(Turn& t) {
    Feedback& feedback = drive_.feedback;
    ControlWord& control = drive_.control;
    const Status& s = feedback.status();
    if (job().limit == never) job().limit = t.now + enable_limit + enable_exchanges * drive_.bus.timing.reply_timeout;
    if (feedback.in_error())
        return refused(Reason::wrong_state, fmt::format("drive {} is in {}", drive_.title(), feedback.error_text()), t, s.sub_state());
    if (feedback.error_kept())
        return refused(Reason::wrong_state,
                       fmt::format("drive {} has braked by an error and was switched off before it showed which: reset the fault first",
                                   drive_.title()),
                       t);
    if (t.now >= job().limit) {
        drive_.stops.take_back(Disable{}, t);  // an order that is answered as failed must not be carried out later
        fail(Reason::drive_refused,
             fmt::format("drive {} stays in {}; control word bits may be held by its inputs, its parameters or another tool",
                         drive_.title(), feedback.state_text()),
             t);
        return std::nullopt;
    }
    job().not_before = t.now + look_again_for_state;
    switch (s.state()) {
        case state::not_ready:
        case state::disabled:
        case state::freezing:
            return control.write(cw_off);
        case state::enabled:
            if (control.word() == cw_on) {
                drive_.motion.no_target();
                drive_.demand.rest(s.position);
                feedback.publish(t);
                accept({}, t);
                return std::nullopt;
            }
            return control.write(cw_on);
        case state::quick_stop:
            break;
        default:
            if (s.state() >= state::enabled && s.state() != state::aborting) {
                accept(feedback.state_text(), t);
                return std::nullopt;
            }
            // A response that nobody has asked for may have been taken for the answer to a control word that was lost. Beside a periodic
            // telegram of another master each sixth request may be the one that is lost.
            if (control.word() != cw_on || ++job().step % (drive_.bus.shared.shared(t.now) ? 1 : looks_per_word) == 0)
                return control.write(cw_on);
            break;
    }
    return linmot::request(drive_.id(), Main::response, 1);
}

/// Bit 7 rises while bit 0 is low, so that the drive ends in switch on disabled or ready.
std::optional<Telegram> FaultReset::request(Turn& t) {
    const Feedback& feedback = drive_.feedback;
    ControlWord& control = drive_.control;
    const Status& s = feedback.status();
    switch (job().step++) {
        case 0:
            if (!feedback.in_error()) {
                if (feedback.error_kept()) {
                    drive_.feedback.error_reset();
                    drive_.feedback.publish(t);
                }
                accept({}, t);
                return std::nullopt;
            }
            if (s.bit(bit::fatal))
                return refused(Reason::drive_refused,
                               fmt::format("drive {}: {} It is fatal and cannot be acknowledged.", drive_.title(), feedback.error_text()),
                               t, s.sub_state());
            return control.write(s.state() == state::setup_error ? cw_on : cw_off);
        case 1:
            return control.write(cw_off);
        case 2:
            return control.write(cw_off | cw_acknowledge);
        case 3:
            return control.write(cw_off);
        default:
            if (job().limit == never) job().limit = t.now + shown_within;
            if (feedback.in_error() && t.now < job().limit) {
                job().not_before = t.now + look_again_for_state;
                return linmot::request(drive_.id(), Main::response, 1);
            }
            if (feedback.in_error())
                return refused(Reason::drive_refused, fmt::format("drive {} is still in {}", drive_.title(), feedback.error_text()), t,
                               s.sub_state());
            accept({}, t);
            return std::nullopt;
    }
}

}  // namespace axisgate::linmot
