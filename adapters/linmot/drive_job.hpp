// Jobs holds the queue of one drive and the command in progress. A verb carries out one kind of command by a sequence of telegrams. One job
// is in progress at a time, and each command has exactly one result.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/jobs.hpp"
#include "gateway/drive/set_points.hpp"

namespace axisgate::linmot {

/// The transfer of a command table entry (one block) or a curve (info and data).
struct Transfer {
    bool active = false, curve = false, write = false;
    std::uint16_t id = 0;
    std::array<std::vector<std::uint8_t>, 2> blocks{}, seen{};  ///< to be written; as read
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
    std::uint8_t count = 0;  ///< of the motion command that was sent
    std::uint8_t state_before = 0;
    std::int64_t number = 0;
    std::vector<std::uint8_t> motion;  ///< the command that is being sent, without its count
    Transfer transfer;
};

/// The telegrams of one kind of command.
class Verb : public drive::VerbBase<Part, Job> {
public:
    using VerbBase::VerbBase;

    /// The job is the next one. It may end here, before anything is sent.
    virtual void begin(Turn&) {}
    /// The next telegram; empty: the job has ended.
    [[nodiscard]] virtual std::optional<Telegram> request(Turn& t) = 0;
    /// An answer has arrived. The feedback has already taken its default response.
    virtual void answered(const Telegram&, Turn&) {}
    void without_success(drive::Failure& how, Turn& t) override;

protected:
    ~Verb() = default;
    /// The text of a refusal with one of the drive's codes.
    [[nodiscard]] std::string refusal(std::uint8_t code) const;
    /// Refuses the job and returns an empty request.
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
    /// True: a telegram was sent.
    [[nodiscard]] bool go(Turn& t);
    void answered(const Telegram& telegram, Turn& t);
    void silent(Turn& t);
    /// The drive needs time for its answer; this does not count as a time-out.
    void look_later(Turn& t) noexcept;
    void forget();
    /// Another verb continues the job.
    void hand_to(Verb& verb) noexcept { job_.verb = &verb; }

private:
    void begin_next(Turn& t);
    [[nodiscard]] Verb* verb_of(const CommandBody& body) const noexcept;
};

}  // namespace axisgate::linmot
