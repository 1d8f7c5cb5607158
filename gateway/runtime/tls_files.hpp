// The TLS identity of the HTTP door: from files of the configuration, or made by the gateway in the data directory. Keys are never logged,
// and written keys are readable only by this user.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gateway/doors/http/tls.hpp"
#include "gateway/runtime/config.hpp"

namespace axisgate {

/// The faults of http.tls_cert and http.tls_key: files that cannot be read, do not fit together, or have expired.
[[nodiscard]] std::vector<ConfigFault> check_tls(const Config& config, std::int64_t now_unix_s);
/// Null without faults means plain HTTP. With tls = self_signed, http-cert.pem and http-key.pem of the data directory (which must exist)
/// are used as long as they are valid and name this host, and made anew otherwise.
[[nodiscard]] std::shared_ptr<http::TlsIdentity> open_tls(const Config& config, std::int64_t now_unix_s, std::vector<ConfigFault>& faults);

}  // namespace axisgate
