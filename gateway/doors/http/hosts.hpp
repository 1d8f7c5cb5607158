// Hosts: what Host and Origin headers may say, so that a page of another site cannot reach this door by a name of its own.
// In: headers, the settings. Out: yes or no. Never looks a name up.
#pragma once

#include <string_view>

#include "gateway/doors/http/settings.hpp"

namespace axisgate::http {

/// Whether an Origin header names the same host and port as the Host header.
[[nodiscard]] bool same_host(std::string_view origin, std::string_view host);
/// Whether a Host header may name this gateway; see Settings::allowed_hosts.
[[nodiscard]] bool host_allowed(std::string_view host, const Settings& settings);

}  // namespace axisgate::http
