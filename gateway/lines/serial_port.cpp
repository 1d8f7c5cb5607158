// Serial port with any bit rate, through the kernel's own terminal structures: those of the C library know only the usual bit rates.
// The kernel's header cannot be included together with <termios.h>, because both define the same names differently. Hence this file.
#include "gateway/lines/serial_port.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "gateway/lines/error_text.hpp"

namespace axisgate {
namespace {

std::string open_fault(const std::string& path, int error) {
    const std::string what = fmt::format("cannot open {}: {}", path, error_text(error));
    switch (error) {
        case ENOENT:
        case ENODEV:
        case ENXIO:
            return what + ": is the adapter plugged in, and is this its name (see /dev/serial/by-id)?";
        case EACCES:
        case EPERM:
            return what + ": put the service's user into the group that owns it (dialout)";
        case EBUSY:
            return what + ": another program uses this port";
        default:
            return what;
    }
}

termios2 raw_settings(termios2 t, const SerialSettings& s) noexcept {
    // Bad bytes arrive marked (PARMRK) so that they can be counted; see parity_marks.hpp.
    t.c_iflag = INPCK | PARMRK;
    t.c_oflag = 0;
    t.c_lflag = 0;
    t.c_cflag = CREAD | CLOCAL | BOTHER | (s.format.data_bits == 7 ? CS7 : CS8);
    if (s.format.parity != Parity::none) t.c_cflag |= PARENB;
    if (s.format.parity == Parity::odd) t.c_cflag |= PARODD;
    if (s.format.stop_bits == 2) t.c_cflag |= CSTOPB;
    if (s.rtscts) t.c_cflag |= CRTSCTS;
    t.c_ispeed = s.baud;
    t.c_ospeed = s.baud;
    t.c_cc[VMIN] = 0;
    t.c_cc[VTIME] = 0;
    return t;
}

/// A receiver samples in the middle of the tenth bit: a rate that differs by more than this does not work.
bool near_enough(std::uint32_t asked, std::uint32_t granted) noexcept {
    const std::uint64_t off = granted > asked ? granted - asked : asked - granted;
    return off * 100 <= std::uint64_t{asked} * 3;
}

/// A pseudo-terminal has no wire: it accepts every format and reports 8N1.
bool is_pseudo_terminal(int fd) noexcept {
    struct stat what {};
    constexpr unsigned first_major = 136, last_major = 143;  // major numbers of /dev/pts
    return ::fstat(fd, &what) == 0 && major(what.st_rdev) >= first_major && major(what.st_rdev) <= last_major;
}

/// Returns the error, or an empty text.
std::string set_up(int fd, const SerialSettings& s, std::string& granted) {
    termios2 t{};
    if (::ioctl(fd, TCGETS2, &t) != 0) return fmt::format("is not a serial port: {}", error_text(errno));
    t = raw_settings(t, s);
    if (::ioctl(fd, TCSETS2, &t) != 0) return fmt::format("does not take {} bit/s {}: {}", s.baud, to_text(s.format), error_text(errno));
    termios2 now{};
    if (::ioctl(fd, TCGETS2, &now) != 0) return fmt::format("does not tell its settings: {}", error_text(errno));
    if (!near_enough(s.baud, now.c_ospeed))
        return fmt::format("cannot do {} bit/s (it would do {}): use another bit rate", s.baud, now.c_ospeed);
    constexpr unsigned format_bits = CSIZE | PARENB | PARODD | CSTOPB;
    if ((now.c_cflag & format_bits) != (t.c_cflag & format_bits) && !is_pseudo_terminal(fd))
        return fmt::format("cannot do the format {}: use 8N1", to_text(s.format));
    granted = fmt::format("{} bit/s {}", now.c_ospeed, to_text(s.format));
    if (s.rtscts) granted += ", RTS/CTS";
    return {};
}

/// RS-485 switched by the driver. Returns the error, or an empty text. Drivers may shorten the delays, so the granted ones are read back.
std::string set_rs485(int fd, const SerialSettings& s, std::string& granted) {
    if (s.rs485 == Rs485::off) return {};
    serial_rs485 wanted{};
    wanted.flags = SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND;
    wanted.delay_rts_before_send = s.rts_before_ms;
    wanted.delay_rts_after_send = s.rts_after_ms;
    serial_rs485 got{};
    const bool set = ::ioctl(fd, TIOCSRS485, &wanted) == 0;
    const int error = errno;
    if (!set || ::ioctl(fd, TIOCGRS485, &got) != 0 || (got.flags & SER_RS485_ENABLED) == 0) {
        if (s.rs485 == Rs485::automatic) {
            granted += ", RS-485 left to the converter (the driver cannot turn the direction)";
            return {};
        }
        return fmt::format(
            "cannot turn the direction of RS-485 ({}): with a converter that turns round by itself use rs485=auto or rs485=0",
            set ? std::string("the driver ignores it") : error_text(error));
    }
    granted += fmt::format(", RS-485 by the driver ({} ms before, {} ms after)", got.delay_rts_before_send, got.delay_rts_after_send);
    return {};
}

/// Asks the driver to pass on each byte at once instead of collecting for up to 16 ms. If it cannot, nothing is lost.
void ask_for_low_latency(int fd) noexcept {
    serial_struct s{};
    if (::ioctl(fd, TIOCGSERIAL, &s) != 0) return;
    s.flags |= ASYNC_LOW_LATENCY;
    (void)::ioctl(fd, TIOCSSERIAL, &s);
}

}  // namespace

SerialOpened open_serial(const std::string& path, const SerialSettings& settings) {
    SerialOpened r;
    const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        r.fault = open_fault(path, errno);
        return r;
    }
    struct stat what {};
    if (::fstat(fd, &what) != 0 || !S_ISCHR(what.st_mode)) {
        r.fault = fmt::format("{} is not a serial port but a file: check the path", path);
    } else if (::flock(fd, LOCK_EX | LOCK_NB) != 0 || ::ioctl(fd, TIOCEXCL) != 0) {
        // TIOCEXCL keeps later openers out, but neither root nor programs that had the port open before; the lock is for programs that
        // check it.
        r.fault = errno == ENOTTY ? fmt::format("{} is not a serial port", path) : open_fault(path, EBUSY);
    } else if (std::string wrong = set_up(fd, settings, r.text); !wrong.empty()) {
        r.fault = fmt::format("{} {}", path, wrong);
    } else if (wrong = set_rs485(fd, settings, r.text); !wrong.empty()) {
        r.fault = fmt::format("{} {}", path, wrong);
    }
    if (!r.fault.empty()) {
        ::close(fd);
        return r;
    }
    ask_for_low_latency(fd);
    (void)::ioctl(fd, TCFLSH, TCIOFLUSH);
    r.fd = fd;
    return r;
}

std::size_t serial_unsent(int fd) noexcept {
    int n = 0;
    return ::ioctl(fd, TIOCOUTQ, &n) == 0 && n > 0 ? static_cast<std::size_t>(n) : 0;
}

}  // namespace axisgate
