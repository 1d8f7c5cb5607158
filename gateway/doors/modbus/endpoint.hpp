// Endpoint: the text of `[modbus] bind` as a TCP address.
// In: "127.0.0.1:1502", "[::1]:1502", "localhost:1502", "0.0.0.0:502". Out: the endpoint, or what is wrong with the text and how it should
// be. Never asks a name server: a bind address is a number.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <string>
#include <string_view>

namespace axisgate::modbus {

struct Endpoint {
    boost::asio::ip::tcp::endpoint endpoint;
    std::string fault;  ///< empty: good
};
/// Port 0 lets the system choose.
[[nodiscard]] Endpoint parse_endpoint(std::string_view text);
/// "127.0.0.1:1502", "[::1]:1502"
[[nodiscard]] std::string to_text(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace axisgate::modbus
