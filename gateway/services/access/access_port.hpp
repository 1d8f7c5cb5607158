// The services that access control needs from outside: the register of accounts, a place that computes hashes, and a store for records. The
// runtime implements it, and a fake in tests. Callbacks come on the door's own executor. Bound: few hashes may wait, because each takes 64
// MiB and a tenth of a second; further ones are refused.
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
    /// Returns false if too many wait; `then` is not called then. An empty hash means that it could not be computed.
    [[nodiscard]] virtual bool derive(std::string password, std::function<void(std::string hash)> then) = 0;
    [[nodiscard]] virtual bool compare(std::string password, std::string hash, std::function<void(bool fits)> then) = 0;
    /// Stores all records in order; an empty `fault` means that they are on the disk.
    virtual void keep(std::vector<AccessRecord> records, std::string who, std::function<void(std::string fault)> then) = 0;
    /// Reports an event of kind "access".
    virtual void note(Event event) = 0;
    /// All changes of users and tokens pass this queue one after the other, so that they come into force in the order in which they are
    /// stored.
    std::shared_ptr<ChangeQueue> changes = std::make_shared<ChangeQueue>();
    bool uses_wait = false;  ///< a job for all uses since the last one is in that queue
};

}  // namespace axisgate
