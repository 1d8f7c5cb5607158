// Twins runs the embedded drives on the twin bus of their line, stores their memory, and applies the tester's conditions with an event. It
// never reaches a real drive.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Twins {
public:
    Twins(Machine& machine, EngineHost& host, Publisher& publisher) : machine_(machine), host_(host), publisher_(publisher) {}
    void plug_in(Drive& drive, Instant now);
    void refit(Drive& drive, Instant now);
    void save_memory(Drive& drive);
    /// Null unless the drive is simulated now.
    [[nodiscard]] Twin* of(DriveId drive) const;
    /// Empty if the condition was set, otherwise the reason why not.
    [[nodiscard]] std::string use_hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin,
                                       Instant now);
    /// The memory of the twin that does not serve now. Empty, or the reason why not.
    [[nodiscard]] std::string adopt(DriveId drive, NonVolatile memory, const Origin& origin, Instant now);

private:
    Machine& machine_;
    EngineHost& host_;
    Publisher& publisher_;
};

}  // namespace axisgate::engine
