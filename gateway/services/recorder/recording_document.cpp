// Times are texts, unknown values are null.
#include "gateway/services/recorder/recording_document.hpp"

#include "gateway/core/text.hpp"
#include "gateway/services/axis_place.hpp"

namespace axisgate {
namespace json = boost::json;

json::object recording_document(const RecordingInfo& i) {
    const auto time_or_null = [](std::int64_t ns) { return ns == 0 ? json::value(nullptr) : json::value(format_time(ns)); };
    return {{"name", i.name},
            {"at", time_or_null(i.at_unix_ns)},
            {"from", time_or_null(i.from_unix_ns)},
            {"to", time_or_null(i.to_unix_ns)},
            {"bytes", i.bytes},
            {"why", text_or_null(i.why)},
            {"who", text_or_null(i.who)},
            {"version", text_or_null(i.version)},
            {"automatic", i.automatic},
            {"replayable", i.fault.empty() && i.not_replayable.empty()},
            {"not_replayable", text_or_null(i.not_replayable)},
            {"fault", text_or_null(i.fault)}};
}

json::object recorder_document(RecorderPort& recorder, const ClockPort& clock) {
    const auto s = recorder.recorder_state();
    json::array list;
    for (const auto& i : recorder.recordings())
        list.push_back(recording_document(i));
    return {{"from", s.from ? json::value(format_time(clock.to_unix_ns(*s.from))) : json::value(nullptr)},
            {"bytes", s.bytes},
            {"most_bytes", s.bound},
            {"lost", s.lost},
            {"replayable", s.not_replayable.empty()},
            {"not_replayable", text_or_null(s.not_replayable)},
            {"trend_bytes", s.trend_bytes},
            {"trend_most_bytes", s.trend_bound},
            {"trend_minutes", s.trend_minutes},
            {"disk_bytes", s.disk_bytes},
            {"disk_most_bytes", s.disk_bound},
            {"disk_fault", text_or_null(s.disk_fault)},
            {"recordings", std::move(list)}};
}

Refusable<std::vector<TrendAxis>> trends_of(RecorderPort& recorder, const ClockPort& clock, const SiteState& site,
                                            std::span<const std::string> names, RecordedStretch stretch, std::size_t columns) {
    const std::int64_t offset = clock.to_unix_ns(at_ns(0));
    std::vector<TrendAxis> axes;
    for (const auto& name : names) {
        const auto i = index_of_name(site.site.axes, name);
        if (!i || *i >= site.axis_ids.size()) return no_such("axis", name);
        const AxisSpec& spec = site.site.axes[*i];
        axes.push_back({name, spec.unit, spec.increments_per_unit,
                        recorder.trend(site.axis_ids[*i], at_ns(saturated_difference(stretch.from_ms * 1'000'000, offset)),
                                       at_ns(saturated_difference(stretch.to_ms * 1'000'000, offset)), columns)});
    }
    return axes;
}

}  // namespace axisgate
