// StreamLine: a line over one file descriptor with bytes in both directions: a serial port, a TCP connection, a pseudo-terminal.
// The derived class provides a non-blocking descriptor. Received bytes are passed on in runs, one frame each; frames to send are
// written together, with one call per turn. The amount per turn is bounded, because other lines share the loop.
#pragma once

#include <array>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/lines/real_line.hpp"

namespace axisgate {

class StreamLine : public RealLine {
public:
    explicit StreamLine(const LineBase& base);

protected:
    /// Takes ownership of the descriptor, also if it fails: then it returns false and sets `why`. `is_socket`: write without SIGPIPE.
    [[nodiscard]] bool attach(int fd, bool is_socket, std::string& why);
    void begin_reading();
    [[nodiscard]] int fd() noexcept { return port_ ? port_->native_handle() : -1; }
    /// The time that one byte takes on the wire, for the load; zero: unknown.
    void set_byte_time(Duration d) noexcept { byte_time_ = d; }

    void stop() override;
    void flush() override;
    /// Called with the bytes that were read; may change them, and returns how many of them are valid.
    [[nodiscard]] virtual std::size_t filter(std::span<std::uint8_t> data) { return data.size(); }
    /// How many bytes may be written to the transport now. 0: the line asks again after pause_before_write().
    [[nodiscard]] virtual std::size_t room_to_write() { return chunk; }
    [[nodiscard]] virtual Duration pause_before_write() const { return std::chrono::milliseconds(1); }
    /// Called after `bytes` bytes were written to the transport; `more`: others wait behind them.
    virtual void wrote(std::size_t bytes, bool more) {
        (void)bytes;
        (void)more;
    }
    /// How many bytes may be read now. 0: the line asks again after pause_before_read(). Unread bytes wait in the kernel's buffer.
    [[nodiscard]] virtual std::size_t room_to_read() { return chunk; }
    [[nodiscard]] virtual Duration pause_before_read() const { return std::chrono::milliseconds(1); }
    /// Called after `bytes` bytes were read; `more`: there may be others. 0 bytes: there were none.
    virtual void got(std::size_t bytes, bool more) {
        (void)bytes;
        (void)more;
    }
    /// The instant at which the byte that is `before_the_last` bytes from the end of the present read had crossed the wire; the time stamp
    /// of its frame.
    [[nodiscard]] virtual Instant crossed(std::size_t before_the_last) const {
        (void)before_the_last;
        return clock().now();
    }
    /// The largest number of bytes passed on as one frame: bytes that have crossed together.
    [[nodiscard]] virtual std::size_t run() const { return Frame::capacity; }
    /// Reading or writing failed, or (error 0) the other side has closed. By default the line goes down.
    virtual void on_gone(int error);

    /// Discards the rest of a frame that was begun, because its receiver is gone.
    void drop_partial() noexcept { partial_done_ = 0; }

    static constexpr std::size_t chunk = 4096;

private:
    static constexpr int reads_per_turn = 8;
    static constexpr int writes_per_turn = 16;
    static constexpr std::size_t frames_per_write = 16;

    void on_readable();
    [[nodiscard]] bool hand_up(std::span<std::uint8_t> data);
    [[nodiscard]] bool account_written(std::size_t bytes, std::size_t frames);
    [[nodiscard]] bool nothing_more_will_come();
    void wait_writable();

    std::optional<asio::posix::stream_descriptor> port_;
    asio::steady_timer write_timer_, read_timer_;
    bool is_socket_ = false;
    bool write_waits_ = false;
    Duration byte_time_{};
    Frame partial_;                 // a frame that is partly written: its rest must follow directly
    std::size_t partial_done_ = 0;  // bytes of it that are written; 0: there is no such frame
    std::vector<Frame> sent_;
    std::array<std::uint8_t, chunk> buffer_;
};

}  // namespace axisgate
