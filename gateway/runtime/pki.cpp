// Elliptic keys (P-256), X.509 certificates, documents signed in S/MIME, all by OpenSSL. A member's folder is made under another name and
// renamed when it is complete. There is no passphrase, because gateways start unattended.
#include "gateway/runtime/pki.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>

#include "gateway/runtime/files.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;

template <auto F>
struct FreeOf {
    template <class T>
    void operator()(T* p) const noexcept {
        F(p);
    }
};
using PemBio = std::unique_ptr<BIO, FreeOf<BIO_free_all>>;
using X509Certificate = std::unique_ptr<X509, FreeOf<X509_free>>;
using PrivateKey = std::unique_ptr<EVP_PKEY, FreeOf<EVP_PKEY_free>>;
using Signed = std::unique_ptr<PKCS7, FreeOf<PKCS7_free>>;

constexpr std::int64_t a_day_s = 86'400, clocks_apart_s = 2 * a_day_s;

struct Holder {
    X509Certificate certificate;
    PrivateKey key;
    [[nodiscard]] explicit operator bool() const { return certificate && key; }
};
struct Validity {
    std::int64_t from = 0, to = 0;
};

PemBio bio_of(std::string_view text) { return PemBio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))); }
std::string bytes_of(const PemBio& bio) {
    const char* data = nullptr;
    const auto n = BIO_get_mem_data(bio.get(), &data);
    return n > 0 ? std::string(data, static_cast<std::size_t>(n)) : std::string();
}
std::string pem_of(const X509* c) {
    const PemBio bio(BIO_new(BIO_s_mem()));
    return bio && PEM_write_bio_X509(bio.get(), const_cast<X509*>(c)) == 1 ? bytes_of(bio) : std::string();
}
std::string pem_of(EVP_PKEY* k) {
    const PemBio bio(BIO_new(BIO_s_mem()));
    return bio && PEM_write_bio_PrivateKey(bio.get(), k, nullptr, nullptr, 0, nullptr, nullptr) == 1 ? bytes_of(bio) : std::string();
}
bool add_extension(X509* c, X509* issuer, int nid, const char* value) {
    X509V3_CTX context;
    X509V3_set_ctx(&context, issuer, c, nullptr, nullptr, 0);
    const std::unique_ptr<X509_EXTENSION, FreeOf<X509_EXTENSION_free>> e(X509V3_EXT_conf_nid(nullptr, &context, nid, value));
    return e && X509_add_ext(c, e.get(), -1) == 1;
}

/// `issuer` null: a self-signed authority.
Holder make_holder(const std::string& name, const Holder* issuer, Validity v) {
    Holder h;
    h.key.reset(EVP_EC_gen("P-256"));
    h.certificate.reset(X509_new());
    X509* c = h.certificate.get();
    std::array<unsigned char, 16> serial{};
    if (!h || RAND_bytes(serial.data(), static_cast<int>(serial.size())) != 1) return {};
    serial[0] = static_cast<unsigned char>((serial[0] & 0x7FU) | 0x40U);
    const std::unique_ptr<BIGNUM, FreeOf<BN_free>> number(BN_bin2bn(serial.data(), static_cast<int>(serial.size()), nullptr));
    X509_NAME* subject = X509_get_subject_name(c);
    const bool good = number && BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(c)) && X509_set_version(c, 2) == 1 &&
                      ASN1_TIME_set(X509_getm_notBefore(c), v.from) && ASN1_TIME_set(X509_getm_notAfter(c), v.to) &&
                      X509_set_pubkey(c, h.key.get()) == 1 &&
                      X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>(name.data()),
                                                 static_cast<int>(name.size()), -1, 0) == 1 &&
                      X509_set_issuer_name(c, issuer ? X509_get_subject_name(issuer->certificate.get()) : subject) == 1 &&
                      add_extension(c, issuer ? issuer->certificate.get() : c, NID_basic_constraints,
                                    issuer ? "critical,CA:FALSE" : "critical,CA:TRUE") &&
                      add_extension(c, issuer ? issuer->certificate.get() : c, NID_key_usage,
                                    issuer ? "critical,digitalSignature,keyAgreement" : "critical,keyCertSign,cRLSign,digitalSignature") &&
                      X509_sign(c, issuer ? issuer->key.get() : h.key.get(), EVP_sha256()) > 0;
    return good ? std::move(h) : Holder{};
}

/// As `openssl smime -sign -text` writes it: the text stays readable. Empty: it failed.
std::string sign(const Holder& by, const std::string& text) {
    constexpr int flags = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
    const PemBio in = bio_of(text), out(BIO_new(BIO_s_mem()));
    const Signed p7(in && out ? PKCS7_sign(by.certificate.get(), by.key.get(), nullptr, in.get(), flags) : nullptr);
    return p7 && SMIME_write_PKCS7(out.get(), p7.get(), in.get(), flags) == 1 ? bytes_of(out) : std::string();
}

std::optional<Holder> read_authority(const fs::path& dir, std::string& fault) {
    const auto certificate = read_file((dir / "ca-cert.pem").string(), fault, 1U << 20);
    const auto key = certificate ? read_file((dir / "ca-key.pem").string(), fault, 1U << 20) : std::nullopt;
    if (!key) return std::nullopt;
    Holder h;
    h.certificate.reset(PEM_read_bio_X509(bio_of(*certificate).get(), nullptr, nullptr, nullptr));
    h.key.reset(PEM_read_bio_PrivateKey(bio_of(*key).get(), nullptr, nullptr, nullptr));
    ERR_clear_error();
    if (h && X509_check_private_key(h.certificate.get(), h.key.get()) == 1) return h;
    fault = fmt::format("{}: ca-cert.pem and ca-key.pem are no pair of an authority; give the folder that this command made", dir.string());
    return std::nullopt;
}

