// OpenSSL 3. A certificate made here is valid from an hour ago, because clients' clocks differ. There is no passphrase, so a locked key
// cannot be read.
#include "gateway/doors/http/tls.hpp"

#include <fmt/core.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <array>
#include <boost/asio/ip/address.hpp>
#include <ctime>
#include <limits>
#include <memory>

namespace axisgate::http {
namespace {
template <auto F>
struct Free {
    template <class T>
    void operator()(T* p) const noexcept {
        F(p);
    }
};
using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Free<X509_EXTENSION_free>>;
constexpr std::int64_t day_s = 86'400;

Bio reader(const std::string& text) {
    const auto size = text.size() > std::size_t{std::numeric_limits<int>::max()} ? 0 : static_cast<int>(text.size());
    return Bio(BIO_new_mem_buf(text.data(), size));
}
/// Gateways start unattended: a locked key is a key that cannot be read.
int no_passphrase(char*, int, int, void*) { return -1; }

Certificate read_certificate(const TlsPem& pem) {
    const Bio bio = reader(pem.certificate);
    Certificate c(bio ? PEM_read_bio_X509(bio.get(), nullptr, no_passphrase, nullptr) : nullptr);
    ERR_clear_error();
    return c;
}
Key read_key(const TlsPem& pem) {
    const Bio bio = reader(pem.key);
    Key k(bio ? PEM_read_bio_PrivateKey(bio.get(), nullptr, no_passphrase, nullptr) : nullptr);
    ERR_clear_error();
    return k;
}
std::string text_of(const Bio& bio) {
    const char* data = nullptr;
    const auto n = BIO_get_mem_data(bio.get(), &data);
    return n > 0 ? std::string(data, static_cast<std::size_t>(n)) : std::string();
}
std::string date_of(const ASN1_TIME* t) {
    std::tm tm{};
    if (ASN1_TIME_to_tm(t, &tm) != 1) return "an unreadable date";
    return fmt::format("{:04}-{:02}-{:02}", tm.tm_year + 1900, tm.tm_mon + 1, tm.tm_mday);
}
bool is_address(const std::string& name) {
    boost::system::error_code ec;
    (void)boost::asio::ip::make_address(name, ec);
    return !ec;
}
/// Names are written into an extension's text, where a comma would begin another one.
bool is_plain_name(std::string_view name) {
    return !name.empty() && name.size() <= 253 &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_") == std::string_view::npos;
}
bool extend(X509* certificate, int nid, const std::string& value) {
    X509V3_CTX context;
    X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
    const Extension e(X509V3_EXT_conf_nid(nullptr, &context, nid, value.c_str()));
    return e && X509_add_ext(certificate, e.get(), -1) == 1;
}
bool fill(X509* c, EVP_PKEY* key, std::span<const std::string> names, std::int64_t now_unix_s) {
    std::array<unsigned char, 16> serial{};
    if (RAND_bytes(serial.data(), static_cast<int>(serial.size())) != 1) return false;
    serial[0] = static_cast<unsigned char>((serial[0] & 0x7FU) | 0x40U);  // positive, and always of one length
    const std::unique_ptr<BIGNUM, Free<BN_free>> number(BN_bin2bn(serial.data(), static_cast<int>(serial.size()), nullptr));
    if (!number || !BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(c))) return false;
    // An hour back: clocks of clients differ.
    if (X509_set_version(c, 2) != 1 || !ASN1_TIME_set(X509_getm_notBefore(c), now_unix_s - 3600) ||
        !ASN1_TIME_set(X509_getm_notAfter(c), now_unix_s + self_made_days * day_s) || X509_set_pubkey(c, key) != 1)
        return false;
    X509_NAME* subject = X509_get_subject_name(c);
    const std::string_view common = "axisgate";
    if (X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>(common.data()),
                                   static_cast<int>(common.size()), -1, 0) != 1 ||
        X509_set_issuer_name(c, subject) != 1)
        return false;
    std::string all;
    for (const auto& name : names) {
        if (!is_address(name) && !is_plain_name(name)) continue;
        all += fmt::format("{}{}:{}", all.empty() ? "" : ",", is_address(name) ? "IP" : "DNS", name);
    }
    return extend(c, NID_basic_constraints, "critical,CA:FALSE") && extend(c, NID_key_usage, "critical,digitalSignature") &&
           extend(c, NID_ext_key_usage, "serverAuth") && (all.empty() || extend(c, NID_subject_alt_name, all)) &&
           X509_sign(c, key, EVP_sha256()) > 0;
}
}  // namespace

