// Polls: what is asked of a drive that is ready and has nothing else to do: MS[0], MS[1] behind it, ER[0], and the rest of the start's
// list. In: the passing of time, a place on the line. Out: the next read. Never lets the list, or commands on a slow line, keep the picture
// from being read.
#pragma once

#include "adapters/uim342/drive_part.hpp"
#include "gateway/drive/polls.hpp"

namespace axisgate::uim342 {

class Polls : public Part {
public:
    using Part::Part;

    void begin(Instant now) noexcept;
    void stop() noexcept;
    /// MS[0] as soon as possible.
    void soon(Instant now) noexcept { timer_.soon(now), speed_next_ = false; }
    /// The same behind an MS[1] that is next: an input that chatters must not keep the position from being read.
    void again(Instant now) noexcept { timer_.soon(now); }
    /// Who looks closely wants other periods.
    void look(const DriveSetup& setup) noexcept {
        if (pace_.take(setup)) timer_.hurry();
    }
    void speed_next() noexcept { speed_next_ = true; }
    void command_began() noexcept { command_last_ = true; }
    /// A whole period late, and a command has begun since the last one.
    [[nodiscard]] bool overdue(Instant now) const noexcept;
    [[nodiscard]] bool wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return timer_.deadline(); }
    void go(Turn& t);

private:
    drive::PollTimer timer_;
    drive::Pace pace_;
    bool speed_next_ = false;    ///< next is MS[1]
    bool command_last_ = false;  ///< a command has begun since the last poll
    bool list_turn_ = false;     ///< next is a value of the list, though a poll is due
};

}  // namespace axisgate::uim342
