// The allowed values of Host and Origin headers, so that a page of another site cannot reach this door under a name of its own. Names are
// not looked up.
#pragma once

#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/doors/http/settings.hpp"

namespace axisgate::http {

/// The host of a request: an absolute target replaces the header (RFC 9112 3.2.2).
[[nodiscard]] std::string_view host_meant(const Request& request);
/// True if an Origin header names the same host and port as the Host header.
[[nodiscard]] bool same_host(std::string_view origin, std::string_view host);
/// True if a Host header's value is well-formed (RFC 9110 7.2: uri-host and an optional port); an empty one is.
[[nodiscard]] bool host_is_written_right(std::string_view host);
/// True if a Host header may name this gateway: any IP address (a name could be bound to another address by its owner), the names of the
/// machine for itself (localhost, *.localhost), and those of Settings::allowed_hosts, with or without a port.
[[nodiscard]] bool host_allowed(std::string_view host, const Settings& settings);
/// True for the machine itself: localhost, *.localhost, 127.0.0.0/8, [::1].
[[nodiscard]] bool host_is_loopback(std::string_view host);
/// True for an address under which the machine does not reach itself over loopback: such a request came through another program.
[[nodiscard]] bool host_is_outer_address(std::string_view host);

}  // namespace axisgate::http
