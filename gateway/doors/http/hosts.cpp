// Upper case, a port and a final dot do not change a name; an Origin and a Host are compared after adding the scheme's port. Malformed text
// is never a name.
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

std::string_view host_meant(const Request& request) { return authority_of(request.target).value_or(request.headers.get("Host")); }

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

bool host_is_written_right(std::string_view host) {
    host = trimmed(host);
    const std::string_view name = host_name(host);
    std::string_view port = host.substr(name.size());
    if (!port.empty() && (port.front() != ':' || (port.size() > 1 && !parse_whole(port.substr(1), 0, 65535)))) return false;
    if (name.starts_with('[')) return is_ip_address(name);
    return std::ranges::all_of(name, [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               std::string_view("-._~%!$&'()*+,;=").find(c) != std::string_view::npos;
    });
}

bool host_allowed(std::string_view host, const Settings& settings) {
    std::string name = lower(host_name(trimmed(host)));
    if (name.size() > 1 && name.back() == '.') name.pop_back();
    const auto listed = [&](const std::string& allowed) { return lower(host_name(trimmed(allowed))) == name; };
    return is_ip_address(name) || is_loopback(name) || (!name.empty() && std::ranges::any_of(settings.allowed_hosts, listed));
}

bool host_is_loopback(std::string_view host) {
    std::string name = lower(host_name(trimmed(host)));
    if (name.size() > 1 && name.back() == '.') name.pop_back();
    return is_loopback(name);
}

bool host_is_outer_address(std::string_view host) { return is_ip_address(host_name(trimmed(host))) && !host_is_loopback(host); }

}  // namespace axisgate::http
