// The command whose end of processing is outstanding, and the last acknowledgement, which is repeated after it (E-16).
// In: what a command waits for, polls, time. Out: acknowledgements. Never executes a command.
#pragma once

#include "adapters/pacontrol/twin/operation.hpp"

namespace axisgate::pacontrol::twin {

/// Acknowledgement of a command without its transport: QUIT / KF, BE / BF, data.
struct CommandReply {
    std::uint16_t quit = 0;
    bool done = true;
    Datum data;
    /// Not done: when it is expected to be, if it is a matter of the mode machine's own times; `never` otherwise.
    Instant expected = never;
    bool unanswered = false;  ///< the control says nothing at all
};

class CommandInProgress {
public:
    /// What has to come to its end: a move, a reference run, the standstill of an axis, its being switched on, a change of the mode.
    enum class Awaits : std::uint8_t { none, move, reference, halt, power, mode };
    struct Job {
        Awaits awaits = Awaits::none;
        int axis = 0;
    };

    CommandInProgress(const Axes& axes, const Operation& operation) : axes_(axes), operation_(operation) {}

    /// While it runs nothing but polls, 0600, 0603, 0A81 and 0A93 is taken (E-69).
    [[nodiscard]] bool exclusive() const noexcept { return exclusive(job_); }
    /// An end of processing has not been told yet.
    [[nodiscard]] bool pending() const noexcept { return job_.awaits != Awaits::none; }
    /// From now on this one is it; its acknowledgement at once.
    CommandReply begin(const Job& job, Instant now);
    /// The acknowledgement as it is now: live position while it runs, after that the last one.
    CommandReply reply(Instant now);
    /// An acknowledgement that nothing is outstanding of: the last one, unless a command is in progress.
    void note(const CommandReply& reply) noexcept;

    /// Takes it away for one that comes in its place; `take_up` brings it back if that one is refused.
    [[nodiscard]] Job set_aside() noexcept { return std::exchange(job_, {}); }
    void take_up(const Job& job) noexcept;
    /// Power on.
    void forget() noexcept;

private:
    static bool exclusive(const Job& job) noexcept { return job.awaits == Awaits::move || job.awaits == Awaits::reference; }

    const Axes& axes_;
    const Operation& operation_;
    Job job_;
    CommandReply last_;
};

}  // namespace axisgate::pacontrol::twin
