// Own page: one GET at the HTTP door of the gateway on this machine, for those of its commands that ask it something.
// In: the configuration, a path. Out: the answer's body, or why there is none. Never signs in, waits for at most a second, and takes at
// most 4 MiB.
#pragma once

#include <string>
#include <string_view>

#include "gateway/runtime/config.hpp"

namespace axisgate {

struct OwnPage {
    std::string body;   ///< of a good answer, or of one with 503, which says what is missing
    std::string fault;  ///< empty: good
    int status = 0;     ///< 0: there was none
};
/// With TLS as the door has it; the certificate is not looked at, because nothing is told to who answers.
[[nodiscard]] OwnPage own_page(const Config& config, std::string_view path);

}  // namespace axisgate
