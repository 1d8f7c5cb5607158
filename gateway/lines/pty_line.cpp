// PtyLine: a pseudo-terminal that another program opens as if it were the drive's serial port.
// The line does not go down when that program closes the port: the next program finds the same name.
#include "gateway/lines/pty_line.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/lines/error_text.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>

namespace axisgate {
namespace {

/// How often the line checks whether a program has opened the port: the first bytes of a program wait at most this long.
constexpr auto look_every = std::chrono::milliseconds(10);

/// On Linux the settings of the master are those of the slave. Every program starts in raw mode, whatever settings the last one left.
bool make_raw(int master) noexcept {
    termios t{};
    if (::tcgetattr(master, &t) != 0) return false;
    ::cfmakeraw(&t);
    t.c_cflag |= CLOCAL | CREAD;
    return ::tcsetattr(master, TCSANOW, &t) == 0;
}

/// Whether a program has the port open, or has just closed it and left bytes to read.
bool is_worth_reading(int master) noexcept {
    pollfd p{master, POLLIN, 0};
    return ::poll(&p, 1, 0) >= 0 && ((p.revents & POLLHUP) == 0 || (p.revents & POLLIN) != 0);
}

/// Bytes that a program left unread are partly in transit and partly in the buffer of its terminal, which only the slave side can empty.
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

/// Whether a link target is the name of a pseudo-terminal, also of one that has gone with its program.
bool names_a_pty(std::string_view target) noexcept {
    constexpr std::string_view folder = "/dev/pts/";
    if (!target.starts_with(folder) || target.size() == folder.size()) return false;
    target.remove_prefix(folder.size());
    return std::all_of(target.begin(), target.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The path with links, "." and ".." resolved; empty if it does not exist.
std::string real_path(const std::string& path) {
    std::array<char, PATH_MAX> buffer{};
    return ::realpath(path.c_str(), buffer.data()) ? std::string(buffer.data()) : std::string();
}

bool lies_in(const std::string& path, const std::string& folder) {
    return !folder.empty() && (path == folder || folder == "/" || (path.starts_with(folder) && path[folder.size()] == '/'));
}

/// The reason why the link must not be created there; empty if it may.
std::string forbidden(const std::string& path, const PtyPlaces& places) {
    const auto slash = path.rfind('/');
    const std::string parent = slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
    const std::string folder = real_path(parent);
    if (folder.empty()) return {};  // creating the link fails there and reports the reason
    if (!places.never_in.empty() && lies_in(folder, real_path(places.never_in)))
        return fmt::format("{} is in the gateway's data directory: choose another folder", path);
    if (places.only_below.empty()) return {};
    const std::string allowed = real_path(places.only_below);
    if (allowed.empty())
        return fmt::format("{} cannot be made: the folder {} ([lines] pty_dir) is not there; make it, or name another", path,
                           places.only_below);
    if (lies_in(folder, allowed)) return {};
    return fmt::format("{} is not below {}: pseudo-terminals are linked there alone ([lines] pty_dir of the host's configuration)", path,
                       places.only_below);
}

/// Creates the link; an existing link to a pseudo-terminal counts as left over and is replaced. Returns the error, or an empty text.
std::string put_link(const std::string& target, const std::string& path, const PtyPlaces& places) {
    if (std::string wrong = forbidden(path, places); !wrong.empty()) return wrong;
    struct stat there {};
    if (::lstat(path.c_str(), &there) == 0) {
        if (!S_ISLNK(there.st_mode)) return fmt::format("{} exists and is not a link: choose another path, or remove it", path);
        if (!names_a_pty(target_of(path)))
            return fmt::format("{} is a link to something else than a pseudo-terminal: choose another path, or remove it", path);
        if (::unlink(path.c_str()) != 0) return fmt::format("cannot remove the old link {}: {}", path, error_text(errno));
    }
    if (::symlink(target.c_str(), path.c_str()) != 0) {
        return fmt::format("cannot make the link {}: {}: does its folder exist, and may this user write there?", path, error_text(errno));
    }
    return {};
}

}  // namespace

PtyLine::PtyLine(const LineBase& base, std::string path, std::uint32_t pace_baud, const SerialFormat& pace_format, PtyPlaces places)
    : StreamLine(base),
      path_(std::move(path)),
      places_(std::move(places)),
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
    // After the slave has been opened and closed once, the master reports a hang-up from the beginning, as it does later without a program.
    if (const int slave = ::open(name.data(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC); slave >= 0) ::close(slave);
    if (std::string wrong = put_link(name.data(), path_, places_); !wrong.empty()) {
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
    // The program has closed the port. Bytes that it did not read and settings that it changed must not reach the next program.
    somebody_ = false;
    drop_partial();
    out_.stop();
    in_.stop();
    throw_away_unread(fd(), slave_);
    (void)make_raw(fd());
    watch_for_somebody();
}

/// Bytes that arrived before they were due count as having crossed at the pace of the line, however late this process reads them; if a
/// program writes more slowly than the pace, its last byte counts as written now.
void PtyLine::got(std::size_t bytes, bool more) {
    const Instant now = clock().now();
    in_handed_ = in_crossed_;
    in_.pass(bytes, more, now);
    in_crossed_ = std::max(in_handed_, more ? in_.crossed(now) : now);
}

Instant PtyLine::crossed(std::size_t before_the_last) const {
    return std::max(in_handed_, in_crossed_ - in_.byte_time() * static_cast<std::int64_t>(before_the_last));
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
