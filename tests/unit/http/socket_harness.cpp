// The door on a loopback port and its clients, compiled once for all tests with sockets. An answer after `patience` is a failure.
#include "tests/unit/http/socket_harness.hpp"

namespace axisgate::http::test {

Door::Door() { settings.bind = "127.0.0.1:0"; }

Door::~Door() {
    if (!thread_.joinable()) return;
    on([this] {
        server_.reset();
        services_.reset();
    });
    work_.reset();
    context_.stop();
    thread_.join();
}

void Door::open() {
    services_ = std::make_unique<Services>(gateway, steady_instant);
    services_->rearm = [this] { arm(); };
    server_ = std::make_unique<Server>(context_, gateway, *services_, settings, [this](std::string_view path) {
        return path == "web/dist/index.html" ? std::string_view("<html>page</html>")
               : path == "web/dist/big.txt"  ? std::string_view(big_file)
                                             : std::string_view();
    });
    ASSERT_EQ(server_->start(), "");
    const std::string address = server_->address();
    port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    thread_ = std::thread([this] { context_.run(); });
}

void Door::arm() {
    const Instant due = services_->deadline();
    if (due == never) return;
    timer_.expires_after(std::max(due - steady_instant(), Duration{}));
    timer_.async_wait([this](ErrorCode ec) {
        if (ec || !services_) return;
        services_->on_deadline(steady_instant());
        arm();
    });
}

template <class Start>
ErrorCode Client::wait(Start start) {
    std::optional<ErrorCode> result;
    start([&result](ErrorCode e) { result = e; });
    context_.restart();
    context_.run_for(patience);
    if (result) return *result;
    socket_.close();
    context_.restart();
    context_.run();
    return asio::error::timed_out;
}

Client::Client(std::uint16_t port, int receive_buffer) : socket_(context_) {
    socket_.open(tcp::v4());
    if (receive_buffer) socket_.set_option(asio::socket_base::receive_buffer_size(receive_buffer));
    socket_.connect({asio::ip::make_address("127.0.0.1"), port}, connected);
}

bool Client::send(std::string_view bytes) {
    ErrorCode ec = wait([&](auto done) { asio::async_write(socket_, asio::buffer(bytes), [done](ErrorCode e, std::size_t) { done(e); }); });
    return !ec;
}

HttpAnswer Client::receive(bool to_head) {
    HttpAnswer answer;
    beast::http::response_parser<beast::http::string_body> parser;
    parser.body_limit(64 * 1024 * 1024);
    parser.skip(to_head);
    answer.error =
        wait([&](auto done) { beast::http::async_read(socket_, buffer_, parser, [done](ErrorCode e, std::size_t) { done(e); }); });
    if (!answer.error) answer.message = parser.release();
    return answer;
}

HttpAnswer Client::get(std::string_view target, std::string_view more) {
    send(std::string("GET ").append(target).append(" HTTP/1.1\r\nHost: 127.0.0.1\r\n").append(more).append("\r\n"));
    return receive();
}

HttpAnswer Client::post(std::string_view target, std::string_view body) {
    send(post_text(target, body));
    return receive();
}

std::string Client::post_text(std::string_view target, std::string_view body, std::string_view method) {
    return std::string(method) + " " + std::string(target) +
           " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
           std::string(body);
}

std::string Client::rest() {
    std::string all(beast::buffers_to_string(buffer_.data()));
    buffer_.clear();
    for (;;) {
        std::array<char, 65536> piece;
        std::size_t n = 0;
        const ErrorCode ec = wait([&](auto done) {
            socket_.async_read_some(asio::buffer(piece), [done, &n](ErrorCode e, std::size_t bytes) {
                n = bytes;
                done(e);
            });
        });
        all.append(piece.data(), n);
        if (ec == asio::error::timed_out) {
            ADD_FAILURE() << "the connection was not closed";
            return all;
        }
        if (ec) return all;
    }
}

void Client::shutdown_send() {
    ErrorCode ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
}

void Client::close() {
    ErrorCode ignored;
    socket_.close(ignored);
}

template <class Start>
ErrorCode StreamJudge::wait(Start start) {
    std::optional<ErrorCode> result;
    start([&result](ErrorCode e) { result = e; });
    context_.restart();
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!result && std::chrono::steady_clock::now() < end && context_.run_one_for(patience) > 0) {
    }
    if (result) return *result;
    ws_.next_layer().close();
    context_.restart();
    context_.run();
    return asio::error::timed_out;
}

StreamJudge::StreamJudge(std::uint16_t port, std::string origin, int receive_buffer) : ws_(context_) {
    auto& socket = ws_.next_layer();
    socket.open(tcp::v4());
    if (receive_buffer) socket.set_option(asio::socket_base::receive_buffer_size(receive_buffer));
    socket.connect({asio::ip::make_address("127.0.0.1"), port});
    ws_.set_option(beast::websocket::stream_base::decorator([origin](beast::websocket::request_type& r) {
        if (!origin.empty()) r.set("Origin", origin);
    }));
    ws_.control_callback([this](beast::websocket::frame_type type, beast::string_view) {
        if (type == beast::websocket::frame_type::ping) ++pings;
        if (type == beast::websocket::frame_type::pong) ++pongs;
    });
    beast::websocket::response_type response;
    opened = wait([&](auto done) { ws_.async_handshake(response, "127.0.0.1:" + std::to_string(port), "/api/v1/stream", done); });
    handshake_status = response.result_int();
}

ErrorCode StreamJudge::say(std::string_view text) {
    return wait([&](auto done) { ws_.async_write(asio::buffer(text), [done](ErrorCode e, std::size_t) { done(e); }); });
}

boost::json::value StreamJudge::next_message() {
    beast::flat_buffer buffer;
    ended = wait([&](auto done) { ws_.async_read(buffer, [done](ErrorCode e, std::size_t) { done(e); }); });
    if (ended) return nullptr;
    return boost::json::parse(beast::buffers_to_string(buffer.data()));
}

ErrorCode StreamJudge::close(std::uint16_t code) {
    return wait([&](auto done) { ws_.async_close(code, done); });
}

ErrorCode StreamJudge::ping() {
    return wait([&](auto done) { ws_.async_ping({}, done); });
}

void StreamJudge::raw(std::string_view bytes) { asio::write(ws_.next_layer(), asio::buffer(bytes)); }

Client::~Client() = default;

StreamJudge::~StreamJudge() = default;

boost::json::value HttpAnswer::json() const {
    ErrorCode ec;
    return boost::json::parse(message.body(), ec);
}

}  // namespace axisgate::http::test
