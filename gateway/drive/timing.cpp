// In LineTiming zero (retries: -1) means that the site gives no value. A value outside its range is limited without a report, because the
// check of the site has reported it.
#include "gateway/drive/timing.hpp"

#include <algorithm>

namespace axisgate::drive {

Timing timing_of(const LineTiming& site, const Timing& defaults) noexcept {
    const auto or_else = [](Duration reported, Duration otherwise) { return reported > Duration::zero() ? reported : otherwise; };
    Timing t;
    t.reply_timeout = or_else(site.reply_timeout, defaults.reply_timeout);
    t.poll_period = or_else(site.poll_period, defaults.poll_period);
    t.pause = or_else(site.pause, std::max(defaults.pause, Duration::zero()));
    t.retries = site.retries < 0 ? defaults.retries : std::min(site.retries, 10);
    t.silent_limit = std::clamp(site.silent_limit, 1, 1000);
    t.pause_min = or_else(site.retry_pause_min, defaults.pause_min);
    t.pause_max = std::max(t.pause_min, or_else(site.retry_pause_max, defaults.pause_max));
    return t;
}

std::size_t fitting(Duration time, Duration exchange, std::size_t least, std::size_t most) noexcept {
    if (exchange <= Duration::zero()) return most;
    return static_cast<std::size_t>(
        std::clamp<std::int64_t>(time / exchange, static_cast<std::int64_t>(least), static_cast<std::int64_t>(most)));
}

}  // namespace axisgate::drive
