// The state of the recorder, its stored files, and the trends of axes over a period. The disk is not waited for.
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
/// The state of the recorder, its memory, and the list of stored recordings.
[[nodiscard]] boost::json::object recorder_document(RecorderPort& recorder, const ClockPort& clock);

/// Instants, ms since 1970.
struct RecordedStretch {
    std::int64_t from_ms = 0, to_ms = 0;
};
/// The trends of the axes with these names, in columns.
[[nodiscard]] Refusable<std::vector<TrendAxis>> trends_of(RecorderPort& recorder, const ClockPort& clock, const SiteState& site,
                                                          std::span<const std::string> names, RecordedStretch stretch, std::size_t columns);

}  // namespace axisgate
