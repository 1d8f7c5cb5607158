// FNV-1a of the parts of a state.
#include "gateway/services/state_tag.hpp"

#include <fmt/core.h>

#include <cstdint>

namespace axisgate {

std::string tag_over(std::initializer_list<std::string_view> parts) {
    std::uint64_t h = 14695981039346656037ull;  // FNV-1a, 64 bits
    for (const auto part : parts) {
        for (const char x : part)
            h = (h ^ static_cast<unsigned char>(x)) * 1099511628211ull;
        h = (h ^ 0xFF) * 1099511628211ull;
    }
    return fmt::format("\"{:016x}\"", h);
}

}  // namespace axisgate