std::vector<TlsFault> tls_faults(const TlsPem& pem, std::int64_t now_unix_s) {
    using In = TlsFault::In;
    std::vector<TlsFault> faults;
    const Certificate c = read_certificate(pem);
    const Key k = read_key(pem);
    if (!c)
        faults.push_back(
            {In::certificate, "this is not a certificate in PEM form", "give a file that begins with -----BEGIN CERTIFICATE-----"});
    if (!k)
        faults.push_back({In::key, "this is not a private key in PEM form without a passphrase",
                          "give a file with -----BEGIN PRIVATE KEY-----; openssl pkey takes a passphrase away"});
    if (c) {
        std::time_t now = now_unix_s;
        if (X509_cmp_time(X509_get0_notAfter(c.get()), &now) < 0)
            faults.push_back({In::certificate, "the certificate expired on " + date_of(X509_get0_notAfter(c.get())),
                              "renew it, and look at this machine's clock"});
        if (X509_cmp_time(X509_get0_notBefore(c.get()), &now) > 0)
            faults.push_back({In::certificate, "the certificate holds only from " + date_of(X509_get0_notBefore(c.get())),
                              "wait until then, and look at this machine's clock"});
    }
    if (c && k && X509_check_private_key(c.get(), k.get()) != 1)
        faults.push_back({In::key, "the key does not belong to the certificate",
                          "give the key with which the certificate was requested; the server's own certificate comes first in its file"});
    ERR_clear_error();
    return faults;
}

std::optional<TlsIdentity> make_identity(const TlsPem& pem, bool self_made, std::string& fault) {
    namespace ssl = boost::asio::ssl;
    TlsIdentity identity;
    identity.self_made = self_made;
    boost::system::error_code ec;
    auto& context = identity.context;
    context.set_options(ssl::context::default_workarounds | ssl::context::no_sslv2 | ssl::context::no_sslv3 | ssl::context::no_tlsv1 |
                            ssl::context::no_tlsv1_1 | ssl::context::no_compression | SSL_OP_NO_RENEGOTIATION,
                        ec);
    if (!ec) context.set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); }, ec);
    if (!ec) context.use_certificate_chain(boost::asio::buffer(pem.certificate), ec);
    if (!ec) context.use_private_key(boost::asio::buffer(pem.key), ssl::context::pem, ec);
    if (!ec && SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION) != 1)
        ec = boost::asio::error::operation_not_supported;
    SSL_CTX_set_mode(context.native_handle(), SSL_MODE_RELEASE_BUFFERS);  // idle connections hold no record buffers
    if (ec) {
        fault = ec.message();
        return std::nullopt;
    }
    return identity;
}

std::optional<TlsPem> make_self_signed(std::span<const std::string> names, std::int64_t now_unix_s) {
    const Key key(EVP_EC_gen("P-256"));
    const Certificate c(X509_new());
    const Bio certificate_out(BIO_new(BIO_s_mem())), key_out(BIO_new(BIO_s_secmem()));
    const bool good = key && c && certificate_out && key_out && fill(c.get(), key.get(), names, now_unix_s) &&
                      PEM_write_bio_X509(certificate_out.get(), c.get()) == 1 &&
                      PEM_write_bio_PrivateKey(key_out.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1;
    ERR_clear_error();
    if (!good) return std::nullopt;
    return TlsPem{text_of(certificate_out), text_of(key_out)};
}

bool still_good(const TlsPem& pem, std::span<const std::string> names, std::int64_t now_unix_s) {
    if (!tls_faults(pem, now_unix_s).empty()) return false;
    const Certificate c = read_certificate(pem);
    std::time_t later = now_unix_s + renew_days * day_s;
    if (X509_cmp_time(X509_get0_notAfter(c.get()), &later) < 0) return false;
    for (const auto& name : names) {
        if (is_address(name)) {
            if (X509_check_ip_asc(c.get(), name.c_str(), 0) != 1) return false;
        } else if (is_plain_name(name) && X509_check_host(c.get(), name.data(), name.size(), 0, nullptr) != 1) {
            return false;
        }
    }
    return true;
}

}  // namespace axisgate::http
