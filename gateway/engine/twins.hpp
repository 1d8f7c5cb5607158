// Twins: the embedded drives on their line's twin bus.
// In: drives that are simulated, the tester's hand. Out: twins plugged in with their memory, memories to keep, events of the hand.
// Never reaches a real drive.
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
    /// Empty: it is set; else why not.
    [[nodiscard]] std::string use_hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin,
                                       Instant now);

private:
    Machine& machine_;
    EngineHost& host_;
    Publisher& publisher_;
};

}  // namespace axisgate::engine
