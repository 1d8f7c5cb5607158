// Jobs holds the command queue of one drive and the command in progress (the job). A Verb carries out one kind of command by the exchanges
// of a family. One command is in progress at a time, and each command has exactly one result. The family decides which steps a job has and
// when the next one begins.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/tickets.hpp"

namespace axisgate::drive {

/// The result of a job that ended without success.
struct Failure {
    Outcome outcome = Outcome::failed;
    Reason reason = Reason::none;
    std::string text;
    std::int32_t code = 0;
    bool dropped = false;  ///< a stop has ended the job, or the drive is gone
};

/// The members that every job has. The family derives its own job and adds the state of its steps.
template <class Verb>
struct JobBase {
    Verb* verb = nullptr;             ///< nullptr: no job is in progress
    Command command;                  ///< its ticket is no_ticket if the gateway began the job itself
    std::string text;                 ///< text of the result
    std::vector<std::uint8_t> bytes;  ///< answer to a native statement
    [[nodiscard]] bool idle() const noexcept { return !verb; }
};

/// `Part` is the family's part class; its drive has a member `jobs`.
template <class Part, class Job>
class VerbBase : public Part {
public:
    using Part::Part;
    /// The job is about to end with this failure. A verb may add to the text of the result.
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

/// The drive of `Part` has a member `tickets`; `Job` derives from JobBase.
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
    /// Begins a job of the drive itself, whose result no client waits for.
    Job& begin_own(auto& verb, CommandBody body = {}) {
        Command own;
        own.axis = this->drive_.axis();
        own.body = std::move(body);
        return begin(verb, std::move(own));
    }
    /// Ends the job without a result; the caller answers its command.
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
    /// A stop ends each command for which `ends(command)` is true, whether it waits or is in progress.
    template <class Ends>
    void interrupt(Ends&& ends, std::string_view by, Turn& t) {
        if (!idle() && ends(job_.command))
            over(Failure{Outcome::failed, Reason::interrupted, CommandQueue::interrupted_by(by), 0, true}, t);
        queue.interrupt(ends, by, this->drive_.tickets, t);
    }
    /// The drive is gone: the job and all waiting commands fail.
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
