// PtyLine: see pty_line.hpp. In: readiness of the pseudo-terminal's master. Out: frames.
// Never goes down because the other side closes: the next program finds the same name.
#include "gateway/lines/pty_line.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/lines/error_text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>

namespace axisgate {
namespace {

/// How often we look whether somebody has opened the other side: the first bytes of a program wait at most this long.
constexpr auto look_every = std::chrono::milliseconds(10);

/// On Linux the master's settings are those of the slave. Every program starts from raw mode, whatever the last one left.
bool make_raw(int master) noexcept {
    termios t{};
    if (::tcgetattr(master, &t) != 0) return false;
    ::cfmakeraw(&t);
    t.c_cflag |= CLOCAL | CREAD;
    return ::tcsetattr(master, TCSANOW, &t) == 0;
}

/// Somebody has the other side open, or had it open just now and left something to read.
bool is_worth_reading(int master) noexcept {
    pollfd p{master, POLLIN, 0};
    return ::poll(&p, 1, 0) >= 0 && ((p.revents & POLLHUP) == 0 || (p.revents & POLLIN) != 0);
}

/// What a program left unread is partly on its way and partly in its terminal's own buffer, which only its own side can empty.
void throw_away_unread(int master, const std::string& slave) noexcept {
    (void)::tcflush(master, TCOFLUSH);
    const int fd = ::open(slave.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) return;
    (void)::tcflush(fd, TCIFLUSH);
    ::close(fd);
}

std::string target_of(const std::string& path) {
    std::array<char, PATH_MAX> buffer{};
    const ssize_t n = ::readlink(path.c_str(), buffer.data(), buffer.size());
    return n > 0 ? std::string(buffer.data(), static_cast<std::size_t>(n)) : std::string();
}

/// Puts the link; a link that is there already is taken as left over from before. Empty, or what is wrong.
std::string put_link(const std::string& target, const std::string& path) {
    struct stat there {};
    if (::lstat(path.c_str(), &there) == 0) {
        if (!S_ISLNK(there.st_mode)) return fmt::format("{} exists and is not a link: choose another path, or remove it", path);
        if (::unlink(path.c_str()) != 0) return fmt::format("cannot remove the old link {}: {}", path, error_text(errno));
    }
    if (::symlink(target.c_str(), path.c_str()) != 0) {
        return fmt::format("cannot make the link {}: {}: does its folder exist, and may this user write there?", path, error_text(errno));
    }
    return {};
}

}  // namespace

PtyLine::PtyLine(const LineBase& base, std::string path, std::uint32_t pace_baud, const SerialFormat& pace_format)
    : StreamLine(base),
      path_(std::move(path)),
      pace_baud_(pace_baud),
      pace_format_(pace_format),
      out_(wire_time(pace_format.bits_per_byte(), pace_baud)),
      in_(out_),
      watch_(base.io) {
    if (pace_baud == 0) return;
    set_byte_time(wire_time(pace_format.bits_per_byte(), pace_baud));
    one_wire_ = false;
}

void PtyLine::start() {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    std::array<char, 128> name{};
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0 || ::ptsname_r(master, name.data(), name.size()) != 0 ||
        !make_raw(master)) {
        const int error = errno;
        if (master >= 0) ::close(master);
        return went_down(fmt::format("cannot make a pseudo-terminal: {}", error_text(error)));
    }
    // Opened and closed once, the master says from the beginning what it says later: that nobody is there.
    if (const int slave = ::open(name.data(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC); slave >= 0) ::close(slave);
    if (std::string wrong = put_link(name.data(), path_); !wrong.empty()) {
        ::close(master);
        return went_down(std::move(wrong));
    }
    slave_ = name.data();
    std::string why;
    if (!attach(master, false, why)) return went_down(fmt::format("cannot use the pseudo-terminal {}: {}", slave_, why));
    somebody_ = false;
    if (came_up(up_text())) watch_for_somebody();
}

void PtyLine::stop() {
    watch_.cancel();
    if (!slave_.empty() && target_of(path_) == slave_) ::unlink(path_.c_str());
    slave_.clear();
    out_.stop();
    in_.stop();
    StreamLine::stop();
}

std::string PtyLine::up_text() const {
    const std::string pace =
        pace_baud_ == 0 ? std::string() : fmt::format(", at the pace of {} baud {}", pace_baud_, to_text(pace_format_));
    return fmt::format("up as {} ({}){}, {}", path_, slave_, pace, somebody_ ? "opened by a program" : "not opened by anybody");
}

void PtyLine::watch_for_somebody() {
    if (is_worth_reading(fd())) {
        somebody_ = true;
        begin_reading();
        return;
    }
    watch_.expires_after(look_every);
    watch_.async_wait(guarded([this](const boost::system::error_code& error) {
        if (!error) watch_for_somebody();
    }));
}

void PtyLine::on_gone(int error) {
    if (error != EIO && error != 0) return went_down(fmt::format("the pseudo-terminal {} failed: {}", slave_, error_text(error)));
    // The program has closed its side. What it did not read and what it changed must not meet the next one.
    somebody_ = false;
    drop_partial();
    out_.stop();
    in_.stop();
    throw_away_unread(fd(), slave_);
    (void)make_raw(fd());
    watch_for_somebody();
}

void PtyLine::flush() {
    if (somebody_) return StreamLine::flush();
    const Instant now = clock().now();
    while (state() == State::up && !queue_.empty()) {
        Frame f = queue_.front()->frame;
        f.at = now;
        queue_.pop();
        if (!tell_sent(f)) return;
    }
}

}  // namespace axisgate
