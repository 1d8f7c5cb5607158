// The side that serves a drive now, and the tester's conditions of its twin. The status is returned at once, conditions by callbacks on the
// service thread. A real drive is never reached.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/engine/report.hpp"

namespace axisgate {

class DrivePort {
public:
    virtual ~DrivePort() = default;
    [[nodiscard]] virtual DriveStatus drive_status(DriveId drive) const = 0;
    /// The conditions of a twin; empty if the drive is not simulated now.
    virtual void hand(DriveId drive, std::function<void(std::optional<std::vector<HandItem>>)> then) = 0;
    /// Sets several conditions, all or none; empty if good, otherwise the fault.
    virtual void set_hand(DriveId drive, std::vector<std::pair<std::string, Value>> items, Origin origin,
                          std::function<void(std::string)> then) = 0;
    /// The twin of a real drive starts with this memory when the drive is away next; empty if good, otherwise the fault.
    virtual void adopt(DriveId drive, NonVolatile memory, Origin origin, std::function<void(std::string)> then) {
        (void)drive, (void)memory, (void)origin;
        then("this gateway has no twins");
    }
};

}  // namespace axisgate
