#include "gateway/drive/notices.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::drive {

void Notices::tell(Severity severity, AxisId axis, std::string_view kind, std::int32_t code, std::string text, Instant now, Out& out) {
    if (severity != Severity::alarm) {
        if (const auto earned = (now - refilled_) / refill; earned > 0) {
            tokens_ = static_cast<int>(std::min<std::int64_t>(at_once, tokens_ + std::min<std::int64_t>(earned, at_once)));
            refilled_ = now;
        }
        if (tokens_ == 0) {
            ++left_out_;
            return;
        }
        --tokens_;
        if (left_out_ != 0) {
            text += fmt::format(" ({} more were not told: too many in a second)", left_out_);
            left_out_ = 0;
        }
    }
    out.notices.push_back({severity, drive_, axis, std::string(kind), code, std::move(text), now});
}

}  // namespace axisgate::drive
