// There is one timer for the silence after a frame. It is not moved for every run of bytes: if it expires too early, it is set again.
#include "gateway/doors/modbus/rtu_door.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <utility>

#include "gateway/core/event.hpp"
#include "gateway/doors/modbus/words.hpp"

namespace axisgate::modbus {
namespace {
constexpr auto rtu_sweep_period = std::chrono::milliseconds(250);

std::string rtu_metrics_text(const Counters& pdus, const RtuCounters& c, const RtuReceiverCounters& line, bool up) {
    std::string s;
    const auto put = [&](std::string_view name, std::string_view type, std::string_view help, std::uint64_t value) {
        s += fmt::format("# HELP axisgate_modbus_rtu_{0} {1}\n# TYPE axisgate_modbus_rtu_{0} {2}\naxisgate_modbus_rtu_{0} {3}\n", name,
                         help, type, value);
    };
    put("up", "gauge", "1 while the port is open.", up ? 1 : 0);
    put("requests_total", "counter", "Requests to this gateway, broadcasts among them.", pdus.requests.value());
    put("answers_total", "counter", "Answers sent, exceptions among them.", c.answers.value());
    put("broadcasts_total", "counter", "Requests to address 0.", c.broadcasts.value());
    put("late_answers_total", "counter", "Answers not sent: the master had begun something else before the drive answered.",
        c.late_answers.value());
    put("frames_total", "counter", "Frames with a right checksum, of all slaves.", line.frames.value());
    put("foreign_frames_total", "counter", "Frames of other slaves.", c.foreign.value());
    put("bad_frames_total", "counter", "Runs of bytes with a wrong checksum, or too short.", line.bad_frames.value());
    put("overlong_frames_total", "counter", "Runs of more than 256 bytes without a silence.", line.overlong.value());
    put("gaps_total", "counter", "Pauses of more than 1.5 characters within a frame.", line.gaps.value());
    put("echoes_total", "counter", "Answers that the port gave back.", line.echoes.value());
    s += "# HELP axisgate_modbus_rtu_exceptions_total Exception answers by code.\n# TYPE axisgate_modbus_rtu_exceptions_total counter\n";
    for (const int code : {1, 2, 3, 4, 6, 10, 11}) {
        s += fmt::format("axisgate_modbus_rtu_exceptions_total{{code=\"{}\"}} {}\n", code,
                         pdus.exceptions[static_cast<std::size_t>(code)].value());
    }
    s += metric_head("axisgate_modbus_rtu_request_duration_seconds", "histogram",
                     "From the silence behind a request to its answer, drives included.");
    s += metric_lines("axisgate_modbus_rtu_request_duration_seconds", pdus.request_times.read());
    return s;
}
}  // namespace

class RtuDoor::Impl final : public HotDoor, public LineEvents, public RtuSink, public std::enable_shared_from_this<RtuDoor::Impl> {
public:
    Impl(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, RtuSettings settings, std::unique_ptr<Line> line)
        : io_(io),
          port_(port),
          settings_(std::move(settings)),
          responder_(port, image, settings_.responder),
          receiver_(settings_.timing),
          session_(responder_, image, *this, settings_.address, std::make_shared<const std::string>(settings_.port)),
          line_(std::move(line)),
          silence_(io),
          sweep_(io) {
        Origin origin;
        origin.door = clients;
        origin.who = std::make_shared<const std::string>(settings_.port);
        client_ = AuthorityClient::of(origin);
        responder_.writer().use_number(port_.attach(*this));
    }
    ~Impl() override { port_.detach(*this); }

    void open() { line_->open(*this, port_.now()); }
    void close() {
        line_->close();
        silence_.cancel();
        sweep_.cancel();
        session_.give_up();
        up_.remove(up_.value());
    }

    // --- HotDoor
    [[nodiscard]] std::span<const WayIn> ways_in() const override { return rtu_ways; }
    [[nodiscard]] std::string_view name() const override { return "modbus_rtu"; }
    [[nodiscard]] std::vector<std::string> addresses() const override { return {settings_.text}; }
    void on_result(const Result& result) override { responder_.writer().on_result(result); }
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient& client) const override {
        return client == client_ && up() ? session_.received() : std::nullopt;
    }
    [[nodiscard]] std::string metrics() const override {
        return rtu_metrics_text(std::as_const(responder_).counters(), session_.counters(), receiver_.counters(), up());
    }

