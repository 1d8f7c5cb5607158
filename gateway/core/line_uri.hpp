// The text that says where a line is: `can:can0`, `dds`, `serial:/dev/ttyUSB0?baud=9600&format=7N1&rs485=1`, `tcp:HOST:PORT`, ... It is
// checked without opening or resolving anything, so the URI of a missing device is correct. A fault is one sentence that includes a correct
// example.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

enum class Parity : std::uint8_t { none, even, odd };

/// Data bits, parity and stop bits: "8N1", "7E1".
struct SerialFormat {
    std::uint8_t data_bits = 8;  ///< 7 or 8
    Parity parity = Parity::none;
    std::uint8_t stop_bits = 1;  ///< 1 or 2

    /// Bits of one byte on the wire: start, data, parity and stop bits (8N1: 10).
    [[nodiscard]] constexpr std::uint8_t bits_per_byte() const noexcept {
        return static_cast<std::uint8_t>(1 + data_bits + (parity == Parity::none ? 0 : 1) + stop_bits);
    }
    bool operator==(const SerialFormat&) const = default;
};
/// "7E1" and the like, in either case; empty for anything else.
[[nodiscard]] std::optional<SerialFormat> parse_serial_format(std::string_view text) noexcept;
[[nodiscard]] std::string to_text(const SerialFormat& format);

/// How the direction of a two-wire RS-485 port is switched.
enum class Rs485 : std::uint8_t {
    off,       ///< RS-232 or RS-422, or a converter that switches by itself
    on,        ///< the driver must do it (TIOCSRS485); a port that cannot is a fault
    automatic  ///< the driver if it can, otherwise the converter ("rs485=auto")
};

struct SerialSettings {
    std::uint32_t baud = 9600;  ///< bit/s, min_baud..max_baud; any value, not only the usual ones; pty: 0 means no timing
    SerialFormat format;
    Rs485 rs485 = Rs485::off;
    std::uint8_t rts_before_ms = 0;  ///< RS-485: driver on before the first bit, 0..max_rts_ms
    std::uint8_t rts_after_ms = 0;   ///< RS-485: driver held after the last bit, 0..max_rts_ms
    bool rtscts = false;             ///< hardware flow control; not together with RS-485, which uses RTS
    bool operator==(const SerialSettings&) const = default;

    static constexpr std::uint32_t min_baud = 50;
    static constexpr std::uint32_t max_baud = 12'000'000;
    static constexpr std::uint8_t max_rts_ms = 100;  ///< Linux limits longer ones
};

struct LineUri {
    enum class Kind : std::uint8_t { can, serial, tcp, tcp_listen, udp, udp_listen, pty, twin, dds };
    Kind kind = Kind::twin;
    std::string interface;   ///< can: 1..15 characters, a network interface's name
    std::string path;        ///< serial, pty
    std::string host;        ///< tcp, udp and their listening kinds: name or address, without brackets
    std::uint16_t port = 0;  ///< 1..65535; listening: 0 lets the system choose
    SerialSettings serial;   ///< serial; pty: baud and format, from which its timing follows
    bool operator==(const LineUri&) const = default;
};

struct LineUriResult {
    LineUri uri;
    std::string fault;  ///< empty if the URI is correct
    [[nodiscard]] bool good() const noexcept { return fault.empty(); }
};

/// Reads a line URI. `default_baud` and `default_format` apply to a serial line whose URI has none (Family::default_bit_rate,
/// Family::default_format); the format also to a pseudo-terminal with a timing. Unknown and repeated options are faults, and so is a text
/// of more than 1024 characters.
[[nodiscard]] LineUriResult parse_line_uri(std::string_view text, std::uint32_t default_baud = 9600,
                                           std::string_view default_format = "8N1");

/// The URI as text, always with baud and format (of a pseudo-terminal, if it has a timing): parse_line_uri(to_text(u)).uri == u.
[[nodiscard]] std::string to_text(const LineUri& uri);

}  // namespace axisgate
