// Places: who gives way when a door is full: counted per address, so that nobody is driven out by another's many connections.
// In: the connections that are open, as values; whose the new one is. Out: let it in, close that one for it, or refuse it.
// Never closes anything itself, and never names a connection that is one of the few paths on which its client can still stop what moves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "gateway/core/instant.hpp"

namespace axisgate {

/// Whose connection it is: an IPv4 address, or the /64 network of an IPv6 one, since its lower half is anybody's to choose.
using PlaceHolder = std::uint64_t;
/// `address`: IPv6, or IPv4 as ::ffff:a.b.c.d.
[[nodiscard]] PlaceHolder place_holder(const std::array<std::uint8_t, 16>& address) noexcept;

/// In the order in which they give way.
enum class Standing : std::uint8_t {
    stranger,        ///< nobody has signed in on it, or commanded, and nothing is being worked on: silent, or half a request
    strangers_work,  ///< the same, in the middle of something that ends by itself soon
    known,           ///< signed in, or has commanded; nothing is being worked on
    knowns_work,     ///< the same, in the middle of something
    stop_path        ///< its client has set something in motion over it
};

struct Guest {
    PlaceHolder holder = 0;
    Standing standing = Standing::stranger;
    Instant since{};  ///< the last sign of life, or when it was accepted
};

struct PlaceRules {
    std::size_t strangers = 0;  ///< places for everybody
    std::size_t kept = 0;       ///< further ones, for those who are known
    std::size_t paths = 16;     ///< newest stop paths of one holder that never give way
};

struct PlaceVerdict {
    bool let_in = false;
    std::optional<std::size_t> closes;  ///< index of the guest that is closed for it; only with let_in
};

/// Strangers who do nothing go first, from the holder that has most connections, the one that has been silent for longest; then known ones
/// in the same way. What is in the middle of something goes only if its holder has more than an eighth of all places and more than 8.
/// `known`: of the new one. `full`: there is no room for another reason (descriptors).
[[nodiscard]] PlaceVerdict find_place(std::span<const Guest> guests, PlaceHolder newcomer, bool known, const PlaceRules& rules,
                                      bool full = false);

}  // namespace axisgate
