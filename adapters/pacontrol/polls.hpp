// Polls: what is read again and again, in which order.
// In: what is known of the axes, turns on the line. Out: the next poll.
// Never asks for what the control has said it does not have, and holds each poll once besides a cycle's.
#pragma once

#include <deque>

#include "adapters/pacontrol/drive_port.hpp"

namespace axisgate::pacontrol {

/// Cycles and not the kit's periods: a following error and the position that it belongs to are asked one behind the other, and how many
/// axes that stand are asked in a cycle depends on how long the one before took.
class Polls : public Part {
public:
    using Part::Part;

    [[nodiscard]] bool wanted(Instant now) const noexcept { return !waiting_.empty() || cycle_at_ <= now; }
    [[nodiscard]] Instant deadline() const noexcept { return cycle_at_; }
    /// What to ask now, and as which request.
    [[nodiscard]] Sent next(Instant now);

    /// Before the cycle's other polls. What waits already moves to the front.
    void soon(std::uint16_t code, const Axis& a);
    /// Of an axis that has come to rest: what it is behind, where it is, and how.
    void soon_standing(const Axis& a);
    /// Not asked any more in this cycle; of all axes without `a`.
    void drop(std::uint16_t code, const Axis* a = nullptr);
    /// While an axis is looked at closely one cycle follows the other.
    void look(const DriveSetup& setup) noexcept {
        if (pace_.take(setup)) cycle_at_ = Instant{};
    }
    void hurry(Instant now) noexcept { cycle_at_ = std::min(cycle_at_, now); }
    /// Everything of every axis is read in the next cycle.
    void start_over() noexcept { first_cycle_ = true; }
    void clear() noexcept { waiting_.clear(); }

private:
    void plan_cycle(Instant now);
    void plan_standing(bool crowded);
    void plan_slow(Instant now);
    void plan_parameters(Instant now);
    void add(std::uint16_t code, const Axis& a, std::uint8_t parameter = 0) { waiting_.push_back({code, a.place(), parameter}); }

    drive::Pace pace_;
    std::deque<Poll> waiting_;
    bool first_cycle_ = true;
    Instant cycle_at_{}, cycle_began_{};
    Duration cycle_time_{};  ///< of the cycle before
    std::size_t slow_at_ = 0, idle_at_ = 0;
};

}  // namespace axisgate::pacontrol
