// Several processes of one program run at a time, and those with the same domain would receive each other. This gives the number of a DDS
// domain, 20 to 229, which differs for processes that were started one after the other.
#pragma once

#include <unistd.h>

#include <cstdint>

namespace axisgate::dds::test {
[[nodiscard]] inline std::uint32_t own_domain(std::uint32_t which = 0) {
    return 20 + static_cast<std::uint32_t>(::getpid()) % 70 * 3 + which;
}
}  // namespace axisgate::dds::test
