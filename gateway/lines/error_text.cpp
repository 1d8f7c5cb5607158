// Error text: what a failed system call means to who runs the gateway. In: errno. Out: words.
// Never uses strerror(), whose text another thread could change.
#include "gateway/lines/error_text.hpp"

#include <fmt/core.h>

#include <cstring>

namespace axisgate {

std::string error_text(int error) {
    const char* name = ::strerrordesc_np(error);
    return fmt::format("{} ({})", name != nullptr ? name : "unknown error", error);
}

}  // namespace axisgate
