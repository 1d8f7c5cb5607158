// Jobs: the queue of one drive and the command that is being carried out: a list of steps, and the verb that knows what follows from each.
// In: commands, the ends of steps, the polls and error codes that confirm lines. Out: the next step; exactly one result per command.
// Never takes an acknowledgement for obedience: behind each line a poll tells whether the drive complained, and ER what about.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/drive_part.hpp"
#include "gateway/drive/jobs.hpp"

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
struct Job : drive::JobBase<Verb> {
    std::vector<Step> steps;
    std::size_t at = 0;
    int tries = 0;
    bool confirming = false;
    Verdict acknowledgement = Verdict::waiting;
    bool at_once = false;     ///< the line was sent soon behind an answer
    Instant said{};           ///< when its exchange ended
    std::string listing;      ///< block: what came, as it came
    Instant give_up = never;  ///< of a standstill, or of what comes back

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
class Verb : public drive::VerbBase<Part, Job> {
public:
    using VerbBase::VerbBase;

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
    /// A stop ends it, if it is a command that moves.
    [[nodiscard]] virtual bool moves() const noexcept { return false; }
    /// Its lines are this gateway's own, and not somebody's text: their motions can be computed.
    [[nodiscard]] virtual bool own_lines() const noexcept { return false; }
    /// What the poll behind a line without an acknowledgement says about it, `since` its sending.
    enum class Proof : std::uint8_t {
        none,  ///< no poll can tell
        taken,
        open,  ///< not yet to be told: read again
        lost
    };
    [[nodiscard]] virtual Proof proof(const Step&, Duration /*since*/) const { return Proof::none; }
    /// A motion shows in MV or in the position after this time at the latest.
    static constexpr Duration shows_within = std::chrono::milliseconds(400);

protected:
    ~Verb() = default;
    /// Actions for which the drive must not move: behind a stop or the end of a move MV stays 1 for MT + HT, which is waited for.
    /// false: it moves, and the job is over.
    [[nodiscard]] bool wait_for_rest(Turn& t);
};

class Jobs : public drive::JobsBase<Part, Job> {
public:
    using JobsBase::JobsBase;

    void take(const Command& command, Turn& t);
    void take_next(Turn& t);
    /// By a stop what moves the axis is over, also while it waits. With the power off so is what would bring that back.
    void cancel_motions(std::string_view by, bool power_off, Turn& t);
    [[nodiscard]] Request next(Instant now);
    void ended(Verdict v, const ReplyReader& r, Turn& t);
    void confirmed(Turn& t);
    void missed(Turn& t);
    void watch(Turn& t);  ///< behind a poll: does it stand?
    void step_done(Turn& t);
    void say_again() noexcept { job_.confirming = false; }

private:
    [[nodiscard]] Verb& verb_of(const CommandBody& body) const noexcept;
    [[nodiscard]] bool ended_by_stop(const CommandBody& body, bool power_off) const;
    void line_sent(Verdict v, Turn& t);
    [[nodiscard]] bool judged(const Step& step, Turn& t);
    void query_ended(Verdict v, const ReplyReader& r, Turn& t);
    void block_ended(Verdict v, const ReplyReader& r, Turn& t);
    void block_read(Turn& t);
};

}  // namespace axisgate::mcode
