// Words for the errno values that a user of the gateway is likely to see.
// strerror() is not used, because another thread could change its text.
#include "gateway/lines/error_text.hpp"

#include <fmt/core.h>

#include <cstring>

namespace axisgate {

std::string error_text(int error) {
    const char* name = ::strerrordesc_np(error);
    return fmt::format("{} ({})", name != nullptr ? name : "unknown error", error);
}

}  // namespace axisgate
