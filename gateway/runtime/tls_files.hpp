// TLS files: the identity of the HTTP door from the files of the configuration, or of our own making in the data directory.
// In: the configuration, the time. Out: an identity, nothing for plain HTTP, or faults with what to do.
// Never logs a key; a key that it writes is readable by this user alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gateway/doors/http/tls.hpp"
#include "gateway/runtime/config.hpp"

namespace axisgate {

/// What is wrong with http.tls_cert and http.tls_key: files that cannot be read, do not belong together, have expired.
[[nodiscard]] std::vector<ConfigFault> check_tls(const Config& config, std::int64_t now_unix_s);
/// Nothing and no faults: plain HTTP was asked for. With tls = self_signed, http-cert.pem and http-key.pem of the data directory (which
/// must be there) are used as long as they hold and name this host, and made anew otherwise.
[[nodiscard]] std::shared_ptr<http::TlsIdentity> open_tls(const Config& config, std::int64_t now_unix_s, std::vector<ConfigFault>& faults);

}  // namespace axisgate
