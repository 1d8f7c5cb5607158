// The interface between the server and one open socket, for plain requests and for the live feed. The bytes go through `Transport`, plain
// or TLS.
#pragma once

#include <chrono>
#include <memory>

#include "gateway/core/instant.hpp"
#include "gateway/core/places.hpp"
#include "gateway/doors/http/counters.hpp"
#include "gateway/doors/http/later.hpp"
#include "gateway/doors/http/router.hpp"
#include "gateway/doors/http/settings.hpp"
#include "gateway/doors/http/stream_hub.hpp"
#include "gateway/doors/http/tls.hpp"
#include "gateway/doors/http/transport.hpp"

namespace axisgate::http {

/// The memory of large answers and bodies, of all connections together.
struct ByteBudget {
    std::size_t most = 0, held = 0;
    [[nodiscard]] bool take(std::size_t bytes) noexcept {
        if (bytes > most - held) return false;
        held += bytes;
        return true;
    }
    void give_back(std::size_t& bytes) noexcept {
        held -= bytes;
        bytes = 0;
    }
};

using SteadyTime = std::chrono::steady_clock::time_point;

struct Session {
    /// Its holder, and whether it may be closed for another connection.
    [[nodiscard]] virtual Guest guest() const = 0;
    /// Ends after the work in progress; at once if there is none.
    virtual void stop() = 0;
    /// Ends now.
    virtual void abort() = 0;
    virtual ~Session() = default;
};

/// Kept alive by its sessions.
struct SessionHost {
    const Settings& settings;
    const Router& router;
    Counters& counters;
    StreamHub& hub;
    std::shared_ptr<TlsIdentity> tls;  ///< null: plain HTTP
    bool stopping = false;
    ByteBudget budget;
    std::shared_ptr<Later> later;  ///< for requests that move nothing

    virtual void add(std::shared_ptr<Session> session) = 0;
    virtual void remove(const Session* session) = 0;
    SessionHost(const Settings& s, const Router& r, Counters& c, StreamHub& h, std::shared_ptr<Later> l)
        : settings(s), router(r), counters(c), hub(h), later(std::move(l)) {}
    SessionHost(const SessionHost&) = delete;
    SessionHost& operator=(const SessionHost&) = delete;
    virtual ~SessionHost() = default;
};

/// The steady clock in the form of the pure parts of this door.
[[nodiscard]] inline Instant steady_instant() { return Instant{std::chrono::steady_clock::now().time_since_epoch()}; }

}  // namespace axisgate::http
