// A loop, an owner that records the line's events, a clock that can be set, and waiting for a condition with a bound. Tests never sleep:
// the loop runs until the condition is true or the bound is reached.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/line.hpp"
#include "gateway/lines/clock.hpp"
#include "gateway/lines/real_line.hpp"

namespace axisgate::test {

using std::chrono::milliseconds;
constexpr Duration secs(int n) { return std::chrono::seconds(n); }

/// The machine's clock, advanced by hand.
struct MovedClock final : Clock {
    Duration ahead{};
    [[nodiscard]] Instant now() const override { return machine_clock().now() + ahead; }
    [[nodiscard]] std::int64_t unix_ns() const override { return machine_clock().unix_ns() + ahead.count(); }
};

inline Frame text(std::string_view s) { return Frame::run({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()}); }
inline std::string as_text(const Frame& f) { return {f.data().begin(), f.data().end()}; }

struct Owner : LineEvents {
    std::vector<Frame> frames;
    std::vector<Frame> sent;
    std::vector<std::pair<bool, std::string>> states;
    std::function<void(const Frame&)> on_received;
    std::function<void(bool)> changes;

    void on_frame(const Frame& f) override {
        frames.push_back(f);
        if (on_received) on_received(f);
    }
    void on_line_state(bool up, const std::string& why) override {
        states.emplace_back(up, why);
        if (changes) changes(up);
    }
    void on_sent(const Frame& f) override { sent.push_back(f); }
    [[nodiscard]] bool up() const { return !states.empty() && states.back().first; }
    [[nodiscard]] std::string received() const {
        std::string s;
        for (const auto& f : frames)
            s += as_text(f);
        return s;
    }
};

class LineTest : public testing::Test {
protected:
    asio::io_context io{1};
    MovedClock clock;
    Owner owner;
    /// Short pauses, so that tests of reopening take milliseconds.
    [[nodiscard]] LineBase base(Duration first = milliseconds(5), Duration last = milliseconds(40)) { return {io, clock, {first, last}}; }

    /// Runs the loop until the condition is true; false after `limit`.
    bool until(const std::function<bool()>& condition, milliseconds limit = milliseconds(5000)) {
        const auto end = std::chrono::steady_clock::now() + limit;
        while (!condition()) {
            if (std::chrono::steady_clock::now() > end) return false;
            if (io.stopped()) io.restart();
            io.run_one_for(milliseconds(5));
        }
        return true;
    }
    /// Runs everything that is ready now, and its consequences.
    void settle() {
        for (int i = 0; i < 50; ++i) {
            if (io.stopped()) io.restart();
            if (io.poll() == 0) return;
        }
    }
    void run_for(milliseconds d) {
        if (io.stopped()) io.restart();
        io.run_for(d);
    }
    [[nodiscard]] bool comes_up(Line& line) {
        line.open(owner, clock.now());
        return until([&] { return owner.up(); });
    }
};

/// A descriptor that the destructor closes.
struct Fd {
    int fd = -1;
    Fd() = default;
    explicit Fd(int f) : fd(f) {}
    Fd(Fd&& o) noexcept : fd(std::exchange(o.fd, -1)) {}
    Fd& operator=(Fd&& o) noexcept {
        close();
        fd = std::exchange(o.fd, -1);
        return *this;
    }
    ~Fd() { close(); }
    void close() {
        if (fd >= 0) ::close(fd);
        fd = -1;
    }
    void write(std::string_view s) const { EXPECT_EQ(::write(fd, s.data(), s.size()), static_cast<ssize_t>(s.size())) << errno; }
    /// The available bytes; empty if there are none.
    [[nodiscard]] std::string read() const {
        std::string all;
        std::array<char, 4096> buffer{};
        for (;;) {
            const ssize_t n = ::read(fd, buffer.data(), buffer.size());
            if (n <= 0) return all;
            all.append(buffer.data(), static_cast<std::size_t>(n));
        }
    }
};

inline void no_wait(int fd) { ASSERT_EQ(::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK), 0); }

/// All 256 bytes, which a line must carry unchanged.
inline std::string every_byte() {
    std::string s;
    for (int i = 0; i < 256; ++i)
        s += static_cast<char>(i);
    return s;
}

}  // namespace axisgate::test
