// Of a pair that the gateway makes, the key is written first: an interruption leaves a pair that does not fit, and the next start makes a
// new one.
#include "gateway/runtime/tls_files.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>

#include "gateway/doors/http/server.hpp"
#include "gateway/runtime/door_http.hpp"
#include "gateway/runtime/files.hpp"

namespace axisgate {
namespace {
constexpr std::size_t most_bytes = 1U << 20;  // of a certificate with its chain, or of a key

std::optional<http::TlsPem> read_pair(const std::string& certificate, const std::string& key, std::vector<ConfigFault>& faults) {
    http::TlsPem pem;
    const auto read = [&faults](const char* name, const std::string& path, std::string& into) {
        std::string fault;
        auto text = read_file(path, fault, most_bytes);
        if (text) {
            into = std::move(*text);
        } else {
            faults.push_back({name, fmt::format("{}: {}", path, fault), "look at the path, and whether this user may read the file"});
        }
    };
    read("http.tls_cert", certificate, pem.certificate);
    read("http.tls_key", key, pem.key);
    if (!faults.empty()) return std::nullopt;
    return pem;
}

std::vector<std::string> names_of_this_host(const Config& config) {
    std::vector<std::string> names{"localhost", "127.0.0.1", "::1"};
    const auto add = [&names](std::string name) {
        if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    };
    std::string ignored;
    if (const auto bind = http::parse_bind(config.of<HttpSettings>().bind, ignored); bind && !bind->address().is_unspecified())
        add(bind->address().to_string());
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) == 0) add(host.data());
    for (const auto& name : config.of<HttpSettings>().allowed_hosts)
        add(name);
    return names;
}

std::optional<http::TlsPem> own_pair(const Config& config, std::int64_t now_unix_s, std::vector<ConfigFault>& faults) {
    const std::string certificate = config.data_dir + "/http-cert.pem", key = config.data_dir + "/http-key.pem";
    const auto names = names_of_this_host(config);
    std::vector<ConfigFault> not_there;
    if (auto pem = read_pair(certificate, key, not_there); pem && http::still_good(*pem, names, now_unix_s)) return pem;
    auto pem = http::make_self_signed(names, now_unix_s);
    if (!pem) {
        faults.push_back({"http.tls", "no certificate could be made", "give http.tls_cert and http.tls_key instead"});
        return std::nullopt;
    }
    // The key first: an interruption leaves a pair that does not fit, and the next start makes a new one.
    std::string fault = write_secret(key, pem->key);
    if (fault.empty()) fault = write_file(certificate, pem->certificate);
    if (!fault.empty()) {
        faults.push_back({"http.tls", fmt::format("the certificate cannot be kept in {}: {}", config.data_dir, fault),
                          "look at the rights of the data directory"});
        return std::nullopt;
    }
    return pem;
}

std::vector<ConfigFault> worded(const std::vector<http::TlsFault>& faults, const Config& config) {
    std::vector<ConfigFault> all;
    for (const auto& f : faults) {
        const bool in_key = f.in == http::TlsFault::In::key;
        all.push_back({in_key ? "http.tls_key" : "http.tls_cert",
                       fmt::format("{}: {}", in_key ? config.of<HttpSettings>().tls_key : config.of<HttpSettings>().tls_cert, f.text),
                       f.remedy});
    }
    return all;
}
}  // namespace

std::vector<ConfigFault> check_tls(const Config& config, std::int64_t now_unix_s) {
    std::vector<ConfigFault> faults;
    if (config.of<HttpSettings>().tls_cert.empty() || config.of<HttpSettings>().tls_key.empty()) return faults;
    const auto pem = read_pair(config.of<HttpSettings>().tls_cert, config.of<HttpSettings>().tls_key, faults);
    if (!pem) return faults;
    faults = worded(http::tls_faults(*pem, now_unix_s), config);
    std::string fault;
    if (faults.empty() && !http::make_identity(*pem, false, fault))
        faults.push_back({"http.tls_cert", fmt::format("{}: {}", config.of<HttpSettings>().tls_cert, fault),
                          "the certificate, or one of its chain, is not accepted; make it anew"});
    return faults;
}

std::shared_ptr<http::TlsIdentity> open_tls(const Config& config, std::int64_t now_unix_s, std::vector<ConfigFault>& faults) {
    const bool own = config.of<HttpSettings>().tls_self_signed;
    if (!own && config.of<HttpSettings>().tls_cert.empty()) return nullptr;
    if (!own) faults = check_tls(config, now_unix_s);
    if (!faults.empty()) return nullptr;
    const auto pem = own ? own_pair(config, now_unix_s, faults)
                         : read_pair(config.of<HttpSettings>().tls_cert, config.of<HttpSettings>().tls_key, faults);
    if (!pem) return nullptr;
    std::string fault;
    auto identity = http::make_identity(*pem, own, fault);
    if (identity) return std::make_shared<http::TlsIdentity>(std::move(*identity));
    faults.push_back({own ? "http.tls" : "http.tls_cert", "the certificate is not accepted: " + fault, "make it anew"});
    return nullptr;
}

}  // namespace axisgate
