// Serial port: the system calls that turn a terminal device into a plain, exclusive, fast byte stream.
// The result is an open, non-blocking descriptor with a text of the settings that the driver granted, or a fault text with a remedy.
// Opening does not wait for a carrier, and the port never becomes the controlling terminal of the process.
#pragma once

#include <cstddef>
#include <string>

#include "gateway/core/line_uri.hpp"

namespace axisgate {

struct SerialOpened {
    int fd = -1;        ///< owned by the caller; -1 on failure, then see `fault`
    std::string text;   ///< the granted settings: "9600 bit/s 7E1, RS-485 by the driver (1 ms before, 0 ms after)"
    std::string fault;  ///< why opening failed, and what the user can do about it
};

/// Raw mode, any bit rate, exclusive, local (no modem control), old input and output discarded, low latency if the driver supports it.
[[nodiscard]] SerialOpened open_serial(const std::string& path, const SerialSettings& settings);

/// The number of bytes that were written but are still in the driver; 0 if the driver cannot report it.
[[nodiscard]] std::size_t serial_unsent(int fd) noexcept;

}  // namespace axisgate
