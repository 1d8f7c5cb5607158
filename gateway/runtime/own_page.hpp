// One GET at the HTTP door of the gateway on this machine, for commands of the program. It does not sign in, waits for at most a second,
// and reads at most 4 MiB.
#pragma once

#include <string>
#include <string_view>

#include "gateway/runtime/config.hpp"

namespace axisgate {

struct OwnPage {
    std::string body;   ///< of a good answer, or of a 503, which contains the reasons
    std::string fault;  ///< empty: good
    int status = 0;     ///< 0: there was no answer
};
/// Uses TLS if the door does; the certificate is not checked, because no secret is sent.
[[nodiscard]] OwnPage own_page(const Config& config, std::string_view path);

}  // namespace axisgate
