// A sample counts if it comes from the side that serves the axis now and is not older than the present one. Reads of the database are local
// and short.
#include "gateway/runtime/warm_parameters.hpp"

#include "gateway/runtime/clock.hpp"

namespace axisgate {
namespace {
constexpr std::size_t sample_ring = 8192;

std::uint64_t live_key(AxisId axis, Point p) noexcept {
    return (std::uint64_t{index_of(axis)} << 32) | (std::uint64_t{p.parameter} << 16) | p.element;
}
AxisId axis_of(std::uint64_t live_key) noexcept { return AxisId{static_cast<std::uint16_t>(live_key >> 32)}; }
}  // namespace

WarmParameters::WarmParameters(const WarmThreads& threads, const AxisPort& axes)
    : threads_(threads), axes_(axes), samples_(sample_ring, threads.bell, [this](Sample&& s) { take(std::move(s)); }) {}

void WarmParameters::on_site(const std::shared_ptr<const SiteState>&) {
    std::erase_if(live_, [this](const auto& entry) { return axes_.picture(axis_of(entry.first)).source != entry.second.source; });
}

/// Reports of a former drive of the axis may still be on their way here when another one serves it.
void WarmParameters::take(Sample&& s) {
    if (axes_.picture(s.axis).source != s.source) return;
    Reported& known = live_[live_key(s.axis, s.point)];
    if (known.source == s.source && known.at > s.at) return;
    const auto listeners = listeners_;
    for (auto* l : listeners)
        l->on_sample(s);
    known = {{std::move(s.value), unix_ns_of(s.at), s.quality}, s.source, s.at};
}

LiveParameter WarmParameters::live(AxisId axis, Point point) const {
    const auto it = live_.find(live_key(axis, point));
    if (it == live_.end()) return {};
    const AxisPicture now = axes_.picture(axis);
    if (now.source != it->second.source) return {};
    LiveParameter out = it->second.what;
    // The value was reported as good, but the axis is offline now.
    if (out.quality == Quality::good && (now.flags & flag_online) == 0) out.quality = Quality::stale;
    return out;
}

std::vector<StoredParameter> WarmParameters::stored(const std::string& axis) const {
    std::vector<StoredParameter> out;
    if (const auto rows = threads_.reader.stored(axis)) out.assign(rows->begin(), rows->end());
    return out;
}

std::vector<StoredParameter> WarmParameters::history(const std::string& axis, const std::string& parameter, std::size_t limit) const {
    std::vector<StoredParameter> out;
    if (const auto rows = threads_.reader.history(axis, parameter, limit)) out.assign(rows->begin(), rows->end());
    return out;
}

}  // namespace axisgate
