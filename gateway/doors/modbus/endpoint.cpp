// `localhost` is 127.0.0.1, an IPv6 address is in brackets, the port is required. A fault includes an example; no name server is asked.
#include "gateway/doors/modbus/endpoint.hpp"

#include <boost/asio/ip/address.hpp>
#include <charconv>

namespace axisgate::modbus {

Endpoint parse_endpoint(std::string_view text) {
    const auto bad = [&](std::string_view what) {
        return Endpoint{
            {}, "\"" + std::string(text) + "\": " + std::string(what) + "; write ADDRESS:PORT, for example 127.0.0.1:1502 or [::1]:1502"};
    };
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos) return bad("the port is missing");
    std::string_view host = text.substr(0, colon);
    const std::string_view digits = text.substr(colon + 1);
    std::uint16_t port = 0;
    const auto [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (digits.empty() || ec != std::errc{} || end != digits.data() + digits.size()) return bad("the port is not a number from 0 to 65535");
    if (host.starts_with('[')) {
        if (!host.ends_with(']')) return bad("the closing bracket is missing");
        host = host.substr(1, host.size() - 2);
    } else if (host.find(':') != std::string_view::npos) {
        return bad("an IPv6 address is written in brackets");
    }
    if (host == "localhost") host = "127.0.0.1";
    boost::system::error_code fault;
    const auto address = boost::asio::ip::make_address(std::string(host), fault);
    if (fault) return bad("the address is not an IP address of this host");
    return {{address, port}, {}};
}

std::string to_text(const boost::asio::ip::tcp::endpoint& endpoint) {
    const auto& a = endpoint.address();
    const std::string host = a.is_v6() ? "[" + a.to_string() + "]" : a.to_string();
    return host + ":" + std::to_string(endpoint.port());
}

}  // namespace axisgate::modbus
