// A thread on its own core, one session with a buffer of 64 KiB per connection, the same bytes for each request.
#include "tests/bench/http_plain.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <string_view>
#include <utility>

namespace axisgate::bench {
namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

namespace {
using Answer = http::response<http::string_body>;

Answer answer_of(std::string_view head, std::string body) {
    Answer r;
    r.version(11);
    r.result(http::status::ok);
    head.remove_prefix(std::min(head.find("\r\n") + 2, head.size()));
    while (!head.empty()) {
        const auto end = std::min(head.find("\r\n"), head.size());
        const auto line = head.substr(0, end);
        head.remove_prefix(std::min(end + 2, head.size()));
        const auto colon = line.find(": ");
        if (colon != std::string_view::npos)
            r.set(boost::beast::string_view(line.data(), colon),
                  boost::beast::string_view(line.data() + colon + 2, line.size() - colon - 2));
    }
    r.body() = std::move(body);
    r.prepare_payload();
    return r;
}

struct PlainSession : std::enable_shared_from_this<PlainSession> {
    PlainSession(tcp::socket s, const Answer& a) : socket(std::move(s)), answer(a) {}
    void read() {
        request = {};
        http::async_read(socket, buffer, request, [self = shared_from_this()](ErrorCode ec, std::size_t) {
            if (!ec) self->write();
        });
    }
    void write() {
        http::async_write(socket, answer, [self = shared_from_this()](ErrorCode ec, std::size_t) {
            if (!ec) self->read();
        });
    }
    tcp::socket socket;
    boost::beast::flat_buffer buffer{64 * 1024};
    http::request<http::string_body> request;
    const Answer& answer;
};
}  // namespace

struct PlainHttpServer::State {
    explicit State(Answer a) : answer(std::move(a)) {}
    void accept() {
        acceptor.async_accept([this](ErrorCode ec, tcp::socket socket) {
            if (ec) return;
            ErrorCode ignored;
            socket.set_option(tcp::no_delay(true), ignored);
            std::make_shared<PlainSession>(std::move(socket), answer)->read();
            accept();
        });
    }
    Answer answer;
    asio::io_context context{1};
    tcp::acceptor acceptor{context, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
};

PlainHttpServer::PlainHttpServer(int cpu, int nice, const std::string& head, std::string body)
    : state_(std::make_unique<State>(answer_of(head, std::move(body)))) {
    address_.port = state_->acceptor.local_endpoint().port();
    state_->accept();
    thread_ = std::thread([this, cpu, nice] {
        pin(cpu);
        (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), nice);
        state_->context.run();
    });
}

PlainHttpServer::~PlainHttpServer() {
    state_->context.stop();
    thread_.join();
}

}  // namespace axisgate::bench
