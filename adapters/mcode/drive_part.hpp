// What the parts of one MCode drive have in common: the line that they speak on, how their drive is spoken to, and what each may ask for.
// In: the site's numbers. Out: types alone; a part has a state of its own and reaches the others by its drive (drive.hpp).
// Never sends: a part answers with a Request when its drive has the line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "adapters/mcode/wire.hpp"
#include "adapters/mcode/wire_reply.hpp"
#include "gateway/drive/bus.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::mcode {
using drive::Turn;

/// What the drives of a line share: the site's numbers with this family's own defaults filled in, and what one must know of the others.
struct Bus : drive::Bus {
    using drive::Bus::Bus;
    int em = 1;                      ///< echo mode wanted
    int ck = 1;                      ///< checksum mode wanted
    bool only_reads = false;         ///< the link is used as it is, and ER, which reading clears, is left
    bool ethernet = false;           ///< MCode/TCP: no CK, no names [L1173-1191]
    bool reset_hits_others = false;  ///< another drive of this line has CE = 1: a CTRL+C for one restarts that too
    int rate_code = 0;               ///< BD of the line's rate; 0: not known, or none of BD's [L1585]
    Instant next_listing{};          ///< a listing keeps the line to itself, so there is one in a second at most
};

/// bit/s of a BD code, 0 if there is none [L1585-1590, E-1]; and the code of a rate.
[[nodiscard]] std::uint32_t rate_of(int code) noexcept;
[[nodiscard]] int code_of(std::uint32_t rate) noexcept;

/// The words that set how a drive speaks, as it has them.
struct LinkWords {
    bool sums = false;        ///< requests carry a checksum
    bool known_sums = false;  ///< they did when it answered last
    int em = 1, ck = 0, es = 1, ce = 1;
};

/// What a drive wants to send.
struct Request {
    enum class Purpose : std::uint8_t { probe, link, startup, stop, confirm, error, step, poll, leave };
    Purpose purpose = Purpose::poll;
    std::string text;  ///< without address, checksum, terminator; query: without the mark
    std::string raw;   ///< bytes as they are, instead of text
    Expect::Kind kind = Expect::Kind::query;
    bool end_mark = false;
    bool ends = false;  ///< block: its end is proven by a question behind it
    bool urgent = false;
    bool wake = false;         ///< a LF goes before: wakes a party line, ends half a line [L5002]
    Duration patience{};       ///< beyond the reply time-out
    Ticket order = no_ticket;  ///< the command for which it is sent

    [[nodiscard]] static Request ask(Purpose purpose, std::string items);
    /// A line that is acknowledged. Those that write flash memory get their time.
    [[nodiscard]] static Request say(Purpose purpose, std::string line);
};

inline constexpr std::string_view escape_key = "ESC";    ///< of a stop: the character, not a line
inline constexpr std::string_view reset_key = "CTRL+C";  ///< of a step: the character, not a line

/// The figure that `text` is; a fraction is rounded.
[[nodiscard]] std::optional<std::int64_t> whole(std::string_view text);
[[nodiscard]] std::vector<std::string_view> split(std::string_view data);

class Drive;
class Feedback;
class Part : public drive::Part<Drive> {
public:
    explicit Part(Drive& drive) noexcept : drive::Part<Drive>(drive) {}

protected:
    ~Part() = default;
    [[nodiscard]] const std::string& name() const noexcept;  ///< of the drive
    [[nodiscard]] Feedback& feedback() const noexcept;
    void note(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t) const;
};

}  // namespace axisgate::mcode