    // --- LineEvents
    void on_frame(const Frame& frame) override {
        const auto before = receiver_.feed(frame.data(), frame.at);
        if (before) session_.on_frame(*before, port_.now(), true);
        if (receiver_.busy()) session_.give_up();
        watch_silence();
    }
    void on_sent(const Frame&) override {}
    void on_line_state(bool up, const std::string& why) override {
        receiver_.reset();
        session_.give_up();
        const bool was = this->up();
        if (up && !was) up_.add();
        if (!up && was) up_.remove();
        since_ = port_.now();
        tell(up, why);
        // The master can no longer stop the motion that it has ordered.
        if (!up && session_.has_commanded()) {
            session_.forget_commands();
            port_.client_lost(client_, loss_closed);
        }
    }

    // --- RtuSink
    void send(std::span<const std::uint8_t> adu, bool repeats_request) override {
        const Instant now = port_.now();
        receiver_.sent(adu, repeats_request, now);
        (void)line_->send(Frame::run(adu), Priority::command, now);
    }
    void answered() override {
        // All results of a turn arrive before the posted function runs, and the image has their effects.
        boost::asio::post(io_, [weak = weak_from_this()] {
            if (const auto self = weak.lock()) self->session_.finish(self->port_.now());
        });
    }

    [[nodiscard]] Report report() const {
        Report r;
        r.up = up();
        r.peer = settings_.port;
        const Counters& pdus = responder_.counters();
        r.requests = pdus.requests.value();
        r.writes = session_.counters().writes.value();
        for (const auto& e : pdus.exceptions)
            r.exceptions += e.value();
        r.since = since_;
        return r;
    }
    [[nodiscard]] Responder& responder() noexcept { return responder_; }
    [[nodiscard]] const RtuReceiverCounters& line_counters() const noexcept { return receiver_.counters(); }
    [[nodiscard]] const RtuCounters& counters() const noexcept { return session_.counters(); }

private:
    [[nodiscard]] bool up() const noexcept { return up_.value() > 0; }

    void tell(bool up, const std::string& why) {
        Event e;
        e.kind = "modbus_rtu";
        e.severity = up ? Severity::info : Severity::warning;
        e.door = "modbus";
        e.who = settings_.port;
        e.text = up ? fmt::format("the Modbus RTU door is open: {}, slave address {}", why, settings_.address)
                    : fmt::format("the Modbus RTU door is shut: {}; it is tried again by itself", why);
        port_.note(std::move(e), no_axis);
    }

    void watch_silence() {
        if (waiting_ || !receiver_.busy()) return;
        waiting_ = true;
        silence_.expires_at(std::chrono::steady_clock::time_point(
            std::chrono::duration_cast<std::chrono::steady_clock::duration>(receiver_.deadline().time_since_epoch())));
        silence_.async_wait([weak = weak_from_this()](boost::system::error_code ec) {
            const auto self = weak.lock();
            if (!self) return;
            self->waiting_ = false;
            if (!ec) self->on_silence();
        });
    }
    void on_silence() {
        const Instant now = port_.now();
        if (const auto frame = receiver_.on_silence(now)) session_.on_frame(*frame, now);
        watch_silence();
        watch_writes();
    }
    void watch_writes() {
        if (sweeping_ || !responder_.writer().waits()) return;
        sweeping_ = true;
        sweep_.expires_after(rtu_sweep_period);
        sweep_.async_wait([weak = weak_from_this()](boost::system::error_code ec) {
            const auto self = weak.lock();
            if (!self) return;
            self->sweeping_ = false;
            if (ec) return;
            self->responder_.writer().sweep(self->port_.now());
            self->watch_writes();
        });
    }

    boost::asio::io_context& io_;
    DoorPort& port_;
    RtuSettings settings_;
    AuthorityClient client_;
    Responder responder_;
    RtuReceiver receiver_;
    RtuSession session_;
    std::unique_ptr<Line> line_;
    boost::asio::steady_timer silence_, sweep_;
    bool waiting_ = false;
    bool sweeping_ = false;
    Counter up_;  // 0 or 1; any thread
    Instant since_{};
};

RtuDoor::RtuDoor(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, RtuSettings settings,
                 std::unique_ptr<Line> line)
    : impl_(std::make_shared<Impl>(io, port, image, std::move(settings), std::move(line))) {}
RtuDoor::~RtuDoor() { impl_->close(); }
void RtuDoor::open() { impl_->open(); }
void RtuDoor::close() { impl_->close(); }
RtuDoor::Report RtuDoor::report() const { return impl_->report(); }
Responder& RtuDoor::responder() noexcept { return impl_->responder(); }
const RtuReceiverCounters& RtuDoor::line_counters() const noexcept { return impl_->line_counters(); }
const RtuCounters& RtuDoor::counters() const noexcept { return impl_->counters(); }

}  // namespace axisgate::modbus
