// Capture document: a capture as JSON and CSV, in the units of its axes, seconds counted from its trigger.
// In: a capture with the names of its axes; or its document. Out: documents. Never rounds what a drive has said.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <string>
#include <vector>

#include "gateway/services/recorder/capture.hpp"

namespace axisgate {

/// A capture that is wanted, with what is shown of it.
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

/// What is known of it without its rows.
[[nodiscard]] boost::json::object capture_summary(const CaptureOrder& order, const Capture& capture, std::int64_t unix_offset_ns);
/// Its rows, an object per axis with a column per point; null where it was not known.
[[nodiscard]] boost::json::array capture_columns(const CaptureOrder& order, const Capture& capture);
/// A row per word of a drive, of such columns.
[[nodiscard]] std::string capture_csv(const boost::json::array& columns);

}  // namespace axisgate
