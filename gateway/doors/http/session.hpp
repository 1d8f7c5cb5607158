// Session: what a server sees of one open socket, be it plain requests or the live feed; and what a session sees of its server.
// In and out: interfaces alone.
// The bytes go through `Transport`, plain or TLS.
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

/// Of what large answers and bodies hold of the memory, all connections together.
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
    /// Whose it is, and whether it may be closed to make room for another.
    [[nodiscard]] virtual Guest guest() const = 0;
    /// Ends after what is in progress; at once if nothing is.
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
    std::shared_ptr<TlsIdentity> tls;  ///< nothing: plain HTTP
    bool stopping = false;
    ByteBudget budget;
    std::shared_ptr<Later> later;  ///< for what moves nothing

    virtual void add(std::shared_ptr<Session> session) = 0;
    virtual void remove(const Session* session) = 0;
    SessionHost(const Settings& s, const Router& r, Counters& c, StreamHub& h, std::shared_ptr<Later> l)
        : settings(s), router(r), counters(c), hub(h), later(std::move(l)) {}
    SessionHost(const SessionHost&) = delete;
    SessionHost& operator=(const SessionHost&) = delete;
    virtual ~SessionHost() = default;
};

/// The steady clock as the pure parts of this door take it.
[[nodiscard]] inline Instant steady_instant() { return Instant{std::chrono::steady_clock::now().time_since_epoch()}; }

}  // namespace axisgate::http
