// Serial port: the system calls that make a terminal device a plain, exclusive, fast byte pipe, and what the driver granted of it.
// In: a path and settings. Out: an open, non-blocking descriptor and a sentence, or a fault with a remedy.
// Never waits for a carrier and never becomes the process's controlling terminal.
#pragma once

#include <cstddef>
#include <string>

#include "gateway/core/line_uri.hpp"

namespace axisgate {

struct SerialOpened {
    int fd = -1;        ///< belongs to the caller; -1: see `fault`
    std::string text;   ///< what was granted: "9600 bit/s 7E1, RS-485 by the driver (1 ms before, 0 ms after)"
    std::string fault;  ///< why not, and what to do
};

/// Raw mode, any bit rate, exclusive, local (no modem control), stale input and output thrown away, low latency where the driver can.
[[nodiscard]] SerialOpened open_serial(const std::string& path, const SerialSettings& settings);

/// Bytes that were written but are still waiting in the driver; 0 where it cannot tell.
[[nodiscard]] std::size_t serial_unsent(int fd) noexcept;

}  // namespace axisgate