bool is_member_name(std::string_view s) {
    constexpr auto allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    return !s.empty() && s.size() <= 63 && s.front() != '.' && s.find_first_not_of(allowed) == std::string_view::npos;
}

std::string write_all(const fs::path& dir, const std::vector<std::pair<const char*, std::string>>& files) {
    for (const auto& [name, text] : files) {
        const std::string path = (dir / name).string();
        if (text.empty()) return fmt::format("{} could not be made", path);
        const bool secret = std::string_view(name).ends_with("key.pem");
        if (std::string fault = secret ? write_secret(path, text) : write_file(path, text); !fault.empty()) return fault;
    }
    return {};
}

std::string make_member(const PkiOptions& o, const std::string& name, const Holder& authority, Validity v, std::int64_t now) {
    const fs::path place = fs::path(o.dir) / name, beside = fs::path(o.dir) / (name + ".new");
    std::error_code ec;
    if (fs::exists(place, ec)) return fmt::format("{} is there already; move it away to make another one", place.string());
    // No certificate of a member is valid longer than that of its authority, because it would not be accepted.
    std::tm end{};
    if (ASN1_TIME_to_tm(X509_get0_notAfter(authority.certificate.get()), &end) == 1) v.to = std::min<std::int64_t>(v.to, timegm(&end));
    if (v.to <= now) return fmt::format("the authority in {} has expired; make a new one in another folder", o.dir);
    const Holder member = make_holder(name, &authority, v);
    fs::remove_all(beside, ec);
    if (!fs::create_directories(beside, ec)) return fmt::format("cannot make {}: {}", beside.string(), ec.message());
    fs::permissions(beside, fs::perms::owner_all, ec);
    const std::string ca = pem_of(authority.certificate.get());
    std::string fault =
        !member ? "no key could be made"
                : write_all(beside, {{"identity-ca.pem", ca},
                                     {"permissions-ca.pem", ca},
                                     {"cert.pem", pem_of(member.certificate.get())},
                                     {"key.pem", pem_of(member.key.get())},
                                     {"governance.p7s", sign(authority, governance_document())},
                                     {"permissions.p7s", sign(authority, permissions_document(name, o.role, o.partition, v.from, v.to))}});
    if (fault.empty()) {
        fs::rename(beside, place, ec);
        if (ec) fault = fmt::format("cannot make {}: {}", place.string(), ec.message());
    }
    if (!fault.empty()) fs::remove_all(beside, ec);
    return fault;
}

std::string topics(std::string_view kind, std::initializer_list<const char*> names, std::string_view partition) {
    std::string all;
    for (const char* n : names)
        all += fmt::format("<topic>axisgate_{}</topic>", n);
    return fmt::format("        <{0}><topics>{1}</topics><partitions><partition>{2}</partition></partitions></{0}>\n", kind, all,
                       partition);
}
}  // namespace

std::string governance_document() {
    return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="https://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>230</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>ENCRYPT</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>NONE</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
)";
}

std::string permissions_document(std::string_view name, std::string_view role, std::string_view partition, std::int64_t from_unix_s,
                                 std::int64_t to_unix_s) {
    const auto date = [](std::int64_t s) { return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(s))); };
    std::string allowed;
    if (role == "gateway") {
        allowed =
            topics("publish", {"GatewayState", "AxisState", "Event", "CommandResult", "AxisCommand"}, partition) +
            topics("subscribe", {"GatewayState", "AxisState", "CommandResult", "AxisCommand", "ParameterWrite", "SetPoint"}, partition);
    } else {
        if (role == "commander") allowed = topics("publish", {"AxisCommand", "ParameterWrite", "SetPoint"}, partition);
        allowed += topics("subscribe", {"GatewayState", "AxisState", "Event", "CommandResult"}, partition);
    }
    return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="https://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="{}">
      <subject_name>CN={}</subject_name>
      <validity><not_before>{}</not_before><not_after>{}</not_after></validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>230</max></id_range></domains>
{}      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
)",
                       role, name, date(from_unix_s), date(to_unix_s), allowed);
}

PkiMade make_pki(const PkiOptions& o, std::int64_t now_unix_s) {
    PkiMade made;
    for (const auto& name : o.names) {
        if (!is_member_name(name)) made.fault = fmt::format("{}: write 1 to 63 letters, digits, - _ or ., as in [dds] name", name);
    }
    if (!is_member_name(o.partition)) made.fault = fmt::format("{}: write the partition as in [dds] partition", o.partition);
    if (!made.fault.empty()) return made;
    const fs::path dir(o.dir);
    const Validity v{now_unix_s - clocks_apart_s, now_unix_s + o.days * a_day_s};
    std::error_code ec;
    std::optional<Holder> authority;
    if (!fs::exists(dir / "ca-key.pem", ec)) {
        fs::create_directories(dir, ec);
        authority = make_holder("axisgate authority", nullptr, v);
        made.fault =
            !*authority
                ? "no key could be made"
                : write_all(dir, {{"ca-key.pem", pem_of(authority->key.get())}, {"ca-cert.pem", pem_of(authority->certificate.get())}});
        made.authority = made.fault.empty();
    } else {
        authority = read_authority(dir, made.fault);
    }
    for (const auto& name : o.names) {
        if (!made.fault.empty()) break;
        made.fault = make_member(o, name, *authority, v, now_unix_s);
        if (made.fault.empty()) made.folders.push_back((dir / name).string());
    }
    return made;
}

}  // namespace axisgate
