// StreamLine: a line that is one file descriptor with bytes both ways: a serial port, a TCP connection, a pseudo-terminal.
// In: a non-blocking descriptor from the derived class. Out: runs of bytes as frames; frames written together, one call per turn.
// Never reads or writes more than a bounded amount per turn: other lines share the loop.
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
    /// Takes the descriptor over (also when it fails: then false, and `why` says so). `is_socket`: write without SIGPIPE.
    [[nodiscard]] bool attach(int fd, bool is_socket, std::string& why);
    void begin_reading();
    [[nodiscard]] int fd() noexcept { return port_ ? port_->native_handle() : -1; }
    /// Each byte takes this long on the wire, for the load; zero: not known.
    void set_byte_time(Duration d) noexcept { byte_time_ = d; }

    void stop() override;
    void flush() override;
    /// Bytes that were read; may change them, and returns how many of them count.
    [[nodiscard]] virtual std::size_t filter(std::span<std::uint8_t> data) { return data.size(); }
    /// How many bytes the transport should be given now. 0: asked again after pause_before_write().
    [[nodiscard]] virtual std::size_t room_to_write() { return chunk; }
    [[nodiscard]] virtual Duration pause_before_write() const { return std::chrono::milliseconds(1); }
    /// So many bytes were given to the transport; `more`: others wait behind them.
    virtual void wrote(std::size_t bytes, bool more) {
        (void)bytes;
        (void)more;
    }
    /// How many bytes may be read now. 0: asked again after pause_before_read(). What is not read waits in the kernel's buffer.
    [[nodiscard]] virtual std::size_t room_to_read() { return chunk; }
    [[nodiscard]] virtual Duration pause_before_read() const { return std::chrono::milliseconds(1); }
    /// So many bytes were read; `more`: there may be others. 0 bytes: there are none after all.
    virtual void got(std::size_t bytes, bool more) {
        (void)bytes;
        (void)more;
    }
    /// When the byte had crossed that stands so many bytes before the last one of the read in hand; frames are stamped so.
    [[nodiscard]] virtual Instant crossed(std::size_t before_the_last) const {
        (void)before_the_last;
        return clock().now();
    }
    /// Bytes that are handed up as one frame, at most: those that have crossed together.
    [[nodiscard]] virtual std::size_t run() const { return Frame::capacity; }
    /// Reading or writing failed, or (error 0) the other side has ended. Normally the line goes down.
    virtual void on_gone(int error);

    /// The rest of a frame that was begun has nobody to go to any more.
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
    Frame partial_;                 // a frame whose first bytes are written: nothing may come between them and the rest
    std::size_t partial_done_ = 0;  // 0: there is none
    std::vector<Frame> sent_;
    std::array<std::uint8_t, chunk> buffer_;
};

}  // namespace axisgate
