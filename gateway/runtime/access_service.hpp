// The HTTP door's AccessPort: users and tokens from the store, hashes on a thread of their own, records to the storage thread. Called on
// the service thread, which also runs the callbacks. Bound: 8 hashes wait or run; further ones are refused. The thread starts with the
// first hash, so a gateway without sign-ins has none.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gateway/runtime/cold.hpp"
#include "gateway/services/access/access_port.hpp"
#include "gateway/store/store.hpp"

namespace axisgate {

/// The name of the session cookie for the gateway with this data directory: "axisgate_session_" and eight digits, the same after a restart,
/// and different for every other gateway that a browser may reach under the same host name.
[[nodiscard]] std::string session_cookie_of(const std::string& data_dir);

class AccessService final : public AccessPort {
public:
    using Note = std::function<void(Event)>;
    AccessService(boost::asio::io_context& warm, Cold& cold, AccessSettings settings, Note note);
    ~AccessService() override;

    /// Reads the stored accounts; called before the threads run. Without users it makes the code of the first sign-in, if there is none yet
    /// or `new_code` is set, and returns it in `code`, which is the only time at which it can be read. Empty if good, otherwise the fault.
    [[nodiscard]] std::string load(Store& store, bool new_code, std::string& code);

    /// True if the code that load() made is on the disk; called until it is. Before that it is not valid: a start that fails earlier leaves
    /// the next one to make and show another.
    [[nodiscard]] bool code_is_kept();

    [[nodiscard]] AccessRegister& accounts() override { return accounts_; }
    [[nodiscard]] bool derive(std::string password, std::function<void(std::string)> then) override;
    [[nodiscard]] bool compare(std::string password, std::string hash, std::function<void(bool)> then) override;
    void keep(std::vector<AccessRecord> records, std::string who, std::function<void(std::string)> then) override;
    void note(Event event) override { note_(std::move(event)); }
    /// Waits for the hash that is being computed; waiting ones are not started.
    void stop();

private:
    template <class Make, class Then>
    bool work(Make make, Then then);

    boost::asio::io_context& warm_;
    Cold& cold_;
    AccessRegister accounts_;
    Note note_;
    std::unique_ptr<boost::asio::thread_pool> pool_;
    std::size_t waiting_ = 0;
    std::optional<AccessRecord> new_code_;  ///< made by this start, and not on the disk yet
    bool keeping_code_ = false;
};

}  // namespace axisgate
