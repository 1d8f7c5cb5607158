// SerialLine: opens a serial port and reads it whenever it is ready.
// It keeps trying after a fault: an adapter that is pulled out and plugged in again is found under its path.
#include "gateway/lines/serial_line.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/wire_time.hpp"
#include "gateway/lines/error_text.hpp"
#include "gateway/lines/serial_port.hpp"

namespace axisgate {
namespace {

/// The driver is given at most the bytes of this duration, and never less than a short frame.
constexpr Duration most_ahead = std::chrono::milliseconds(20);
constexpr std::size_t least_ahead = 64;

}  // namespace

SerialLine::SerialLine(const LineBase& base, std::string path, const SerialSettings& settings)
    : StreamLine(base), path_(std::move(path)), settings_(settings), byte_time_(wire_time(settings.format.bits_per_byte(), settings.baud)) {
    most_unsent_ = std::max<std::size_t>(least_ahead, static_cast<std::size_t>(most_ahead / byte_time_));
    set_byte_time(byte_time_);
    one_wire_ = settings.rs485 != Rs485::off;
}

void SerialLine::start() {
    marks_.reset();
    SerialOpened port = open_serial(path_, settings_);
    if (port.fd < 0) return went_down(std::move(port.fault));
    std::string why;
    if (!attach(port.fd, false, why)) return went_down(fmt::format("cannot use {}: {}", path_, why));
    if (came_up(fmt::format("up on {} at {}", path_, port.text))) begin_reading();
}

std::size_t SerialLine::filter(std::span<std::uint8_t> data) {
    const std::uint64_t before = marks_.bad();
    const std::size_t kept = marks_.take_out(data);
    status_.errors += marks_.bad() - before;
    return kept;
}

std::size_t SerialLine::room_to_write() {
    const std::size_t unsent = serial_unsent(fd());
    return unsent >= most_unsent_ ? 0 : most_unsent_ - unsent;
}

/// The time until about half of the bytes in the driver have been sent.
Duration SerialLine::pause_before_write() const {
    return std::max<Duration>(std::chrono::milliseconds(1), byte_time_ * static_cast<std::int64_t>(most_unsent_ / 2));
}

void SerialLine::on_gone(int error) {
    went_down(fmt::format("{} is gone: {}", path_, error == 0 ? std::string("hung up, or pulled out") : error_text(error)));
}

}  // namespace axisgate
