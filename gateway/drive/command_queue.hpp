// CommandQueue holds the commands that wait for one axis, in order. StopLane holds the stops, which wait for a free place on the line only.
// Both are bounded: a command that finds the queue full is refused as busy; if the lane is full, the family sends the stop without waiting
// for its answer. Neither of them sends; results are given by Tickets.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/drive/presence.hpp"
#include "gateway/drive/tickets.hpp"
#include "gateway/drive/turn.hpp"

namespace axisgate::drive {

/// True for Move, Home and StartTogether, which every stop ends, whether they wait or are in progress. Other commands that move an axis are
/// known to the family only.
[[nodiscard]] bool is_motion(const CommandBody& body) noexcept;
/// True if `stop` (Halt, QuickStop, Disable) ends the command `body`: motions, and after a stop that switches the power off also commands
/// that would switch it on again.
[[nodiscard]] bool ended_by(const CommandBody& stop, const CommandBody& body) noexcept;

class CommandQueue {
public:
    explicit CommandQueue(std::size_t limit = 64) noexcept : limit_(limit) {}

    [[nodiscard]] bool push(Command command);  ///< false: the queue is full
    [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
    [[nodiscard]] std::size_t size() const noexcept { return waiting_.size(); }
    [[nodiscard]] std::size_t limit() const noexcept { return limit_; }
    [[nodiscard]] const Command& front() const noexcept { return waiting_.front(); }
    [[nodiscard]] Command pop();
    /// True if a command of this kind waits for the axis.
    template <class Body>
    [[nodiscard]] bool holds(AxisId axis) const noexcept {
        for (const Command& c : waiting_)
            if (c.axis == axis && std::holds_alternative<Body>(c.body)) return true;
        return false;
    }
    /// Removes all commands. Tickets::fail_all answers them.
    void clear() noexcept { waiting_.clear(); }

    /// Answers each command for which `ends(command)` is true as failed (interrupted) with the text "interrupted by halt", and removes it.
    /// Returns their number.
    template <class Ends>
    std::size_t interrupt(Ends&& ends, std::string_view by, Tickets& tickets, Turn& t) {
        std::size_t n = 0;
        for (auto it = waiting_.begin(); it != waiting_.end();) {
            if (!ends(*it)) {
                ++it;
                continue;
            }
            tickets.failed(it->ticket, Reason::interrupted, interrupted_by(by), t.out);
            it = waiting_.erase(it);
            ++n;
        }
        return n;
    }
    [[nodiscard]] static std::string interrupted_by(std::string_view by) { return "interrupted by " + std::string(by); }

private:
    std::size_t limit_;
    std::deque<Command> waiting_;
};

enum class Admission : std::uint8_t {
    queued,   ///< the command waits in the queue; its ticket is open
    urgent,   ///< the command is a stop; its ticket is open, and the caller carries it out
    answered  ///< the command was refused: line down, drive offline, or queue full
};
/// The first checks that every family applies to a command. `name` is used in messages ("feeder (ID 5)"). A stop is refused only while the
/// line is down, because a drive that does not answer may still receive it.
[[nodiscard]] Admission admit(const Command& command, std::string_view name, const Presence& presence, CommandQueue& queue,
                              Tickets& tickets, Turn& t);

/// Refuses a motion that arrives while a quick stop or a power-off of its axis is being sent, because it would cancel the stop in drives
/// that do not have a state "quick stop active". The motion is accepted if an Enable waits before it. `stop` is the stop that is being
/// sent, nullptr if there is none. Returns true if the motion was answered (refused, interrupted).
bool refused_behind(const CommandBody* stop, const Command& command, const CommandQueue& queue, Turn& t);

/// The stops that are being carried out, in order of arrival. A stop keeps its address until it is removed. `Stop` is a type of the family.
template <class Stop, std::size_t limit>
class StopLane {
public:
    /// Returns the stored stop; nullptr if `limit` stops are stored already.
    Stop* add(Stop stop) {
        for (std::size_t i = 0; i < limit; ++i) {
            if (taken_[i]) continue;
            taken_[i] = true;
            stops_[i] = std::move(stop);
            order_[size_++] = i;
            return &stops_[i];
        }
        return nullptr;
    }
    /// Removes the stop. The object remains valid until the next `add`.
    void remove(Stop* stop) {
        const auto place = static_cast<std::size_t>(stop - stops_.data());
        if (!taken_[place]) return;
        taken_[place] = false;
        std::size_t at = 0;
        while (order_[at] != place)
            ++at;
        for (--size_; at < size_; ++at)
            order_[at] = order_[at + 1];
    }
    void clear() noexcept {
        taken_ = {};
        size_ = 0;
    }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] Stop* first() noexcept { return size_ == 0 ? nullptr : &stops_[order_[0]]; }
    [[nodiscard]] const Stop* first() const noexcept { return size_ == 0 ? nullptr : &stops_[order_[0]]; }
    /// Calls `f` in order of arrival. `f` may remove the stop that it is called with.
    template <class F>
    void each(F&& f) {
        const auto order = order_;
        for (std::size_t i = 0, n = size_; i < n; ++i) {
            if (taken_[order[i]]) f(stops_[order[i]]);
        }
    }
    template <class F>
    void each(F&& f) const {
        for (std::size_t i = 0; i < size_; ++i)
            f(stops_[order_[i]]);
    }

private:
    std::array<Stop, limit> stops_{};
    std::array<bool, limit> taken_{};
    std::array<std::size_t, limit> order_{};
    std::size_t size_ = 0;
};

}  // namespace axisgate::drive
