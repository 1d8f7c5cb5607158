// One connection, with or without TLS, under one deadline.
#include "gateway/runtime/own_page.hpp"
#include "gateway/runtime/door_http.hpp"

#include <fmt/core.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>
#include <chrono>

namespace axisgate {
namespace {
constexpr std::size_t most_page_bytes = 4u << 20;
constexpr auto page_deadline = std::chrono::seconds(1);

/// The exchange over the open stream.
template <class Stream, class End>
void ask_page(Stream& stream, const std::string& request, std::string& answer, End end) {
    boost::asio::async_write(stream, boost::asio::buffer(request), [&stream, &answer, end](boost::system::error_code sent, std::size_t) {
        if (sent) return end(sent);
        boost::asio::async_read(stream, boost::asio::dynamic_buffer(answer, most_page_bytes),
                                [end](boost::system::error_code got, std::size_t) { end(got); });
    });
}

OwnPage page_in(const std::string& answer) {
    const auto body = answer.find("\r\n\r\n");
    if (body == std::string::npos || !answer.starts_with("HTTP/1.")) return {{}, "no HTTP answer", 0};
    const std::string status = answer.substr(9, 3);
    if (status == "200" || status == "503") return {answer.substr(body + 4), {}, status == "200" ? 200 : 503};
    return {{}, status == "401" ? "it asks for a sign-in ([users] local_role)" : "HTTP status " + status, 0};
}
}  // namespace

OwnPage own_page(const Config& config, std::string_view path) {
    namespace asio = boost::asio;
    const auto where = parse_host_port(config.of<HttpSettings>().bind);
    if (!where) return {{}, "there is no HTTP door", 0};
    const std::string host = where->host == "0.0.0.0"     ? "127.0.0.1"
                             : where->host == "::"        ? "::1"
                             : where->host == "localhost" ? "127.0.0.1"
                                                          : where->host;
    boost::system::error_code fault;
    const auto address = asio::ip::make_address(host, fault);
    if (fault) return {{}, fault.message(), 0};
    const std::string request = fmt::format("GET {} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", path);
    std::string answer;
    bool done = false;
    const auto end = [&fault, &done](const boost::system::error_code& ec) {
        fault = ec == asio::error::eof || ec == asio::ssl::error::stream_truncated ? boost::system::error_code() : ec;
        done = true;
    };
    asio::io_context io;
    asio::ssl::context tls(asio::ssl::context::tls_client);
    tls.set_verify_mode(asio::ssl::verify_none);
    asio::ssl::stream<asio::ip::tcp::socket> stream(io, tls);
    const bool shut = config.of<HttpSettings>().tls_self_signed || !config.of<HttpSettings>().tls_cert.empty();
    stream.next_layer().async_connect({address, where->port}, [&](boost::system::error_code ec) {
        if (ec) return end(ec);
        if (!shut) return ask_page(stream.next_layer(), request, answer, end);
        stream.async_handshake(asio::ssl::stream_base::client, [&](boost::system::error_code shaken) {
            if (shaken) return end(shaken);
            ask_page(stream, request, answer, end);
        });
    });
    io.run_for(page_deadline);
    if (!done) return {{}, "no answer within a second", 0};
    if (fault) return {{}, fault.message(), 0};
    return page_in(answer);
}

}  // namespace axisgate
