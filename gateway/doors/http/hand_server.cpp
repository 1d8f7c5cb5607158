// Beast's server in its simplest form; a PATCH looks up all names first, so that all conditions are set or none.
#include "gateway/doors/http/hand_server.hpp"

#include <fmt/core.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/json.hpp>

#include "gateway/core/json_read.hpp"
#include "gateway/doors/http/server.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace {
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace bhttp = boost::beast::http;
namespace json = boost::json;
constexpr std::size_t max_connections = 16;
constexpr std::size_t max_body = 64 * 1024;
constexpr auto request_limit = std::chrono::seconds(10);
using Drives = std::vector<HandServer::Drive>;

struct Answer {
    bhttp::status status = bhttp::status::ok;
    json::object body;
};

Answer fault(bhttp::status status, std::string detail) {
    return {status,
            {{"type", "about:blank"},
             {"title", std::string(bhttp::obsolete_reason(status))},
             {"status", static_cast<unsigned>(status)},
             {"detail", std::move(detail)}}};
}

Answer show(const HandServer::Drive& drive) {
    Answer a;
    for (const auto& i : drive.items())
        a.body[i.name] = to_json(i.value);
    return a;
}

Answer handle(const Drives& drives, const bhttp::request<bhttp::string_body>& request) {
    std::string_view path(request.target().data(), request.target().size());
    path = path.substr(0, path.find('?'));
    const HandServer::Drive* drive = nullptr;
    if (path == "/hand") {
        drive = &drives.front();
    } else if (path.starts_with("/hand/")) {
        for (const auto& d : drives) {
            if (d.address == path.substr(6)) drive = &d;
        }
    }
    if (!drive) {
        std::string list;
        for (const auto& d : drives)
            list += (list.empty() ? "" : ", ") + d.address;
        return fault(bhttp::status::not_found, fmt::format("use /hand, or /hand/ADDRESS with one of: {}", list));
    }
    if (request.method() == bhttp::verb::get) return show(*drive);
    if (request.method() != bhttp::verb::patch && request.method() != bhttp::verb::put)
        return fault(bhttp::status::method_not_allowed, "use GET, PATCH or PUT");
    JsonFault unread;
    const auto parsed = read_json(request.body(), unread);
    if (!parsed && unread.twice)
        return fault(bhttp::status::bad_request, fmt::format("{} ({}): keep one of them", unread.text, unread.pointer));
    if (!parsed || !parsed->is_object())
        return fault(bhttp::status::bad_request, "the body must be a JSON object such as {\"stall\": true}");
    std::vector<std::pair<std::string, Value>> items;
    for (const auto& [name, v] : parsed->get_object()) {
        Value value;
        if (v.is_bool()) value = v.get_bool();
        if (v.is_int64()) value = v.get_int64();
        if (v.is_double()) value = v.get_double();
        if (v.is_string()) value = std::string(v.get_string());
        if (!known(value))
            return fault(bhttp::status::unprocessable_entity,
                         fmt::format("{}: write true, false, a number or a text", std::string_view(name)));
        items.emplace_back(std::string(name), std::move(value));
    }
    const auto offered = drive->items();
    for (const auto& [name, value] : items) {  // names first, so that all or none are set
        const auto it = std::find_if(offered.begin(), offered.end(), [&n = name](const HandItem& h) { return h.name == n; });
        if (it != offered.end() && it->writable) continue;
        std::string names;
        for (const auto& h : offered) {
            if (h.writable) names += (names.empty() ? "" : ", ") + h.name;
        }
        return fault(bhttp::status::unprocessable_entity, fmt::format("{} cannot be set; this drive offers {}", name, names));
    }
    if (const std::string wrong = drive->set(items); !wrong.empty()) return fault(bhttp::status::unprocessable_entity, wrong);
    return show(*drive);
}

class HandSession : public std::enable_shared_from_this<HandSession> {
public:
    HandSession(asio::ip::tcp::socket socket, const Drives& drives, std::shared_ptr<std::size_t> count)
        : stream_(std::move(socket)), drives_(drives), count_(std::move(count)) {
        ++*count_;
    }
    ~HandSession() { --*count_; }
    HandSession(const HandSession&) = delete;
    HandSession& operator=(const HandSession&) = delete;

    void read() {
        parser_.emplace();
        parser_->body_limit(max_body);
        stream_.expires_after(request_limit);
        bhttp::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](const beast::error_code& ec, std::size_t) {
            if (!ec) self->answer();
        });
    }

private:
    void answer() {
        const auto request = parser_->release();
        auto a = handle(drives_, request);
        response_ = {};
        response_.version(request.version());
        response_.result(a.status);
        response_.set(bhttp::field::content_type, a.status == bhttp::status::ok ? "application/json" : "application/problem+json");
        response_.set(bhttp::field::cache_control, "no-store");
        response_.keep_alive(request.keep_alive());
        response_.body() = json::serialize(a.body);
        response_.prepare_payload();
        bhttp::async_write(stream_, response_, [self = shared_from_this()](const beast::error_code& ec, std::size_t) {
            if (!ec && self->response_.keep_alive()) self->read();
        });
    }

    beast::tcp_stream stream_;
    const Drives& drives_;
    std::shared_ptr<std::size_t> count_;
    beast::flat_buffer buffer_{max_body + 16 * 1024};
    std::optional<bhttp::request_parser<bhttp::string_body>> parser_;
    bhttp::response<bhttp::string_body> response_;
};
}  // namespace

struct HandServer::Parts : std::enable_shared_from_this<HandServer::Parts> {
    Parts(asio::io_context& context, std::string b, Drives d) : bind(std::move(b)), drives(std::move(d)), acceptor(context) {}
    std::string bind;
    Drives drives;
    asio::ip::tcp::acceptor acceptor;
    std::shared_ptr<std::size_t> count = std::make_shared<std::size_t>(0);

    void accept() {
        acceptor.async_accept([self = shared_from_this()](const boost::system::error_code& ec, asio::ip::tcp::socket socket) {
            if (ec == asio::error::operation_aborted) return;
            if (!ec && *self->count < max_connections) std::make_shared<HandSession>(std::move(socket), self->drives, self->count)->read();
            self->accept();
        });
    }
};

HandServer::HandServer(asio::io_context& io, std::string bind, Drives drives)
    : parts_(std::make_shared<Parts>(io, std::move(bind), std::move(drives))) {}
HandServer::~HandServer() {
    boost::system::error_code ignored;
    parts_->acceptor.close(ignored);
}

std::string HandServer::open() {
    std::string wrong;
    const auto endpoint = parse_bind(parts_->bind, wrong);
    if (!endpoint) return "--hand: " + wrong;
    boost::system::error_code ec;
    auto& a = parts_->acceptor;
    a.open(endpoint->protocol(), ec);
    if (!ec) a.set_option(asio::socket_base::reuse_address(true), ec);
    if (!ec) a.bind(*endpoint, ec);
    if (!ec) a.listen(16, ec);
    if (ec) return fmt::format("--hand: cannot listen on {}: {}; choose another port", parts_->bind, ec.message());
    parts_->accept();
    return {};
}

std::string HandServer::address() const {
    boost::system::error_code ec;
    const auto e = parts_->acceptor.local_endpoint(ec);
    return fmt::format("{}:{}", e.address().is_v6() ? "[" + e.address().to_string() + "]" : e.address().to_string(), e.port());
}

}  // namespace axisgate::http
