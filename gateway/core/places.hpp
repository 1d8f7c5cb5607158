// Decides which connection is closed when a door is full, counted per address, so that nobody loses a connection to the many connections of
// another. It never selects a connection that is one of the few over which its client can still stop a motion. The result is to accept the
// new connection, to close another one for it, or to refuse it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "gateway/core/instant.hpp"

namespace axisgate {

/// The holder of a connection: an IPv4 address, or the /64 network of an IPv6 one, because its lower half can be chosen freely.
using PlaceHolder = std::uint64_t;
/// `address` is IPv6, or IPv4 as ::ffff:a.b.c.d.
[[nodiscard]] PlaceHolder place_holder(const std::array<std::uint8_t, 16>& address) noexcept;

/// In the order in which they are closed.
enum class Standing : std::uint8_t {
    stranger,        ///< not signed in, has not commanded, and no work is in progress: silent, or half a request
    strangers_work,  ///< the same, during work that ends by itself soon
    known,           ///< signed in, or has commanded; no work is in progress
    knowns_work,     ///< the same, during work
    stop_path        ///< its client has started a motion over it
};

struct Guest {
    PlaceHolder holder = 0;
    Standing standing = Standing::stranger;
    Instant since{};  ///< time of its last data, or of its acceptance
};

struct PlaceRules {
    std::size_t strangers = 0;  ///< places for all clients
    std::size_t kept = 0;       ///< further ones, for known clients
    std::size_t paths = 16;     ///< number of a holder's newest stop paths that are never closed
};

struct PlaceVerdict {
    bool let_in = false;
    std::optional<std::size_t> closes;  ///< index of the connection that is closed for it; only with let_in
};

/// Idle connections of unknown clients are closed first, from the holder that has most connections, the one that has been silent for
/// longest; then those of known clients in the same way. A connection with work in progress is closed only if its holder has more than an
/// eighth of all places and more than 8. `known` refers to the new connection. `full`: there is no room for another reason (descriptors).
[[nodiscard]] PlaceVerdict find_place(std::span<const Guest> guests, PlaceHolder newcomer, bool known, const PlaceRules& rules,
                                      bool full = false);

}  // namespace axisgate
