// CanLine: a SocketCAN interface as a line.
// It sends and receives CAN frames, passes on error reports, and calls on_sent when a frame has really been on the bus. At most four
// frames are with the controller at a time: the others wait in the queue of the line, where a stop can overtake them.
#pragma once

#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/lines/can_kernel.hpp"
#include "gateway/lines/can_link.hpp"
#include "gateway/lines/real_line.hpp"

namespace axisgate {

struct CanLineOptions {
    std::uint32_t bit_rate = 0;                      ///< bit/s, used for the bus load if the interface does not report it (vcan, slcan); 0:
                                                     ///< unknown
    std::vector<CanFilter> filters;                  ///< identifiers to receive; empty, or more than most_can_filters: all
    PauseRange restart_pauses{};                     ///< pause between two restarts of a controller that is bus-off
    Duration stall_limit = std::chrono::seconds(1);  ///< frames without an echo for this long count as not acknowledged
};

class CanLine final : public RealLine {
public:
    struct Counters {
        std::uint64_t bus_off = 0;
        std::uint64_t restarts_asked = 0;
        std::uint64_t rx_lost = 0;     ///< frames lost because our receive buffer was full
        std::uint64_t tx_full = 0;     ///< number of times the queue of the interface was full
        std::uint64_t tx_stalled = 0;  ///< number of times no frame was sent for a second
    };

    CanLine(const LineBase& base, std::string interface, CanLineOptions options = {}, const CanKernel& kernel = linux_can());
    ~CanLine() override;

    /// Replaces the filters; a line that is open is opened again with them.
    void set_filters(std::vector<CanFilter> filters);
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }

private:
    struct Batch;
    enum class After : std::uint8_t { go_on, wait, gone };

    void start() override;
    void stop() override;
    void let_go() override { links_.reset(); }
    void flush() override;
    [[nodiscard]] bool takes(const Frame& frame) const override { return frame.kind == Frame::Kind::can; }
    [[nodiscard]] std::string up_text() const override;

    // Those that return bool return whether the line still exists afterwards and is still in the same attempt.
    void begin_reading();
    void on_readable();
    [[nodiscard]] After read_batch();
    [[nodiscard]] bool on_message(const ::can_frame& frame, int flags, Instant at);
    [[nodiscard]] bool on_report(const ::can_frame& frame, Instant at);
    [[nodiscard]] bool on_echo(Frame frame);
    void count_lost(std::uint32_t so_far) noexcept;
    [[nodiscard]] Duration time_of(const Frame& frame) const noexcept;

    void wait_until_writable();
    void wait_before_sending(Duration pause);
    void watch_for_stall();

    // Changes of the interface itself are in can_line_link.cpp.
    [[nodiscard]] bool bus_off();
    [[nodiscard]] bool back_from_bus_off();
    [[nodiscard]] std::string bus_off_text() const;
    void ask_for_restart_later();
    void ask_for_restart();
    void open_links();
    void wait_for_links();
    void read_links();
    [[nodiscard]] bool on_news(const LinkNews& news);
    void on_answer(const LinkNews& answer);
    void ask(const std::vector<std::uint8_t>& request);

    std::string interface_;
    CanLineOptions options_;
    const CanKernel& kernel_;
    std::optional<asio::posix::stream_descriptor> raw_;
    std::optional<asio::posix::stream_descriptor> links_;  // open from the first attempt to close()
    int index_ = 0;
    std::unique_ptr<Batch> batch_;
    std::vector<std::uint8_t> link_buffer_;

    asio::steady_timer send_timer_, stall_timer_, restart_timer_;
    std::size_t in_flight_ = 0;  // frames given to the kernel whose echo has not arrived
    bool send_waits_ = false;
    bool stall_watched_ = false;
    bool stalled_ = false;  // no node acknowledges
    Duration full_pause_{};
    Instant progress_{};  // the last echo, or the first frame sent while none was outstanding
    std::vector<Frame> unechoed_;
    std::optional<std::uint32_t> lost_before_;

    std::uint32_t bit_rate_ = 0;
    CanState can_state_ = CanState::active;
    std::optional<std::uint32_t> restart_ms_;
    GrowingPause restart_pause_;
    Instant back_since_{};
    std::string restart_refused_;  // why the kernel refuses to restart the controller for us
    std::uint32_t sequence_ = 0;
    std::uint32_t restart_sequence_ = 0;
    Counters counters_;
};

}  // namespace axisgate
