// A capture as JSON and CSV, in the units of its axes, with seconds counted from its trigger. Reported values are never rounded.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <string>
#include <vector>

#include "gateway/services/recorder/capture.hpp"

namespace axisgate {

/// A requested capture, with the data for its document.
struct CaptureOrder {
    struct Axis {
        std::string name, unit;
        double scale = 1;  ///< increments per unit
    };
    std::string name, who;
    CaptureWish wish;
    std::vector<Axis> axes;  ///< in the order of wish.axes
    std::string line;
};

/// Its properties without its rows.
[[nodiscard]] boost::json::object capture_summary(const CaptureOrder& order, const Capture& capture, std::int64_t unix_offset_ns);
/// Its rows, one object per axis with a column per point; null where it was unknown.
[[nodiscard]] boost::json::array capture_columns(const CaptureOrder& order, const Capture& capture);
/// CSV of such columns, a row per report of a drive.
[[nodiscard]] std::string capture_csv(const boost::json::array& columns);

}  // namespace axisgate
