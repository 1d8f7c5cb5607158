// CanLine, sending and receiving; changes of the interface itself are handled in can_line_link.cpp.
// A frame does not count as sent when the kernel accepts it, only when the controller's echo arrives.
#include "gateway/lines/can_line.hpp"

#include <fmt/core.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "gateway/core/wire_time.hpp"

namespace axisgate {
namespace {

constexpr std::size_t most_in_flight = 4;
constexpr std::size_t batch_size = 16;
constexpr int batches_per_turn = 4;
constexpr Duration full_pause_first = std::chrono::milliseconds(1), full_pause_last = std::chrono::milliseconds(16);

constexpr auto timer_duration(Duration d) noexcept { return std::chrono::duration_cast<std::chrono::steady_clock::duration>(d); }

}  // namespace

/// The buffers for one call of recvmmsg.
struct CanLine::Batch {
    std::array<::can_frame, batch_size> frames;
    std::array<std::array<std::uint8_t, 128>, batch_size> beside;
    std::array<iovec, batch_size> parts;
    std::array<mmsghdr, batch_size> messages;

    void prepare() noexcept {
        for (std::size_t i = 0; i < batch_size; ++i) {
            parts[i] = {&frames[i], sizeof frames[i]};
            messages[i] = {};
            messages[i].msg_hdr.msg_iov = &parts[i];
            messages[i].msg_hdr.msg_iovlen = 1;
            messages[i].msg_hdr.msg_control = beside[i].data();
            messages[i].msg_hdr.msg_controllen = beside[i].size();
        }
    }
};

CanLine::CanLine(const LineBase& base, std::string interface, CanLineOptions options, const CanKernel& kernel)
    : RealLine(base),
      interface_(std::move(interface)),
      options_(std::move(options)),
      kernel_(kernel),
      batch_(std::make_unique<Batch>()),
      send_timer_(base.io),
      stall_timer_(base.io),
      restart_timer_(base.io),
      bit_rate_(options_.bit_rate),
      restart_pause_(options_.restart_pauses) {}

CanLine::~CanLine() { close(); }

void CanLine::set_filters(std::vector<CanFilter> filters) {
    if (filters == options_.filters) return;
    options_.filters = std::move(filters);
    if (state() != State::up) return;
    asio::post(io(), guarded([this] { went_down(fmt::format("{} is opened anew with other filters", interface_)); }));
}

void CanLine::start() {
    open_links();
    CanOpened opened = kernel_.open_can(interface_, options_.filters);
    if (opened.fd < 0) return went_down(std::move(opened.fault));
    index_ = opened.index;
    raw_.emplace(io());
    boost::system::error_code error;
    raw_->assign(opened.fd, error);
    if (error) {
        ::close(opened.fd);
        return went_down(fmt::format("cannot use {}: {}", interface_, error.message()));
    }
    in_flight_ = 0;
    stalled_ = send_waits_ = stall_watched_ = false;
    restart_refused_.clear();
    can_state_ = CanState::active;
    status_.tx_errors = status_.rx_errors = 0;
    lost_before_.reset();
    full_pause_ = full_pause_first;
    if (!came_up(up_text())) return;
    begin_reading();
    ask(link_request(index_, ++sequence_));  // the controller may be bus-off already; the answer also gives its bit rate
}

void CanLine::stop() {
    raw_.reset();
    send_timer_.cancel();
    stall_timer_.cancel();
    restart_timer_.cancel();
}

std::string CanLine::up_text() const {
    std::string s = bit_rate_ == 0 ? fmt::format("up on {}", interface_) : fmt::format("up on {} at {} bit/s", interface_, bit_rate_);
    if (can_state_ != CanState::active) s += fmt::format(", {} (tx {}, rx {})", name_of(can_state_), status_.tx_errors, status_.rx_errors);
    if (stalled_) s += ", nobody acknowledges frames: is a drive connected and switched on, the bit rate right, the bus terminated?";
    return s;
}

// --- receiving ------------------------------------------------------------------------------------------------------

void CanLine::begin_reading() {
    raw_->async_wait(asio::posix::stream_descriptor::wait_read, guarded([this](const boost::system::error_code& error) {
                         if (!error) on_readable();
                     }));
}

void CanLine::on_readable() {
    for (int i = 0; i < batches_per_turn; ++i) {
        const After after = read_batch();
        if (after == After::gone) return;
        if (after == After::wait) break;
    }
    begin_reading();
}

CanLine::After CanLine::read_batch() {
    batch_->prepare();
    const int n = ::recvmmsg(raw_->native_handle(), batch_->messages.data(), batch_size, MSG_DONTWAIT, nullptr);
    if (n < 0) {
        if (errno == EINTR) return After::go_on;
        if (errno == EAGAIN || errno == EWOULDBLOCK) return After::wait;
        went_down(can_open_fault(interface_, "receive", errno));
        return After::gone;
    }
    const Instant now = clock().now();
    const std::int64_t unix_now_ns = clock().unix_ns();
    for (int i = 0; i < n; ++i) {
        const mmsghdr& m = batch_->messages[static_cast<std::size_t>(i)];
        if (m.msg_len != sizeof(::can_frame) || (m.msg_hdr.msg_flags & MSG_TRUNC) != 0) {
            ++status_.errors;
            continue;
        }
        const CanBeside beside = read_beside(m.msg_hdr);
        if (beside.overflow) count_lost(*beside.overflow);
        const Instant at = instant_of_stamp(beside.stamp_unix_ns, unix_now_ns, now);
        if (!on_message(batch_->frames[static_cast<std::size_t>(i)], m.msg_hdr.msg_flags, at)) return After::gone;
    }
    return static_cast<std::size_t>(n) < batch_size ? After::wait : After::go_on;
}

void CanLine::count_lost(std::uint32_t so_far) noexcept {
    const std::uint32_t more = so_far - lost_before_.value_or(0);
    lost_before_ = so_far;
    counters_.rx_lost += more;
    status_.errors += more;
}

bool CanLine::on_message(const ::can_frame& k, int flags, Instant at) {
    if ((k.can_id & CAN_ERR_FLAG) != 0) return on_report(k, at);
    Frame f = from_kernel(k);
    f.at = at;
    if (kernel_.is_echo(k, flags)) return on_echo(f);
    load_in_.add(at, time_of(f));
    count_received(1, f.size);
    return deliver(f);
}

Duration CanLine::time_of(const Frame& f) const noexcept {
    return bit_rate_ == 0 ? Duration::zero() : wire_time(can_bits(f) + can_intermission_bits, bit_rate_);
}

bool CanLine::on_report(const ::can_frame& k, Instant at) {
    const CanReport r = read_report(k);
    if (r.has_counters) {
        status_.tx_errors = r.tx_errors;
        status_.rx_errors = r.rx_errors;
    }
    if (r.state && *r.state != CanState::bus_off) can_state_ = *r.state;
    if (!r.restarted || r.bus_off) ++status_.errors;
    Frame f = from_kernel(k);
    f.at = at;
    if (!deliver(f)) return false;
    if (r.bus_off) return bus_off();
    if (r.restarted) return back_from_bus_off();
    return true;
}

bool CanLine::on_echo(Frame f) {
    if (in_flight_ > 0) --in_flight_;
    stalled_ = false;
    progress_ = clock().now();
    load_out_.add(f.at, time_of(f));
    if (!queue_.empty()) flush_soon();
    return tell_sent(f);
}

// --- sending --------------------------------------------------------------------------------------------------------

void CanLine::flush() {
    if (state() != State::up || send_waits_) return;
    const Instant now = clock().now();
    drop_stale(now);
    unechoed_.clear();
    while (!send_waits_ && in_flight_ < (stalled_ ? 1 : most_in_flight)) {
        const SendQueue::Entry* e = queue_.front();
        if (e == nullptr) break;
        const int error = kernel_.send(raw_->native_handle(), to_kernel(e->frame));
        switch (error) {
            case 0:
                full_pause_ = full_pause_first;
                if (passes(options_.filters, e->frame)) {
                    if (in_flight_++ == 0) progress_ = now;
                    watch_for_stall();
                } else {
                    unechoed_.push_back(e->frame);  // our own receive filter hides its echo
                }
                queue_.pop();
                break;
            case EAGAIN:
                wait_until_writable();
                break;
            case ENOBUFS:  // the interface's queue is full, although poll would report the socket as writable
                ++counters_.tx_full;
                wait_before_sending(full_pause_);
                full_pause_ = std::min(full_pause_ * 2, full_pause_last);
                break;
            case EINVAL:
            case EMSGSIZE:  // the interface refuses this frame, but may accept others
                ++status_.errors;
                ++status_.dropped;
                queue_.pop();
                break;
            default:
                ++status_.errors;
                return went_down(can_open_fault(interface_, "send", error));
        }
    }
    for (Frame& f : unechoed_) {
        f.at = now;
        load_out_.add(now, time_of(f));
        if (!tell_sent(f)) return;
    }
}

void CanLine::wait_until_writable() {
    send_waits_ = true;
    raw_->async_wait(asio::posix::stream_descriptor::wait_write, guarded([this](const boost::system::error_code& error) {
                         if (error) return;
                         send_waits_ = false;
                         flush();
                     }));
}

void CanLine::wait_before_sending(Duration pause) {
    send_waits_ = true;
    send_timer_.expires_after(timer_duration(pause));
    send_timer_.async_wait(guarded([this](const boost::system::error_code& error) {
        if (error) return;
        send_waits_ = false;
        flush();
    }));
}

/// Echoes can be missing because no node acknowledges or because they were lost in a full receive buffer. Then one frame at a time is
/// tried.
void CanLine::watch_for_stall() {
    if (stall_watched_) return;
    stall_watched_ = true;
    stall_timer_.expires_after(timer_duration(options_.stall_limit));
    stall_timer_.async_wait(guarded([this](const boost::system::error_code& error) {
        if (error) return;
        stall_watched_ = false;
        if (in_flight_ == 0) return;
        if (clock().now() - progress_ < options_.stall_limit) return watch_for_stall();
        stalled_ = true;
        in_flight_ = 0;
        ++counters_.tx_stalled;
        ++status_.errors;
        flush();
    }));
}

}  // namespace axisgate
