// CommandQueue and StopLane: what waits for one axis, in order; and the stops, which wait for nothing but a place on the wire.
// In: commands. Out: the next one; those that a stop ends. Bounded: what finds the queue full is refused as busy, a stop that finds its
// lane full is its family's to send unwatched. Neither of them sends, and both leave results to Tickets.
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

/// Move, Home or StartTogether: what every stop ends, whether it waits or runs. What other commands move is the family's to know.
[[nodiscard]] bool is_motion(const CommandBody& body) noexcept;
/// What a stop (Halt, QuickStop, Disable) ends: motions; with the power off what would bring that back, too.
[[nodiscard]] bool ended_by(const CommandBody& stop, const CommandBody& body) noexcept;

class CommandQueue {
public:
    explicit CommandQueue(std::size_t limit = 64) noexcept : limit_(limit) {}

    [[nodiscard]] bool push(Command command);  ///< false: full
    [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
    [[nodiscard]] std::size_t size() const noexcept { return waiting_.size(); }
    [[nodiscard]] std::size_t limit() const noexcept { return limit_; }
    [[nodiscard]] const Command& front() const noexcept { return waiting_.front(); }
    [[nodiscard]] Command pop();
    /// One that waits is of this kind and axis.
    template <class Body>
    [[nodiscard]] bool holds(AxisId axis) const noexcept {
        for (const Command& c : waiting_)
            if (c.axis == axis && std::holds_alternative<Body>(c.body)) return true;
        return false;
    }
    /// Forgets them; their tickets are answered by Tickets::fail_all.
    void clear() noexcept { waiting_.clear(); }

    /// Ends what `ends(command)` names as failed and interrupted, with "interrupted by halt". Returns how many.
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
    queued,   ///< it waits in the queue, its ticket is open
    urgent,   ///< a stop: its ticket is open, and it is the caller's
    answered  ///< refused: the line is down, the drive does not answer, too many wait
};
/// What every family does with a command first. `name`: for messages ("feeder (ID 5)"). A stop is refused only while the line is down: a
/// drive that does not answer may still hear.
[[nodiscard]] Admission admit(const Command& command, std::string_view name, const Presence& presence, CommandQueue& queue,
                              Tickets& tickets, Turn& t);

/// A motion that was ordered while a quick stop or a power-off of its axis is on its way would undo it where the drive itself knows no
/// quick stop active: it is refused as interrupted, unless an Enable waits before it. `stop`: what is on its way; nullptr: nothing that
/// counts. True: it has been answered.
bool refused_behind(const CommandBody* stop, const Command& command, const CommandQueue& queue, Turn& t);

/// Stops on their way, in order of arrival, at places that stay while they are: `Stop` is the family's, and has what one needs of it.
template <class Stop, std::size_t limit>
class StopLane {
public:
    /// Its place; nullptr: `limit` are on their way already.
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
    /// Takes it out. It may be used until the next `add`.
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
    /// In order of arrival. `f` may take out the stop that it is called with.
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
