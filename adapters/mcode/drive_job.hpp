// Jobs: the queue of one drive and the command that is being carried out: a list of steps, and the verb that knows what follows from each.
// In: commands, the ends of steps, the polls and error codes that confirm lines. Out: the next step; exactly one result per command.
// Never takes an acknowledgement for obedience: behind each line a poll tells whether the drive complained, and ER what about.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/drive_part.hpp"
#include "gateway/drive/command_queue.hpp"

namespace axisgate::mcode {

struct Step {
    enum class What : std::uint8_t {
        send,   ///< a line; then a confirming poll tells whether the drive complained
        bare,   ///< a line, its ACK alone (program mode, where a poll would become part of the program)
        query,  ///< PR with a mark
        block,  ///< text of unknown length, closed by a question
        standstill
    };
    What what = What::send;
    std::string text;
    bool repeatable = true;
    bool end_mark = false;  ///< query: the answer may have several lines
    std::size_t line = 0;   ///< of the user's program text; 0: not from there
};

class Verb;
struct Job {
    Verb* verb = nullptr;  ///< nobody: nothing is being done
    Command command;       ///< no_ticket: the drive's own business
    std::vector<Step> steps;
    std::size_t at = 0;
    int tries = 0;
    bool confirming = false;
    Verdict acknowledgement = Verdict::waiting;
    std::string text;                 ///< of its result
    std::string listing;              ///< block: what came, as it came
    std::vector<std::uint8_t> bytes;  ///< native: what came back
    Instant give_up = never;          ///< of a standstill, or of what comes back

    [[nodiscard]] bool idle() const noexcept { return !verb; }
    [[nodiscard]] bool pending() const noexcept { return verb && at < steps.size(); }
    [[nodiscard]] bool waits_for_rest() const noexcept { return pending() && steps[at].what == Step::What::standstill; }
    Job& send(std::string line, bool repeatable = true) { return add({Step::What::send, std::move(line), repeatable}); }
    Job& ask(std::string items) { return add({Step::What::query, std::move(items)}); }
    Job& ask_rows(std::string items) { return add({Step::What::query, std::move(items), true, true}); }
    Job& list(std::string line) { return add({Step::What::block, std::move(line)}); }
    Job& standstill() { return add({Step::What::standstill, "standstill"}); }
    Job& add(Step step) {
        steps.push_back(std::move(step));
        return *this;
    }
};

/// What one kind of command is in the words of this drive: it plans the steps, and says what follows from their answers.
class Verb : public Part {
public:
    using Part::Part;

    virtual void plan(const Command& command, Turn& t) = 0;
    /// The line of a step goes out.
    virtual void sending(Step&, Request&) {}
    /// A step's exchange has ended. True: the verb has seen to it.
    virtual bool ended(const Step&, Verdict, Turn&) { return false; }
    /// A line was refused with an error; 0: it was not acknowledged. True: the verb has seen to it.
    virtual bool complained(const Step&, int /*error*/, Turn&) { return false; }
    virtual void answered(const std::string& data, Turn& t);  ///< a query: next step
    virtual void listed(const std::string& text, Turn& t);    ///< a block: it is the result
    virtual void done(Turn& t);                               ///< the last step was
    /// It ends without success, with its result still to be given.
    virtual void failed(const std::string& /*why*/, int /*error*/, Turn&) {}
    /// It is dropped: by a stop, or because the drive is gone. What it adds to its result.
    virtual std::string dropped() { return {}; }
    /// A stop ends it, if it is a command that moves.
    [[nodiscard]] virtual bool moves() const noexcept { return false; }
    /// Its lines are this gateway's own, and not somebody's text: their motions can be computed.
    [[nodiscard]] virtual bool own_lines() const noexcept { return false; }

protected:
    ~Verb() = default;
    [[nodiscard]] Job& job() noexcept;
    void refuse(Reason reason, std::string text, Turn& t);
    void fail(Reason reason, std::string text, Turn& t, std::int32_t code = 0);
    void succeed(std::string text, Turn& t, Value value = {});
    /// Actions for which the drive must not move: behind a stop or the end of a move MV stays 1 for MT + HT, which is waited for.
    /// false: it moves, and the job is over.
    [[nodiscard]] bool wait_for_rest(Turn& t);
};

class Jobs : public Part {
public:
    static constexpr std::size_t queue_limit = 64;  ///< waiting commands; one more is refused as busy
    using Part::Part;

    // --- what waits ---------------------------------------------------------------------------------------------------------
    drive::CommandQueue queue{queue_limit};
    drive::Tickets tickets{};
    void begin(const Command& command, Turn& t);
    /// The drive's own business: the verb adds its steps.
    Job& begin(Verb& verb);
    /// By a stop what moves the axis is over, also while it waits. With the power off so is what would bring that back.
    void cancel_motions(std::string_view by, bool power_off, Turn& t);
    void fail_all(Reason reason, const std::string& why, Turn& t);

    // --- what is being done -------------------------------------------------------------------------------------------------
    [[nodiscard]] const Job& job() const noexcept { return job_; }
    [[nodiscard]] Job& job() noexcept { return job_; }
    [[nodiscard]] bool idle() const noexcept { return job_.idle(); }
    [[nodiscard]] bool is(const Verb& verb) const noexcept { return job_.verb == &verb; }
    void take_next(Turn& t);
    [[nodiscard]] Request next(Instant now);
    void ended(Verdict v, const ReplyReader& r, Turn& t);
    void confirmed(Turn& t);
    void unconfirmed(std::string why, Turn& t);
    void missed(Turn& t);
    void watch(Turn& t);  ///< behind a poll: does it stand?
    void step_done(Turn& t);
    void over(Outcome o, Reason r, std::string text, Turn& t, std::int32_t code = 0, Value value = {});
    /// Its command is answered by somebody else, later.
    [[nodiscard]] Command hand_over();
    void say_again() noexcept { job_.confirming = false; }

private:
    [[nodiscard]] Verb& verb_of(const CommandBody& body) const noexcept;
    [[nodiscard]] bool ended_by_stop(const CommandBody& body, bool power_off) const;
    void line_sent(Verdict v, Turn& t);
    void query_ended(Verdict v, const ReplyReader& r, Turn& t);
    void block_ended(Verdict v, const ReplyReader& r, Turn& t);
    void block_read(Turn& t);

    Job job_;
};

}  // namespace axisgate::mcode
