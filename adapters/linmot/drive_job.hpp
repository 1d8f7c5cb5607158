// Jobs: the queue of one drive and the command that is being carried out: exchanges one after the other, each asked of the verb that knows
// what follows from the one before.
// In: commands, answers, silences. Out: the next telegram; exactly one result per command. Never two jobs at once.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/jobs.hpp"
#include "gateway/drive/set_points.hpp"

namespace axisgate::linmot {

/// A command table entry (one block) or a curve (info and data) on its way.
struct Transfer {
    bool active = false, curve = false, write = false;
    std::uint16_t id = 0;
    std::array<std::vector<std::uint8_t>, 2> blocks{}, seen{};  ///< to be written; read
    std::array<std::uint32_t, 2> sizes{};
    int step = 0;
    std::size_t at = 0;
    int tries = 0;
};

class Verb;
struct Job : drive::JobBase<Verb> {
    int step = 0;
    Instant not_before{};  ///< of the next exchange
    Instant limit = never;
    std::uint8_t count = 0;  ///< of a motion command that was sent
    std::uint8_t state_before = 0;
    std::int64_t number = 0;
    std::vector<std::uint8_t> motion;  ///< the command that is sent, all but its count
    Transfer transfer;
};

/// What one kind of command is in the drive's telegrams.
class Verb : public drive::VerbBase<Part, Job> {
public:
    using VerbBase::VerbBase;

    /// The job's turn has come: it may end here, before anything is sent.
    virtual void begin(Turn&) {}
    /// Its next telegram; nothing: it has ended.
    [[nodiscard]] virtual std::optional<Telegram> request(Turn& t) = 0;
    /// The default response has been learnt from already.
    virtual void answered(const Telegram&, Turn&) {}
    void without_success(drive::Failure& how, Turn& t) override;

protected:
    ~Verb() = default;
    /// By a code of the drive's.
    [[nodiscard]] std::string refusal(std::uint8_t code) const;
    /// The same as the end of a request.
    template <class... Args>
    std::optional<Telegram> refused(Args&&... args) {
        return refuse(std::forward<Args>(args)...), std::nullopt;
    }
};

class Jobs : public drive::JobsBase<Part, Job> {
public:
    using JobsBase::JobsBase;

    drive::SetPoints set_points;  ///< those that are sent as moves

    /// A command or a set-point waits, or the next exchange of a job.
    [[nodiscard]] bool wants(Instant now) const noexcept;
    [[nodiscard]] Instant wish() const noexcept;
    /// True: it has sent.
    [[nodiscard]] bool go(Turn& t);
    void answered(const Telegram& telegram, Turn& t);
    void silent(Turn& t);
    /// It takes its time to answer, and that is no silence.
    void look_later(Turn& t) noexcept;
    void forget();
    /// It goes on as another verb's.
    void hand_to(Verb& verb) noexcept { job_.verb = &verb; }

private:
    void begin_next(Turn& t);
    [[nodiscard]] Verb* verb_of(const CommandBody& body) const noexcept;
};

}  // namespace axisgate::linmot
