// Notices limits how many notices one drive sends to the journal, so that a chattering input cannot fill it: 20 at once and 10 per second;
// alarms always pass. The next notice states how many were omitted.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

class Notices {
public:
    static constexpr int at_once = 20;
    static constexpr Duration refill = std::chrono::milliseconds(100);  ///< time after which one more notice is allowed

    explicit Notices(DriveId drive = no_drive) noexcept : drive_(drive) {}

    void tell(Severity severity, AxisId axis, std::string_view kind, std::int32_t code, std::string text, Instant now, Out& out);
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }  ///< since the last notice that was sent

private:
    DriveId drive_;
    int tokens_ = at_once;
    Instant refilled_{};
    std::uint64_t left_out_ = 0;
};

}  // namespace axisgate::drive
