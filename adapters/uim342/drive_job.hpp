// Jobs: the queue of one drive and the command that is being carried out: a list of steps, and the verb that knows what follows from each.
// In: commands, the ends of steps. Out: the next step as an exchange; exactly one result per command.
// Never lets anything between MF and its value: the pair begins anew if something did.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adapters/uim342/drive_part.hpp"
#include "gateway/drive/jobs.hpp"

namespace axisgate::uim342 {

struct Step {
    Message message;
    std::uint8_t mf = 0;  ///< > 0: belongs to this group; the step before it selects it
    bool select = false;  ///< this is that MF
    bool check = false;   ///< a read behind an instruction without acknowledgement: a refusal would come before its answer
};

using drive::Failure;

class Verb;
struct Job : drive::JobBase<Verb> {
    bool waiting = false;  ///< no exchange until the others of a joint start are ready
    bool again = false;    ///< the pair of MF and value begins anew: something got between them
    bool exact = false;    ///< a step that is answered with another value is the end
    bool partial = false;  ///< what was done before a refused step stays: it has failed then, and is not refused
    std::array<Step, 8> steps;
    std::uint8_t count = 0, at = 0;
    std::uint8_t rounds = 0;            ///< times the group pair has been begun anew
    std::optional<std::uint8_t> blind;  ///< function of a step without acknowledgement whose refusal may still come

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
class Verb : public drive::VerbBase<Part, Job> {
public:
    using VerbBase::VerbBase;

    /// Adds the first steps to the job, or ends it.
    virtual void plan(const Command& command, Turn& t) = 0;
    /// A step has its answer; nullptr: it was sent, and wanted none.
    virtual void answered(const Step&, const Message*, Turn&) {}
    virtual void done(Turn&) {}  ///< every step was answered
    /// A step was refused, was answered with another value (`exact`), or was not answered; `how` has the job's end.
    virtual void failed(const Step& step, Failure how, Turn& t);
    void without_success(Failure& how, Turn& t) override;

protected:
    ~Verb() = default;
};

class Jobs : public drive::JobsBase<Part, Job> {
public:
    using JobsBase::JobsBase;

    /// The next command may begin: during a search only values are read.
    [[nodiscard]] bool ready() const noexcept;
    void take_next(Turn& t);
    /// Sends the present step, or what has to go before it.
    void run(Turn& t);
    void answered(const Message& m, Turn& t);
    void refused(const Message& m, Turn& t);
    void silent(Turn& t);
    /// A stop is about to be sent: it may use up the selection of a group.
    void disturbed() noexcept;

private:
    [[nodiscard]] Verb& verb_of(const CommandBody& body) const noexcept;
    [[nodiscard]] std::size_t here() const noexcept { return std::min<std::size_t>(job_.at, job_.steps.size() - 1); }
};

}  // namespace axisgate::uim342
