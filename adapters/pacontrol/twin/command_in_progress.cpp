// The command in progress. In: polls, time. Out: acknowledgements. Never forgets an end of processing that was not told.
#include "adapters/pacontrol/twin/command_in_progress.hpp"

namespace axisgate::pacontrol::twin {

CommandReply CommandInProgress::begin(const Job& job, Instant now) {
    job_ = job;
    return reply(now);
}

CommandReply CommandInProgress::reply(Instant now) {
    CommandReply r;
    switch (job_.awaits) {
        case Awaits::none:
            return last_;
        case Awaits::move:
        case Awaits::reference:
        case Awaits::halt: {
            const Axis& a = axes_.at(job_.axis);
            r.data = job_.awaits == Awaits::reference ? Datum{} : Datum::number(a.shown().position(now));
            r.done = job_.awaits == Awaits::halt ? !a.running() : !a.traverse().busy();
            if (r.done && job_.awaits != Awaits::halt) r.quit = a.traverse().ended_with();
            break;
        }
        case Awaits::power: {
            r.data = Datum::integer(0);
            r.done = !axes_.at(job_.axis).state().switching_on();
            break;
        }
        case Awaits::mode: {
            const Mode& mode = operation_.mode();
            const std::uint8_t s = mode.status();
            const bool under_way = s == status::auto_started || s == status::auto_after_stop || s == status::online_started ||
                                   s == status::auto_stop || s == status::auto_stop_program || s == status::online_stop;
            r.done = !under_way && !mode.leaving();
            if (!r.done) r.expected = mode.deadline();
            break;
        }
    }
    if (r.done) {
        job_ = {};
        last_ = r;
    }
    return r;
}

void CommandInProgress::note(const CommandReply& reply) noexcept {
    if (job_.awaits == Awaits::none) last_ = reply;
}

void CommandInProgress::take_up(const Job& job) noexcept {
    if (exclusive(job)) job_ = job;
}

void CommandInProgress::forget() noexcept {
    job_ = {};
    last_ = {};
}

}  // namespace axisgate::pacontrol::twin
