// TLS identity: the certificate and key that the HTTP door shows, and the maker of a certificate of its own.
// In: PEM texts, names, the time. Out: an identity ready for handshakes (TLS 1.2 at least), or all that is wrong with it, in words.
// Never opens a file or reads a clock. The key never appears in a message.
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
    bool self_made = false;  ///< no Strict-Transport-Security then: a browser that keeps it allows no exception for the certificate
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

/// Empty: the two belong together, can be read and hold at that time.
[[nodiscard]] std::vector<TlsFault> tls_faults(const TlsPem& pem, std::int64_t now_unix_s);
/// Nothing: `fault` says why. Call it after tls_faults, which tells more.
[[nodiscard]] std::optional<TlsIdentity> make_identity(const TlsPem& pem, bool self_made, std::string& fault);

inline constexpr std::int64_t self_made_days = 825;  ///< the longest that clients commonly take
inline constexpr std::int64_t renew_days = 30;       ///< with less left a new one is made at the start

/// EC P-256, signed by itself, for these names and IP addresses. Nothing: the library failed.
[[nodiscard]] std::optional<TlsPem> make_self_signed(std::span<const std::string> names, std::int64_t now_unix_s);
/// Whether a certificate of our own can go on: it is whole, has 30 days left, and names all of these.
[[nodiscard]] bool still_good(const TlsPem& pem, std::span<const std::string> names, std::int64_t now_unix_s);

}  // namespace axisgate::http
