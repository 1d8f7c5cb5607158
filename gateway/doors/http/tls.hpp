// The certificate and key of the HTTP door, and the making of a self-signed certificate. The identity is ready for handshakes (TLS 1.2 at
// least), or all faults are reported in words. The key never appears in a message; files and the clock are read elsewhere.
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::http {

struct TlsIdentity {
    boost::asio::ssl::context context{boost::asio::ssl::context::tls_server};
    bool self_made = false;  ///< without Strict-Transport-Security, because a browser that stores it allows no exception for the
                             ///< certificate
};

struct TlsPem {
    std::string certificate;  ///< the server's own first, then those between it and the root
    std::string key;
};

struct TlsFault {
    enum class In : std::uint8_t { certificate, key };
    In in = In::certificate;
    std::string text;
    std::string remedy;
};

/// Empty: the two fit together, can be read and are valid at that time.
[[nodiscard]] std::vector<TlsFault> tls_faults(const TlsPem& pem, std::int64_t now_unix_s);
/// If empty, `fault` has the reason. Call it after tls_faults, which reports more.
[[nodiscard]] std::optional<TlsIdentity> make_identity(const TlsPem& pem, bool self_made, std::string& fault);

inline constexpr std::int64_t self_made_days = 825;  ///< the longest that clients commonly take
inline constexpr std::int64_t renew_days = 30;       ///< if less is left, a new one is made at the start

/// EC P-256, self-signed, for these names and IP addresses. Empty: the library failed.
[[nodiscard]] std::optional<TlsPem> make_self_signed(std::span<const std::string> names, std::int64_t now_unix_s);
/// True if a self-signed certificate can still be used: it is complete, has 30 days left, and names all of these.
[[nodiscard]] bool still_good(const TlsPem& pem, std::span<const std::string> names, std::int64_t now_unix_s);

}  // namespace axisgate::http
