// Recording documents: what is recorded, what is kept of it, and the trends of axes over a stretch of time.
// In: states of the recorder, the site, instants. Out: JSON, trends by axis. Never waits for the disk.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/recorder.hpp"
#include "gateway/services/recorder/trend_document.hpp"
#include "gateway/services/refusal.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

[[nodiscard]] boost::json::object recording_document(const RecordingInfo& info);
/// What is recorded now, how much room there is, and the list of what is kept.
[[nodiscard]] boost::json::object recorder_document(RecorderPort& recorder, const ClockPort& clock);

/// Instants, ms since 1970.
struct RecordedStretch {
    std::int64_t from_ms = 0, to_ms = 0;
};
/// The trends of the axes with these names, in columns.
[[nodiscard]] Refusable<std::vector<TrendAxis>> trends_of(RecorderPort& recorder, const ClockPort& clock, const SiteState& site,
                                                          std::span<const std::string> names, RecordedStretch stretch, std::size_t columns);

}  // namespace axisgate
