// Telegrams of a mirror line: the text lines with which the hot loop and the DDS door exchange requests to and states of a remote axis.
// A line consists of a mark, a number, GATEWAY/AXIS, a body and a check; lines with a wrong form or check are ignored. None is longer than
// `longest`, and a request fits one frame, so that a stop is never sent into the middle of another request.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/command.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate::mirror {

inline constexpr std::size_t longest = 1024;  ///< bytes of a line with its end; longer input without a line end is dropped

struct Telegram {
    enum class Kind : char {
        request = '?',
        answer = '!',  ///< answer to a request, except a request for the state
        state = '=',
        gone = '-'  ///< sent instead of a state: the reason why there is none
    };
    Kind kind = Kind::request;
    std::uint64_t number = 0;  ///< number of a request and of its answer; 0: sent without a request
    std::string address;       ///< GATEWAY/AXIS
    std::string body;
    [[nodiscard]] bool operator==(const Telegram&) const = default;
};
/// With the line end ("\n"). Control characters of the body become spaces, and a long body is cut.
[[nodiscard]] std::string text_of(const Telegram& telegram);
/// Reads a line without its end.
[[nodiscard]] std::optional<Telegram> telegram_of(std::string_view line);

/// "GATEWAY/AXIS": two names of 1 to 63 printable characters without spaces. Returns an empty text if it is valid, else the correct form.
[[nodiscard]] std::string check_address(std::string_view address);

/// The content of a request; positions are in increments, speeds in increments/s.
struct Order {
    std::string verb{};  ///< state, read, or a command by its name from name_of(CommandBody)
    std::string name{};  ///< read: name of the parameter
    std::optional<std::int64_t> position{}, velocity{}, acceleration{}, deceleration{}, method{};
    std::optional<std::int64_t> hold_ms{};  ///< move_velocity: the axis is halted if it is not renewed for this long, 100..10000
    bool renew = false;                     ///< move_velocity: the request is such a renewal and never starts a motion
    std::int64_t wait_ms = 0;               ///< maximum time to wait for the result; 0: chosen by the other end
    [[nodiscard]] bool operator==(const Order&) const = default;
};
[[nodiscard]] std::string body_of(const Order& order);
[[nodiscard]] std::optional<Order> order_of(std::string_view body);

/// The result of a request; for a read, `text` is the value.
struct Answer {
    Outcome outcome = Outcome::failed;
    Reason reason = Reason::none;
    std::int32_t code = 0;
    std::string text;
    [[nodiscard]] bool operator==(const Answer&) const = default;
};
[[nodiscard]] std::string body_of(const Answer& answer);
[[nodiscard]] std::optional<Answer> answer_of(std::string_view body);

/// The state of an axis as reported by its gateway.
struct State {
    bool simulated = false, stale = false, referenced = false, moving = false, target_reached = false, fault = false, warning = false;
    std::uint16_t statusword = 0;  ///< CiA 402 6041h
    std::int16_t mode = 0;         ///< CiA 402 6061h
    std::int64_t position = 0;     ///< increments
    std::int64_t demand = 0;
    DemandSource demand_source = DemandSource::none;
    std::int64_t velocity = 0;     ///< increments/s
    std::uint16_t error_code = 0;  ///< error code of the drive
    std::int64_t age_ms = 0;       ///< time since the drive reported it
    [[nodiscard]] bool operator==(const State&) const = default;
};
[[nodiscard]] std::string body_of(const State& state);
[[nodiscard]] std::optional<State> state_of(std::string_view body);

/// Splits bytes into lines.
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
    /// Discards a line that has begun and not ended.
    void clear() {
        line_.clear();
        over_ = false;
    }

private:
    std::string line_;
    bool over_ = false;
};

}  // namespace axisgate::mirror
