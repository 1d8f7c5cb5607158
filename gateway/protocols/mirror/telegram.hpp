// Telegrams of a mirror line: how an axis of another gateway is asked and told of between the hot loop and the DDS door, one line of text
// each: a mark, a number, GATEWAY/AXIS, what is said, a check. In: values. Out: text and back; nothing of a line whose form or check is
// wrong. Never longer than `longest`; a request fits one frame, so that a stop is never sent into the middle of another one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/command.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate::mirror {

inline constexpr std::size_t longest = 1024;  ///< bytes of a line with its end; what goes on without an end is dropped

struct Telegram {
    enum class Kind : char {
        request = '?',
        answer = '!',  ///< to a request that is no question for the state
        state = '=',
        gone = '-'  ///< in place of a state: why there is none
    };
    Kind kind = Kind::request;
    std::uint64_t number = 0;  ///< of the request, and of what answers it; 0: nobody had asked
    std::string address;       ///< GATEWAY/AXIS
    std::string body;
    [[nodiscard]] bool operator==(const Telegram&) const = default;
};
/// With its end ("\n"). Control characters of the body become spaces, what is too long is cut.
[[nodiscard]] std::string text_of(const Telegram& telegram);
/// Of a line without its end.
[[nodiscard]] std::optional<Telegram> telegram_of(std::string_view line);

/// "GATEWAY/AXIS": two names of 1 to 63 printable characters without spaces. Empty if it is, else what would be right.
[[nodiscard]] std::string check_address(std::string_view address);

/// What a request asks for; positions in increments, speeds in increments/s.
struct Order {
    std::string verb{};  ///< state; read; a command as name_of(CommandBody) calls it
    std::string name{};  ///< read: of the parameter
    std::optional<std::int64_t> position{}, velocity{}, acceleration{}, deceleration{}, method{};
    std::optional<std::int64_t> hold_ms{};  ///< move_velocity: the axis is halted without a renewal for so long, 100..10000
    bool renew = false;                     ///< move_velocity: that renewal, never a motion of its own
    std::int64_t wait_ms = 0;               ///< the result is waited for so long and no longer; 0: as long as the other end likes
    [[nodiscard]] bool operator==(const Order&) const = default;
};
[[nodiscard]] std::string body_of(const Order& order);
[[nodiscard]] std::optional<Order> order_of(std::string_view body);

/// The one result of a request; `text` of a read is the value.
struct Answer {
    Outcome outcome = Outcome::failed;
    Reason reason = Reason::none;
    std::int32_t code = 0;
    std::string text;
    [[nodiscard]] bool operator==(const Answer&) const = default;
};
[[nodiscard]] std::string body_of(const Answer& answer);
[[nodiscard]] std::optional<Answer> answer_of(std::string_view body);

/// An axis as its gateway tells it.
struct State {
    bool simulated = false, stale = false, referenced = false, moving = false, target_reached = false, fault = false, warning = false;
    std::uint16_t statusword = 0;  ///< CiA 402 6041h
    std::int16_t mode = 0;         ///< CiA 402 6061h
    std::int64_t position = 0;     ///< increments
    std::int64_t demand = 0;
    DemandSource demand_source = DemandSource::none;
    std::int64_t velocity = 0;     ///< increments/s
    std::uint16_t error_code = 0;  ///< the drive's own
    std::int64_t age_ms = 0;       ///< since the drive said it
    [[nodiscard]] bool operator==(const State&) const = default;
};
[[nodiscard]] std::string body_of(const State& state);
[[nodiscard]] std::optional<State> state_of(std::string_view body);

/// Bytes to lines.
class Framer {
public:
    template <class F>
    void push(std::string_view bytes, F&& line) {
        for (const char c : bytes) {
            if (c == '\n') {
                if (!over_) line(std::string_view(line_));
                line_.clear();
                over_ = false;
            } else if (line_.size() < longest) {
                line_ += c;
            } else {
                over_ = true;
            }
        }
    }
    /// Of a line that has begun and not ended: nothing of it is kept.
    void clear() {
        line_.clear();
        over_ = false;
    }

private:
    std::string line_;
    bool over_ = false;
};

}  // namespace axisgate::mirror
