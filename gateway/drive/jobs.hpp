// Jobs: the queue of one drive and the command that is being carried out; Verb: what one kind of command is in a family's exchanges.
// In: commands, what verbs make of the ends of their exchanges, stops. Out: exactly one result per command.
// Never sends, and never two commands at once: what a job's steps are, and when the next begins, is the family's.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/tickets.hpp"

namespace axisgate::drive {

/// How a job ends without success.
struct Failure {
    Outcome outcome = Outcome::failed;
    Reason reason = Reason::none;
    std::string text;
    std::int32_t code = 0;
    bool dropped = false;  ///< by a stop, or because the drive is gone
};

/// What every job has. A family's has a name of its own for it, and adds where it stands.
template <class Verb>
struct JobBase {
    Verb* verb = nullptr;             ///< nobody: nothing is being done
    Command command;                  ///< no_ticket: the drive's own business
    std::string text;                 ///< of its result
    std::vector<std::uint8_t> bytes;  ///< native: what came back
    [[nodiscard]] bool idle() const noexcept { return !verb; }
};

/// `Part` is the family's, and its drive has `jobs`.
template <class Part, class Job>
class VerbBase : public Part {
public:
    using Part::Part;
    /// Its job ends so, and the result is given next. A verb may add to the text.
    virtual void without_success(Failure&, Turn&) {}

protected:
    ~VerbBase() = default;
    [[nodiscard]] Job& job() noexcept { return this->drive_.jobs.job(); }
    void refuse(Reason reason, std::string text, Turn& t, std::int32_t code = 0) {
        this->drive_.jobs.refuse(reason, std::move(text), t, code);
    }
    void fail(Reason reason, std::string text, Turn& t, std::int32_t code = 0) { this->drive_.jobs.fail(reason, std::move(text), t, code); }
    void accept(std::string text, Turn& t) { this->drive_.jobs.over(Outcome::accepted, std::move(text), t); }
    void succeed(std::string text, Turn& t, Value value = {}) {
        this->drive_.jobs.over(Outcome::done, std::move(text), t, std::move(value));
    }
};

/// `Part`'s drive has `tickets`; a Job is a JobBase.
template <class Part, class Job>
class JobsBase : public Part {
public:
    using Part::Part;
    CommandQueue queue;

    [[nodiscard]] const Job& job() const noexcept { return job_; }
    [[nodiscard]] Job& job() noexcept { return job_; }
    [[nodiscard]] bool idle() const noexcept { return job_.idle(); }
    [[nodiscard]] bool is(const auto& verb) const noexcept { return job_.verb == &verb; }

    Job& begin(auto& verb, Command command) {
        job_ = {};
        job_.verb = &verb;
        job_.command = std::move(command);
        return job_;
    }
    /// The drive's own business: nobody waits for it.
    Job& begin_own(auto& verb, CommandBody body = {}) {
        Command own;
        own.axis = this->drive_.axis();
        own.body = std::move(body);
        return begin(verb, std::move(own));
    }
    /// It is over, and its command is answered by who takes it.
    Job hand_over() { return std::exchange(job_, Job{}); }
    void over(Outcome outcome, std::string text, Turn& t, Value value = {}) {
        if (!idle()) end(outcome, Reason::none, std::move(text), 0, std::move(value), t);
    }
    void over(Failure how, Turn& t) {
        if (idle()) return;
        job_.verb->without_success(how, t);
        end(how.outcome, how.reason, std::move(how.text), how.code, {}, t);
    }
    void refuse(Reason reason, std::string text, Turn& t, std::int32_t code = 0) {
        over(Failure{Outcome::refused, reason, std::move(text), code}, t);
    }
    void fail(Reason reason, std::string text, Turn& t, std::int32_t code = 0) {
        over(Failure{Outcome::failed, reason, std::move(text), code}, t);
    }
    /// A stop ends what `ends(command)` names, whether it waits or is being carried out.
    template <class Ends>
    void interrupt(Ends&& ends, std::string_view by, Turn& t) {
        if (!idle() && ends(job_.command))
            over(Failure{Outcome::failed, Reason::interrupted, CommandQueue::interrupted_by(by), 0, true}, t);
        queue.interrupt(ends, by, this->drive_.tickets, t);
    }
    /// The drive is gone: nothing is left.
    void fail_all(Reason reason, std::string_view why, Turn& t) {
        over(Failure{Outcome::failed, reason, std::string(why), 0, true}, t);
        while (!queue.empty())
            this->drive_.tickets.failed(queue.pop().ticket, reason, std::string(why), t.out);
    }

protected:
    ~JobsBase() = default;
    Job job_;

private:
    void end(Outcome outcome, Reason reason, std::string text, std::int32_t code, Value value, Turn& t) {
        Job was = hand_over();
        this->drive_.tickets.answer(was.command.ticket, outcome, reason, std::move(text), t.out, code, std::move(value),
                                    std::move(was.bytes));
    }
};

}  // namespace axisgate::drive
