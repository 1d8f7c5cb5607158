// Power: the control word's way from anywhere to operation enabled, and the acknowledgement of errors.
// In: the drive's state. Out: the next control word, or the end. Never enables what somebody froze: a frozen motion would go on.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr Duration enable_limit = std::chrono::seconds(5);
constexpr Duration look_again_for_power = std::chrono::milliseconds(10);
}  // namespace

Telegram Drive::control(std::uint16_t word) {
    cw_ = word;
    cw_known_ = true;
    return request16(id_, Main::control_word, 0, word);
}

/// 0 and 1 need bit 0 low once, 2 needs it high; 5 is passed in about 300 ms; 12 is left by /Abort.
std::optional<Telegram> Drive::power_request(Turn& t) {
    if (job_.limit == never) job_.limit = t.now + enable_limit;
    if (in_error()) {
        end_job(Outcome::refused, Reason::wrong_state, fmt::format("drive {} is in {}", title(), error_text()), t, status_.sub_state());
        return std::nullopt;
    }
    if (t.now >= job_.limit) {
        end_job(Outcome::failed, Reason::drive_refused,
                fmt::format("drive {} stays in {}; control word bits may be held by its inputs, its parameters or another tool", title(),
                            state_text()),
                t);
        return std::nullopt;
    }
    job_.not_before = t.now + look_again_for_power;
    switch (status_.state()) {
        case state::not_ready:
        case state::disabled:
        case state::freezing:
            return control(cw_off);
        case state::enabled:
            if (cw_ == cw_on) {
                to_target_ = false;
                demand_.rest(static_cast<double>(status_.position));
                tell(t);
                end_job(Outcome::accepted, Reason::none, {}, t);
                return std::nullopt;
            }
            return control(cw_on);
        case state::quick_stop:
            break;
        default:
            if (status_.state() >= state::enabled && status_.state() != state::aborting) {
                end_job(Outcome::accepted, Reason::none, state_text(), t);
                return std::nullopt;
            }
            if (cw_ != cw_on) return control(cw_on);
            break;
    }
    return request(id_, Main::response, 1);
}

/// Bit 7 rises while bit 0 is low, so that the drive rests in switch on disabled or ready afterwards.
std::optional<Telegram> Drive::reset_request(Turn& t) {
    switch (job_.step++) {
        case 0:
            if (!in_error()) {
                end_job(Outcome::accepted, Reason::none, {}, t);
                return std::nullopt;
            }
            if (status_.bit(bit::fatal)) {
                end_job(Outcome::refused, Reason::drive_refused,
                        fmt::format("drive {}: {} It is fatal and cannot be acknowledged.", title(), error_text()), t, status_.sub_state());
                return std::nullopt;
            }
            return control(status_.state() == state::setup_error ? cw_on : cw_off);
        case 1:
            return control(cw_off);
        case 2:
            return control(cw_off | cw_acknowledge);
        case 3:
            return control(cw_off);
        default:
            if (in_error())
                end_job(Outcome::refused, Reason::drive_refused, fmt::format("drive {} is still in {}", title(), error_text()), t,
                        status_.sub_state());
            else
                end_job(Outcome::accepted, Reason::none, {}, t);
            return std::nullopt;
    }
}

}  // namespace axisgate::linmot
