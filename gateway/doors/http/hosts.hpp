// Hosts: what Host and Origin headers may say, so that a page of another site cannot reach this door by a name of its own.
// In: headers, the settings. Out: yes or no. Never looks a name up.
#pragma once

#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/doors/http/settings.hpp"

namespace axisgate::http {

/// The host that a request is for: an absolute target says so in place of the header, whatever that says (RFC 9112 3.2.2).
[[nodiscard]] std::string_view host_meant(const Request& request);
/// Whether an Origin header names the same host and port as the Host header.
[[nodiscard]] bool same_host(std::string_view origin, std::string_view host);
/// Whether a Host header's value is one at all (RFC 9110 7.2: uri-host and perhaps a port); an empty one is.
[[nodiscard]] bool host_is_written_right(std::string_view host);
/// Whether a Host header may name this gateway: any IP address (a name alone can be bound to another address by whoever owns it), the names
/// of the machine to itself (localhost, *.localhost), and those of Settings::allowed_hosts, with or without a port.
[[nodiscard]] bool host_allowed(std::string_view host, const Settings& settings);
/// Whether it names the machine to itself: localhost, *.localhost, 127.0.0.0/8, [::1].
[[nodiscard]] bool host_is_loopback(std::string_view host);
/// Whether it is an address at which nobody reaches the machine from itself over loopback: whoever comes so came through something else.
[[nodiscard]] bool host_is_outer_address(std::string_view host);

}  // namespace axisgate::http
