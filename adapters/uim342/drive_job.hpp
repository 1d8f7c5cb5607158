// Jobs: the queue of one drive and the command that is being carried out: a list of steps, and the verb that knows what follows from each.
// In: commands, the ends of steps. Out: the next step as an exchange; exactly one result per command.
// Never lets anything between MF and its value: the pair begins anew if something did.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adapters/uim342/drive_part.hpp"
#include "gateway/drive/command_queue.hpp"

namespace axisgate::uim342 {

struct Step {
    Message message;
    std::uint8_t mf = 0;  ///< > 0: belongs to this group; the step before it selects it
    bool select = false;  ///< this is that MF
    bool check = false;   ///< a read behind an instruction without acknowledgement: a refusal would come before its answer
};

/// How a job ends without success.
struct Failure {
    Outcome outcome = Outcome::failed;
    Reason reason = Reason::none;
    std::string text;
    std::int32_t code = 0;
};

class Verb;
struct Job {
    Verb* verb = nullptr;  ///< nobody: nothing is being done
    Command command;       ///< no_ticket: the drive's own business
    bool waiting = false;  ///< no exchange until the others of a joint start are ready
    bool again = false;    ///< the pair of MF and value begins anew: something got between them
    bool exact = false;    ///< a step that is answered with another value is the end
    bool partial = false;  ///< what was done before a refused step stays: it has failed then, and is not refused
    std::array<Step, 8> steps;
    std::uint8_t count = 0, at = 0;
    std::uint8_t rounds = 0;            ///< times the group pair has been begun anew
    std::optional<std::uint8_t> blind;  ///< function of a step without acknowledgement whose refusal may still come
    std::string text;                   ///< what will be said in the result
    std::vector<std::uint8_t> bytes;    ///< native: what came back

    [[nodiscard]] bool idle() const noexcept { return !verb; }
    [[nodiscard]] bool runs() const noexcept { return verb && !waiting; }
    void restep() noexcept { count = at = 0; }
    void add(const Message& m, std::uint8_t mf = 0) { add_step({m, mf}); }
    /// One value of a group, selected just before it.
    void add_grouped(const Message& select, const Message& m, std::uint8_t mf) {
        add_step({select, 0, true});
        add_step({m, mf});
    }
    void add_step(const Step& step) {
        if (count < steps.size()) steps[count++] = step;
    }
};

/// What one kind of command is in the drive's instructions: it plans the steps, and says what follows from their answers.
class Verb : public Part {
public:
    using Part::Part;

    /// Adds the first steps to the job, or ends it.
    virtual void plan(const Command& command, Turn& t) = 0;
    /// A step has its answer; nullptr: it was sent, and wanted none.
    virtual void answered(const Step&, const Message*, Turn&) {}
    virtual void done(Turn&) {}  ///< every step was answered
    /// A step was refused, was answered with another value (`exact`), or was not answered; `how` has the job's end.
    virtual void failed(const Step& step, Failure how, Turn& t);

protected:
    ~Verb() = default;
    [[nodiscard]] Job& job() noexcept;
    void refuse(Reason reason, std::string text, Turn& t);
    /// It ends well: done for who waits for that.
    void finish(std::string text, Turn& t);
};

class Jobs : public Part {
public:
    static constexpr std::size_t queue_limit = 64;  ///< waiting commands; one more is refused as busy
    using Part::Part;

    drive::CommandQueue queue{queue_limit};

    // --- what waits ---------------------------------------------------------------------------------------------------------
    /// The next command may begin: during a search only values are read.
    [[nodiscard]] bool ready() const noexcept;
    void take_next(Turn& t);
    /// Every motion that waits or runs ends; with the power off so does what would bring that back.
    void interrupt(std::string_view by, bool power_off, Turn& t);
    void fail_all(Reason reason, const std::string& text, Turn& t);

    // --- what is being done -------------------------------------------------------------------------------------------------
    [[nodiscard]] const Job& job() const noexcept { return job_; }
    [[nodiscard]] Job& job() noexcept { return job_; }
    [[nodiscard]] bool idle() const noexcept { return job_.idle(); }
    [[nodiscard]] bool is(const Verb& verb) const noexcept { return job_.verb == &verb; }
    /// The drive's own business: the verb adds its steps, and calls run.
    Job& begin(Verb& verb, const CommandBody& body);
    /// Sends the present step, or what has to go before it.
    void run(Turn& t);
    void answered(const Message& m, Turn& t);
    void refused(const Message& m, Turn& t);
    void silent(Turn& t);
    void over(Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0, Value value = {});
    /// It is over, and its command is answered by who takes it.
    Job hand_over() { return std::exchange(job_, {}); }
    /// A stop is about to be sent: it may use up the selection of a group.
    void disturbed() noexcept;

private:
    [[nodiscard]] Verb& verb_of(const CommandBody& body) const noexcept;
    void step_done(const Step& step, const Message* answer, Turn& t);

    Job job_;
};

}  // namespace axisgate::uim342
