// EMCY (CiA 301, 7.2.7): the message with which a node reports an error or the end of all errors; its codes in words; a rate limit.
// A frame gives the code, the error register and the manufacturer's bytes. Words exist for the code classes of the standard and of CiA
// 402; the manufacturer's own codes are in the catalogue of the drive.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen {

struct Emergency {
    std::uint16_t code = 0;           ///< 0000h: no error any more
    std::uint8_t error_register = 0;  ///< object 1001h
    std::array<std::uint8_t, 5> maker{};
    bool operator==(const Emergency&) const = default;
};
/// Nothing unless the frame is an EMCY of this node with eight bytes.
[[nodiscard]] std::optional<Emergency> emergency_of(const Frame& frame, std::uint8_t node) noexcept;
[[nodiscard]] Frame emergency_frame(std::uint8_t node, const Emergency& emergency) noexcept;
/// The most specific class of the standards that contains the code: "heartbeat or life guarding error", "current"; empty if there is none.
[[nodiscard]] std::string_view words_of_error(std::uint16_t code) noexcept;
/// "8130h heartbeat or life guarding error, register 11h (generic, communication)", "no error any more".
[[nodiscard]] std::string to_text(const Emergency& emergency);

/// Lets through at most `burst` messages of a node in any `window`, and counts the others.
class EmergencyGate {
public:
    explicit EmergencyGate(int burst = 8, Duration window = std::chrono::seconds(1)) noexcept : burst_(burst), window_(window) {}
    /// Whether the message is to be reported. At most one more than `burst` in a window: the end of an error that was reported.
    [[nodiscard]] bool admits(const Emergency& emergency, Instant now) noexcept {
        if (now >= end_) {
            end_ = now + window_;
            seen_ = 0;
        }
        // If the last reported message was an error, its end is always reported: otherwise the node would seem faulty for ever.
        const bool end_of_errors = emergency.code == 0 && last_published_ != 0;
        if (end_of_errors || seen_ < burst_) {
            seen_ += seen_ < burst_ ? 1 : 0;
            last_published_ = emergency.code;
            return true;
        }
        ++kept_back_;
        return false;
    }
    [[nodiscard]] std::uint64_t kept_back() const noexcept { return kept_back_; }
    /// The number of suppressed messages since the last call.
    [[nodiscard]] std::uint64_t take_kept_back() noexcept { return kept_back_ - std::exchange(taken_, kept_back_); }

private:
    int burst_;
    Duration window_;
    int seen_ = 0;
    std::uint16_t last_published_ = 0;
    Instant end_{};
    std::uint64_t kept_back_ = 0, taken_ = 0;
};

}  // namespace axisgate::canopen
