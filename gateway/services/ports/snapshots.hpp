// Stored sets of an axis' parameter values, by number. Results come by callbacks on the service thread. Drives are neither read nor
// written.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/records.hpp"

namespace axisgate {

class SnapshotPort {
public:
    virtual ~SnapshotPort() = default;
    /// In order of n, without their values.
    [[nodiscard]] virtual std::vector<SnapshotInfo> snapshots(const std::string& axis) const = 0;
    [[nodiscard]] virtual std::optional<AxisSnapshot> snapshot(const std::string& axis, std::uint32_t n) const = 0;
    /// `then` gets its number, or 0 and the reason why it could not be stored; `axis_gone`: the axis was removed before.
    virtual void save_snapshot(AxisSnapshot snapshot, std::string axis,
                               std::function<void(std::uint32_t n, std::string fault, bool axis_gone)> then) = 0;
    virtual void delete_snapshot(std::string axis, std::uint32_t n, std::function<void(std::string fault)> then) = 0;
};

}  // namespace axisgate
