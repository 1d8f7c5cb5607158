// Access port: what the HTTP door needs from outside to know people: the register of accounts, a place that computes hashes, a place that
// keeps records. In: passwords, records, events. Out: callbacks on the door's own executor. Implemented by the runtime, and by a fake in
// tests. Bound: few hashes wait (each takes 64 MiB and a tenth of a second); one more is not taken.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/event.hpp"
#include "gateway/core/records.hpp"
#include "gateway/services/access/access_register.hpp"
#include "gateway/services/change_queue.hpp"

namespace axisgate {

class AccessPort {
public:
    virtual ~AccessPort() = default;
    [[nodiscard]] virtual AccessRegister& accounts() = 0;
    /// False: too many wait; `then` is not called. An empty hash: it could not be made.
    [[nodiscard]] virtual bool derive(std::string password, std::function<void(std::string hash)> then) = 0;
    [[nodiscard]] virtual bool compare(std::string password, std::string hash, std::function<void(bool fits)> then) = 0;
    /// Stores all of them, in order; `fault` empty: they are on the disk.
    virtual void keep(std::vector<AccessRecord> records, std::string who, std::function<void(std::string fault)> then) = 0;
    /// An event of kind "access".
    virtual void note(Event event) = 0;
    /// All that is stored of users and tokens goes through here, one after the other: what was put in the store later is later in force.
    std::shared_ptr<ChangeQueue> changes = std::make_shared<ChangeQueue>();
    bool uses_wait = false;  ///< in that queue: one job for all that came since the last
};

}  // namespace axisgate
