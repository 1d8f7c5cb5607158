// Comm: the drive's side of the serial link: lines out of bytes, echo, party address, checksum, control characters, shape of replies.
// In: bytes as they arrive. Out: commands and control events in order; echo bytes; replies in the shape of EM, PY and CK.
// Never executes a command and knows no time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "adapters/mcode/twin/manners.hpp"
#include "adapters/mcode/twin/token.hpp"

namespace axisgate::mcode::twin {

/// The flags of the link, as the words of the same names [L861-866, L2399, L2652-2683, L4991-5045].
struct LinkFlags {
    int em = 0;
    int ck = 0;
    int es = 1;
    int ce = 1;
    bool py = false;
    bool qd = false;
    bool dg = true;
    char dn = '!';
    bool operator==(const LinkFlags&) const = default;
};

/// Codes of BD.
inline constexpr std::array rate_codes{48, 96, 19, 38, 11};
/// bit/s; 0: no such code.
[[nodiscard]] std::uint32_t rate_of_code(int code) noexcept;

/// An answer in the order in which it leaves.
struct Reply {
    std::string head;    ///< the line given back with EM = 3, and the acknowledgement
    std::string data;    ///< with its checksum and line end
    std::string tail;    ///< an acknowledgement that stands behind the data
    std::string prompt;  ///< EM = 0
};

/// One complete command line.
struct Command {
    std::string text;     ///< without address, checksum and terminator
    LinkFlags flags;      ///< as they were when its last character came: the reply has their shape
    bool silent = false;  ///< a global command with DG = 1 [L2399]
    bool checksum_good = true;
    bool too_long = false;    ///< error 20; the CR LF for it is already out [L4897]
    std::string as_received;  ///< what EM = 3 sends back
};

struct LinkEvent {
    enum class Kind : std::uint8_t {
        none,
        command,
        stop,    ///< escape character of this ES
        reset,   ///< CTRL+C of this CE
        step,    ///< space, while a program is single-stepped
        run_on,  ///< enter, while a program is single-stepped
        overrun  ///< the 65th character
    };
    Kind kind = Kind::none;
};

class Comm {
public:
    LinkFlags flags;
    Manners manners;
    bool network = false;  ///< TCP or UDP: a bare LF ends a line as CR does, the LF of a CR LF nothing (E-6)

    /// As after power-up, or after PY = 1: in party mode nothing is obeyed until the first LF [L5002].
    void restart() noexcept;
    void disarm() noexcept { armed_ = false; }
    void stepping(bool on) noexcept { stepping_ = on; }

    /// Takes one byte. `echo` gets what goes back at once. A command is then taken with `take`.
    LinkEvent receive(std::uint8_t byte, std::string& echo);
    /// How many of `bytes` are plain text in a neighbour's line: they are taken at once, as if `receive` had had each of them.
    [[nodiscard]] std::size_t pass_over(std::span<const std::uint8_t> bytes);
    [[nodiscard]] Command take() { return std::move(command_); }

    /// ((-sum) & 7F) | 80 [L6867].
    [[nodiscard]] static char checksum(std::string_view text) noexcept;
    /// What follows the execution. `data`: what PR and L have given, without their last line end; `ended`: that line end is wanted.
    /// `good`: no error; `pending`: the prompt is `?`; `running`: a program runs (CK = 2 then answers errors only).
    [[nodiscard]] Reply reply(const Command& c, std::optional<std::string_view> data, bool ended, bool good, bool pending,
                              bool running) const;

private:
    void clear() noexcept;
    [[nodiscard]] bool addressed(char first) const noexcept;
    LinkEvent interrupt(std::uint8_t byte);
    LinkEvent append(char c, std::string& echo);
    LinkEvent finish(std::string& echo);
    /// Whether the line in hand is echoed.
    [[nodiscard]] bool echoes() const noexcept;

    std::string line_;    // bounded by the limit below
    bool armed_ = false;  // party mode: the first LF has come
    bool discarding_ = false;
    bool stepping_ = false;
    bool after_cr_ = false;  // network: the last byte was CR
    Command command_;
};

}  // namespace axisgate::mcode::twin
