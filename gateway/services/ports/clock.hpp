// The wall clock of the gateway, and its relation to the instants of pictures. In tests its owner has a time of its own.
#pragma once

#include <cstdint>

#include "gateway/core/instant.hpp"

namespace axisgate {

class ClockPort {
public:
    virtual ~ClockPort() = default;
    [[nodiscard]] virtual std::int64_t now_unix_ns() const = 0;
    /// Converts an instant of a picture to wall-clock time.
    [[nodiscard]] virtual std::int64_t to_unix_ns(Instant instant) const = 0;
};

}  // namespace axisgate
