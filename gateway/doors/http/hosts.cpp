// Hosts: see the header.
// In and out: texts of headers.
#include "gateway/doors/http/hosts.hpp"

#include <algorithm>

#include "gateway/doors/http/text.hpp"

namespace axisgate::http {
namespace {
/// HOST without its port: "[::1]" keeps its brackets.
std::string_view host_name(std::string_view host) {
    if (host.starts_with('[')) return host.substr(0, std::min(host.find(']') + 1, host.size()));
    return host.substr(0, host.find(':'));
}

bool is_ip_address(std::string_view name) {
    if (name.starts_with('[')) {
        return name.size() > 3 && name.ends_with(']') && std::ranges::all_of(name.substr(1, name.size() - 2), [](char c) {
                   return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == ':' || c == '.';
               });
    }
    int parts = 0;
    while (!name.empty()) {
        const auto dot = name.find('.');
        if (!parse_whole(name.substr(0, dot), 0, 255)) return false;
        ++parts;
        if (dot == std::string_view::npos) break;
        name.remove_prefix(dot + 1);
    }
    return parts == 4;
}

bool is_loopback(std::string_view name) {
    return name == "localhost" || name.ends_with(".localhost") || name == "[::1]" || (name.starts_with("127.") && is_ip_address(name));
}
}  // namespace

bool same_host(std::string_view origin, std::string_view host) {
    const auto scheme = origin.find("://");
    if (scheme == std::string_view::npos) return false;
    const std::string name = lower(origin.substr(0, scheme));
    if (name != "http" && name != "https") return false;
    const auto with_port = [&name](std::string_view h) {
        std::string s = lower(trimmed(h));
        const std::size_t colon = s.rfind(':');
        if (colon == std::string::npos || s.ends_with(']')) s += name == "https" ? ":443" : ":80";
        return s;
    };
    return !trimmed(host).empty() && with_port(origin.substr(scheme + 3)) == with_port(host);
}

bool host_allowed(std::string_view host, const Settings& settings) {
    std::string name = lower(host_name(trimmed(host)));
    if (name.size() > 1 && name.back() == '.') name.pop_back();
    const std::string bound = lower(host_name(settings.bind));
    const auto listed = [&](const std::string& allowed) { return lower(allowed) == name; };
    if (is_ip_address(name) || is_loopback(name) || (!bound.empty() && name == bound)) return true;
    if (std::ranges::any_of(settings.allowed_hosts, listed)) return true;
    return settings.allowed_hosts.empty() && !is_loopback(bound) && !name.empty();
}

}  // namespace axisgate::http
