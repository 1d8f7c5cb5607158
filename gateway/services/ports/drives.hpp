// Drive port: who serves a drive now, and the tester's hand of its twin.
// In: drives, items of the hand. Out: the status at once; the hand by callbacks on the service thread.
// Never touches a real drive.
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
    /// The tester's hand of a twin; nothing if the drive is not simulated now.
    virtual void hand(DriveId drive, std::function<void(std::optional<std::vector<HandItem>>)> then) = 0;
    /// Sets several items, all or none; empty: good, else what is wrong.
    virtual void set_hand(DriveId drive, std::vector<std::pair<std::string, Value>> items, Origin origin,
                          std::function<void(std::string)> then) = 0;
};

}  // namespace axisgate
