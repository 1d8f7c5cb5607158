// Beast parses requests; the head of every answer is made here, and is sent in one gathered write with the body. After a last answer,
// received bytes are discarded for a while, so that the answer is not lost in a reset. A header's value never contains a line end.
#include "gateway/doors/http/connection.hpp"

#include <fmt/format.h>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_prefix.hpp>
#include <boost/beast/http/read.hpp>

#include <algorithm>
#include <array>

#include "gateway/doors/http/head.hpp"
#include "gateway/doors/http/websocket_session.hpp"

namespace axisgate::http {
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace {
constexpr std::size_t most_buffered = 64 * 1024;         // read ahead of the present request
constexpr std::size_t first_read_bytes = 4 * 1024;       // of a request; an idle connection holds them
constexpr int most_empty_lines = 2;                      // before a request, sent by themselves
constexpr std::uint8_t tls_handshake_record = 0x16;      // RFC 8446 5.1
constexpr std::size_t least_bytes_per_ms = 16;           // an answer of 1 MiB may take about a minute more than the limit of a step
constexpr std::size_t small_bytes = 64 * 1024;           // of a body or an answer that is not counted: every connection may always have
                                                         // this much
constexpr std::size_t usual_head_bytes = 768;            // of an answer
constexpr std::size_t written_at_once = 64 * 1024;       // of an answer, then other connections have their turn
constexpr std::size_t most_discarded = 2 * 1024 * 1024;  // read and discarded so that the last answer arrives

/// RFC 9110 5.6.7: "Sun, 06 Nov 1994 08:49:37 GMT". Made once per second and thread.
const std::string& http_date(std::int64_t unix_s) {
    thread_local std::int64_t made_for = -1;
    thread_local std::string made;
    if (made_for == unix_s && !made.empty()) return made;
    made_for = unix_s;
    using std::chrono::days, std::chrono::floor, std::chrono::hh_mm_ss, std::chrono::sys_seconds, std::chrono::weekday,
        std::chrono::year_month_day;
    static constexpr std::array<std::string_view, 7> weekdays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
    static constexpr std::array<std::string_view, 12> months{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                             "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    const sys_seconds t{std::chrono::seconds{unix_s}};
    const auto day = floor<days>(t);
    const year_month_day date{day};
    const hh_mm_ss time{t - day};
    made = fmt::format("{}, {:02} {} {:04} {:02}:{:02}:{:02} GMT", weekdays[weekday{day}.c_encoding()], static_cast<unsigned>(date.day()),
                       months[static_cast<unsigned>(date.month()) - 1], static_cast<int>(date.year()), time.hours().count(),
                       time.minutes().count(), time.seconds().count());
    return made;
}
}  // namespace

std::string response_head(const Response& r, bool keep, std::int64_t now_unix_s) {
    std::string s;
    s.reserve(usual_head_bytes);
    fmt::format_to(std::back_inserter(s), "HTTP/1.1 {} {}\r\n", r.status, phrase_of(r.status));
    for (const auto& [k, v] : r.headers.fields) {
        s += k;
        s += ": ";
        // A line end in a value would begin another header.
        const auto begin = static_cast<std::ptrdiff_t>(s.size());
        s += v;
        std::replace_if(
            s.begin() + begin, s.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
        s += "\r\n";
    }
    if (r.status != 101 && r.status != 204 && r.status != 304)
        fmt::format_to(std::back_inserter(s), "Content-Length: {}\r\n", r.body.size());
    if (r.status != 101 && r.headers.get("Connection").empty()) s += keep ? "Connection: keep-alive\r\n" : "Connection: close\r\n";
    s += "Date: ";
    s += http_date(now_unix_s);
    s += "\r\nServer: axisgate\r\n\r\n";
    return s;
}

Connection::Connection(Transport socket, std::shared_ptr<SessionHost> host, std::string peer, PlaceHolder holder)
    : socket_(std::move(socket)),
      host_(std::move(host)),
      peer_(std::move(peer)),
      holder_(holder),
      timer_(socket_.get_executor()),
      buffer_(most_buffered) {}

void Connection::start() {
    if (host_->tls) return await_handshake();
    await_request();
}

/// Peeks at the first byte: a TLS record of a handshake begins with 0x16, no HTTP request does.
void Connection::await_handshake() {
    phase_ = Phase::handshake;
    since_ = std::chrono::steady_clock::now();
    set_timer(host_->settings.header_limit);
    socket_.socket().async_wait(Transport::Socket::wait_read, [self = shared_from_this()](ErrorCode ec) {
        if (self->phase_ != Phase::handshake) return;
        std::uint8_t first = 0;
        auto& socket = self->socket_.socket();
        if (!ec) socket.non_blocking(true, ec);
        if (!ec) socket.receive(asio::buffer(&first, 1), asio::socket_base::message_peek, ec);
        if (ec) return self->close();
        if (first == tls_handshake_record) return self->shake_hands();
        self->fail(400, "bad_request", "this port speaks TLS: write https:// instead of http://");
    });
}

void Connection::shake_hands() {
    socket_.async_handshake(host_->tls->context, [self = shared_from_this()](ErrorCode ec) {
        if (self->phase_ != Phase::handshake) return;
        if (ec) {
            ++self->host_->counters.tls_handshakes_failed;
            return self->close();
        }
        ++self->host_->counters.tls_handshakes;
        self->await_request();
    });
}

Guest Connection::guest() const {
    Guest g;
    g.holder = holder_;
    g.since = Instant{since_.time_since_epoch()};
    // Half a request and an unread answer count as silence, because a few slow clients could otherwise occupy all places.
    const bool works = phase_ == Phase::answering || (known_ && phase_ == Phase::writing);
    g.standing = stop_path_ ? Standing::stop_path
                 : known_   ? (works ? Standing::knowns_work : Standing::known)
                 : works    ? Standing::strangers_work
                            : Standing::stranger;
    return g;
}

void Connection::stop() {
    stopping_ = true;
    switch (phase_) {
        case Phase::handshake:
        case Phase::idle:
        case Phase::header:
        case Phase::body:
        case Phase::lingering:
            return close();
        case Phase::answering:  // a waiting client gets the answer of its own time limit
            set_timer(std::min<std::chrono::nanoseconds>(host_->settings.answer_limit_at_stop, due_ - std::chrono::steady_clock::now()));
            return;
        case Phase::writing:
        case Phase::closed:
            return;
    }
}

void Connection::abort() { close(); }

void Connection::set_timer(std::chrono::nanoseconds after) {
    due_ = std::chrono::steady_clock::now() + std::chrono::duration_cast<asio::steady_timer::duration>(after);
    if (!timer_runs_ || due_ < timer_due_) arm_timer();
}

void Connection::arm_timer() {
    timer_runs_ = true;
    timer_due_ = due_;
    timer_.expires_at(due_);
    timer_.async_wait([self = weak_from_this(), serial = ++timer_serial_](ErrorCode ec) {
        const auto me = self.lock();
        if (ec || !me || serial != me->timer_serial_) return;
        me->timer_runs_ = false;
        if (std::chrono::steady_clock::now() < me->due_) return me->arm_timer();
        me->on_timer();
    });
}

void Connection::end_timer() {
    timer_runs_ = false;
    ++timer_serial_;
    timer_.cancel();
}

void Connection::on_timer() {
    switch (phase_) {
        case Phase::handshake:
            ++host_->counters.tls_handshakes_failed;
            [[fallthrough]];
        case Phase::idle:
            ++host_->counters.connections_timed_out;
            close();
            break;
        case Phase::header:
        case Phase::body:
            // The read ends with operation_aborted and is answered with 408.
            timed_out_ = true;
            ++host_->counters.connections_timed_out;
            socket_.cancel();
            break;
        case Phase::answering:
            if (at_limit_) answer(serial_, std::move(*at_limit_));
            break;
        case Phase::writing:
            ++host_->counters.connections_timed_out;
            close();
            break;
        case Phase::lingering:
            close();
            break;
        case Phase::closed:
            break;
    }
}

void Connection::await_request() {
    if (stopping_ || host_->stopping) return close();
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(2 * host_->settings.max_header_bytes));  // scan_head keeps the exact bound
    parser_->body_limit(boost::none);  // on_header sets it before any of the body is read
    empty_lines_ = 0;
    phase_ = Phase::idle;
    since_ = std::chrono::steady_clock::now();
    set_timer(first_ ? host_->settings.header_limit : host_->settings.idle_limit);
    if (buffer_.size() > 0) return read_header();
    await_bytes();
}

void Connection::await_bytes() {
    // Reads instead of waiting: over TLS bytes may be decrypted already while the socket is silent, and without TLS this saves a system
    // call per request. The bytes are counted when the parser takes them.
    socket_.async_read_some(buffer_.prepare(first_read_bytes), [self = shared_from_this()](ErrorCode ec, std::size_t bytes) {
        if (self->phase_ != Phase::idle) return;
        if (ec) return self->close();
        self->buffer_.commit(bytes);
        self->read_header();
    });
}

void Connection::read_header() {
    const auto bytes = buffer_.data();
    const auto scan = scan_head({static_cast<const char*>(bytes.data()), bytes.size()}, host_->settings.max_header_bytes);
    if (phase_ == Phase::idle && scan.verdict == HeadScan::Verdict::incomplete && scan.empty_lines == bytes.size() &&
        ++empty_lines_ <= most_empty_lines) {
        buffer_.consume(scan.empty_lines);  // an empty line alone begins no request
        return await_bytes();
    }
    if (phase_ != Phase::header) {
        phase_ = Phase::header;
        since_ = std::chrono::steady_clock::now();
        first_ = false;
        timed_out_ = false;
        set_timer(host_->settings.header_limit);
    }
    switch (scan.verdict) {
        case HeadScan::Verdict::incomplete:
            return read_more_header();
        case HeadScan::Verdict::too_large:
            return read_failed(beast::http::error::header_limit);
        case HeadScan::Verdict::malformed:
            return read_failed(beast::http::error::bad_line_ending);
        case HeadScan::Verdict::whole:
            buffer_.consume(scan.empty_lines);
            return parse_header(scan.bytes);
    }
}

void Connection::read_more_header() {
    socket_.async_read_some(buffer_.prepare(first_read_bytes), [self = shared_from_this()](ErrorCode ec, std::size_t bytes) {
        if (self->phase_ != Phase::header) return;
        if (ec) return self->read_failed(ec == asio::error::eof ? make_error_code(beast::http::error::end_of_stream) : ec);
        self->buffer_.commit(bytes);
        self->read_header();
    });
}

void Connection::parse_header(std::size_t bytes) {
    ErrorCode ec;
    parser_->eager(false);  // only the header: its limits come before the body
    const auto used = parser_->put(asio::buffer(buffer_.data(), bytes), ec);
    buffer_.consume(used);
    host_->counters.bytes_in += used;
    // A complete head cannot need more bytes unless this parser would end it elsewhere.
    on_header(ec == beast::http::error::need_more ? make_error_code(beast::http::error::bad_value) : ec);
}

void Connection::on_header(ErrorCode ec) {
    if (phase_ != Phase::header) return;
    if (ec) return read_failed(ec);
    take_head();
    if (auto fault = framing_fault(request_.headers, request_.http_1_0))
        return fail(fault->status, fault->status == 501 ? "not_supported" : "bad_request", std::move(fault->text));
    const auto expect = parser_->get()[beast::http::field::expect];
    if (!expect.empty() && !parser_->is_done() && !beast::iequals(expect, "100-continue"))
        return fail(417, "bad_request", "the only expectation that is met is 100-continue");
    most_body_bytes_ = host_->settings.max_stranger_bytes;
    // A small body is read before anything is decided: the connection can then be kept, and its answer cannot be lost. A long body, one
    // without a length, or one that is announced by Expect is not awaited if the client has no permission.
    const bool small = expect.empty() && request_.announced_bytes && *request_.announced_bytes <= most_body_bytes_;
    if (!parser_->is_done() && !small) {
        auto admission = host_->router.admit(request_);
        if (admission.refusal) return refuse(*std::move(admission.refusal));
        most_body_bytes_ = admission.max_body_bytes;
    }
    if (request_.announced_bytes.value_or(0) > most_body_bytes_) return read_failed(beast::http::error::body_limit);
    parser_->body_limit(most_body_bytes_);
    if (const std::size_t bytes = request_.announced_bytes.value_or(most_body_bytes_);
        !parser_->is_done() && bytes > small_bytes && !hold(bytes))
        return refuse(too_much_held());
    if (expect.empty() || parser_->is_done()) return read_body();
    if (parser_->get().version() < 11 || buffer_.size() > 0) return read_body();
    head_ = "HTTP/1.1 100 Continue\r\n\r\n";
    asio::async_write(socket_, asio::buffer(head_), [self = shared_from_this()](ErrorCode write_ec, std::size_t bytes) {
        self->host_->counters.bytes_out += bytes;
        if (self->phase_ != Phase::header) return;
        if (write_ec) return self->close();
        self->read_body();
    });
}

void Connection::read_body() {
    phase_ = Phase::body;
    timed_out_ = false;
    if (buffer_.size() > 0 && !parser_->is_done()) {
        // Bytes that arrived with the head are taken at once: a read that is satisfied by them would call back behind everything that is
        // ready by then.
        ErrorCode ec;
        parser_->eager(true);
        const auto used = parser_->put(buffer_.data(), ec);
        buffer_.consume(used);
        host_->counters.bytes_in += used;
        if (ec && ec != beast::http::error::need_more) return on_body(ec);
    }
    if (parser_->is_done()) return on_body({});
    set_timer(host_->settings.body_limit);
    beast::http::async_read(socket_, buffer_, *parser_, [self = shared_from_this()](ErrorCode ec, std::size_t bytes) {
        self->host_->counters.bytes_in += bytes;
        self->on_body(ec);
    });
}

void Connection::on_body(ErrorCode ec) {
    if (phase_ != Phase::body) return;
    if (ec) return read_failed(ec);
    phase_ = Phase::answering;
    since_ = std::chrono::steady_clock::now();
    at_limit_.reset();
    if (host_->router.moves(request_)) return answer_request();
    host_->later->put([self = weak_from_this(), serial = ++serial_] {
        if (const auto me = self.lock(); me && me->phase_ == Phase::answering && me->serial_ == serial) me->answer_request();
    });
}

void Connection::read_failed(ErrorCode ec) {
    using beast::http::error;
    if (timed_out_) return fail(408, "time_out", "the request did not come in time");
    if (ec == error::end_of_stream || ec == asio::error::operation_aborted) return close();
    if (ec == error::header_limit || ec == error::buffer_overflow) {
        return fail(431, "headers_too_large",
                    fmt::format("request line and headers may have {} bytes together", host_->settings.max_header_bytes));
    }
    if (ec == error::body_limit) return fail(413, "too_large", fmt::format("a body may have {} bytes here", most_body_bytes_));
    if (ec == error::bad_version) return fail(505, "bad_request", "this gateway speaks HTTP/1.1");
    const bool is_http_fault = ec.category() == make_error_code(error::bad_method).category();
    if (is_http_fault && ec != error::partial_message) return fail(400, "bad_request", fmt::format("this is not HTTP: {}", ec.message()));
    close();  // the connection broke
}

void Connection::fail(unsigned status, std::string_view reason, std::string detail) {
    ++host_->counters.malformed;
    ++serial_;
    since_ = std::chrono::steady_clock::now();
    request_ = {};
    Response r = problem(status, reason, std::move(detail));
    r.headers.set("Cache-Control", "no-store");
    r.headers.set("X-Content-Type-Options", "nosniff");
    host_->counters.answered("none", "none", status, 0);
    write(std::move(r), false);
}

/// Takes the request without its body. Fields of a trailer behind the body are ignored, because the role was decided without them.
void Connection::take_head() {
    const auto& m = parser_->get();
    request_ = {};
    request_.method = method_named(std::string_view(m.method_string()));
    request_.target = std::string(m.target());
    request_.http_1_0 = m.version() < 11;
    request_.headers.fields.reserve(16);
    for (const auto& f : m)
        request_.headers.fields.emplace_back(std::string(f.name_string()), std::string(f.value()));
    if (const auto length = parser_->content_length()) request_.announced_bytes = *length;
    request_.peer = peer_;
    request_.secure = socket_.secure();
    close_after_ = false;
}

/// Counts the memory of a large body or answer; returns false if there is no capacity now.
bool Connection::hold(std::size_t bytes) {
    if (!host_->budget.take(bytes)) return false;
    held_ += bytes;
    return true;
}

Response Connection::too_much_held() const {
    Response r = problem(
        503, "busy",
        fmt::format("large answers and bodies of all clients together hold {} MiB already, and wait to be read: come again in a moment",
                    host_->budget.most >> 20));
    r.headers.set("Retry-After", "2");
    r.headers.set("Cache-Control", "no-store");
    return r;
}

/// Answers before the body has arrived. The connection ends with this answer; bytes of the client are read for a while and discarded.
void Connection::refuse(Response response) {
    phase_ = Phase::answering;
    since_ = std::chrono::steady_clock::now();
    close_after_ = true;
    route_ = host_->router.route_of(request_);
    answer(++serial_, std::move(response));
}

void Connection::answer_request() {
    request_.body = std::move(parser_->get().body());
    const std::uint64_t serial = ++serial_;
    auto handled = host_->router.handle(request_, [self = weak_from_this(), serial](Response r) {
        if (const auto me = self.lock()) me->answer(serial, std::move(r));
    });
    route_ = handled.route;
    known_ = handled.known.value_or(known_);
    commands_ = handled.commands;
    if (handled.now) return answer(serial, std::move(*handled.now));
    at_limit_ = std::move(handled.at_limit);
    set_timer(handled.limit);
}

void Connection::answer(std::uint64_t serial, Response response) {
    if (phase_ != Phase::answering || serial != serial_) return;  // too late: the time limit has answered already
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - since_).count();
    const auto method = request_.method == Method::other ? std::string_view("other") : name_of(request_.method);
    host_->counters.answered(route_, method, response.status, took_s);
    stop_path_ = stop_path_ || (commands_ && response.status < 400);
    const bool keep = !close_after_ && parser_->get().keep_alive() && !stopping_ && !host_->stopping;
    write(std::move(response), keep);
}

void Connection::write(Response response, bool keep) {
    phase_ = Phase::writing;
    at_limit_.reset();
    request_.body.clear();
    request_.body.shrink_to_fit();
    if (held_ > 0) host_->budget.give_back(held_);
    if (!response.without_body && response.body.size() > small_bytes && !hold(response.body.size())) response = too_much_held();
    const auto now_s = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
    if (socket_.secure() && !host_->tls->self_made) response.headers.set("Strict-Transport-Security", "max-age=31536000");
    head_ = response_head(response, keep, now_s);
    const bool upgraded = response.status == 101;
    body_ = response.without_body ? std::string() : std::move(response.body);
    unsent_.emplace(std::array<asio::const_buffer, 2>{asio::buffer(head_), asio::buffer(body_)});
    write_end_ =
        std::chrono::steady_clock::now() + host_->settings.write_limit + std::chrono::milliseconds(body_.size() / least_bytes_per_ms);
    write_on(keep, upgraded);
}

void Connection::write_on(bool keep, bool upgraded) {
    // The limit applies to each step, so that a long answer may take its time on a slow link; a reader that makes almost no progress is cut
    // all the same.
    set_timer(std::min<std::chrono::nanoseconds>(host_->settings.write_limit, write_end_ - std::chrono::steady_clock::now()));
    const auto part = beast::buffers_prefix(written_at_once, *unsent_);
    socket_.async_write_some(part, [self = shared_from_this(), keep, upgraded](ErrorCode ec, std::size_t bytes) {
        self->host_->counters.bytes_out += bytes;
        if (self->phase_ != Phase::writing) return;
        if (ec) return self->close();
        self->unsent_->consume(bytes);
        if (beast::buffer_bytes(*self->unsent_) > 0) return self->write_on(keep, upgraded);
        self->on_written(keep, upgraded);
    });
}

void Connection::on_written(bool keep, bool upgraded) {
    if (held_ > 0) {
        body_ = {};
        unsent_.reset();
        host_->budget.give_back(held_);
    }
    if (upgraded) return upgrade();
    if (keep && !stopping_) return await_request();
    linger();
}

void Connection::upgrade() {
    end_timer();
    phase_ = Phase::closed;
    const auto data = static_cast<const std::uint8_t*>(buffer_.data().data());
    auto session = std::make_shared<WebSocketSession>(std::move(socket_), host_, std::move(request_), holder_);
    std::vector<std::uint8_t> early(data, data + buffer_.size());
    auto self = shared_from_this();  // this connection ends here, and the session takes its place
    host_->add(session);
    host_->remove(this);
    session->start(early);
}

void Connection::linger() {
    // Closing with unread bytes resets the connection, and the client may lose the answer: the end is sent first, and reading continues for
    // a while.
    phase_ = Phase::lingering;
    buffer_.clear();
    discarded_ = 0;
    set_timer(host_->settings.linger_limit);
    socket_.end_sending([self = shared_from_this()] {
        if (self->phase_ == Phase::lingering) self->discard();
    });
}

void Connection::discard() {
    socket_.socket().async_read_some(buffer_.prepare(16 * 1024), [self = shared_from_this()](ErrorCode ec, std::size_t bytes) {
        if (self->phase_ != Phase::lingering) return;
        self->discarded_ += bytes;
        if (ec || self->discarded_ > most_discarded) return self->close();
        self->discard();
    });
}

void Connection::close() {
    if (phase_ == Phase::closed) return;
    phase_ = Phase::closed;
    end_timer();
    if (held_ > 0) host_->budget.give_back(held_);
    ErrorCode ignored;
    socket_.close(ignored);
    host_->remove(this);
}

}  // namespace axisgate::http
