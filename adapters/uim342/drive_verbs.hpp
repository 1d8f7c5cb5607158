// Verbs: CiA 402's and the drive's own, each as a list of exchanges with what follows from each answer.
// In: commands from the queue, answers to their steps. Out: steps, results.
// Never starts what it could not set: any refused or altered value ends the job before BG. Never repeats BG.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/uim342/drive_job.hpp"
#include "adapters/uim342/feedback.hpp"

namespace axisgate::uim342 {

/// power.cpp: Enable. Disable is a stop.
class Power final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void done(Turn& t) override;
};

/// power.cpp: ResetFault.
class FaultReset final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void done(Turn& t) override;
    void failed(const Step& step, Failure how, Turn& t) override;
};

/// homing.cpp: Home without a search, SetPosition.
class Origin final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void done(Turn& t) override;
};

/// motion.cpp: Move, StartTogether of this drive alone.
class Moves final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void done(Turn& t) override;

private:
    void plan_move(const Move& move, Turn& t);
    [[nodiscard]] std::optional<std::uint32_t> ramp(std::int64_t rate, std::int64_t speed, std::string_view name, std::string& fault);

    Motion motion_;  ///< as it will be begun
};

/// motion.cpp: the drive's share of a joint start, run by the adapter: prepared, gathered, begun, ended.
class Together final : public Verb {
public:
    using Verb::Verb;
    /// A place in a joint start, put into the queue by join(): a StartTogether of nobody.
    [[nodiscard]] static bool is_place(const CommandBody& body) noexcept;
    void plan(const Command& command, Turn& t) override;

    void prepare(const Motion& motion) { prepared_ = motion; }
    void unprepare() noexcept { prepared_.reset(); }
    [[nodiscard]] const std::optional<Motion>& prepared() const noexcept { return prepared_; }
    /// Ready for a start: online, on, not locked. Empty, or what is missing.
    [[nodiscard]] std::string not_startable() const;
    /// Stands in the queue like a command, so that order is kept; the adapter is told by share_ready when its turn has come.
    /// False: the queue is full.
    [[nodiscard]] bool join();
    /// The joint start has been sent: find out what became of it; the adapter is told by share_done.
    void begun(Turn& t);
    /// The joint start will not be: goes on with what waits.
    void leave(Turn& t);
    /// A status has come that was asked for at `sent`.
    void at_status(Instant sent, Turn& t);
    /// What it has begun has come to an end.
    void over(Share share, Turn& t);
    /// The same, also while it waits for the others.
    void give_up(Share share, Turn& t);
    /// A BG to a group may still be on its way.
    [[nodiscard]] bool on_its_way(Instant now) const noexcept { return now < broadcast_until_; }

private:
    std::optional<Motion> prepared_;
    Instant broadcast_until_{};
    enum class Stage : std::uint8_t { none, joined, begun };  ///< begun: until the first status behind it
    Stage stage_ = Stage::none;
};

/// parameters.cpp: points of the catalogue.
class Parameters final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void answered(const Step& step, const Message* m, Turn& t) override;

private:
    void plan_write(const WriteParameter& write, const Parameter& p, const std::string& id, Turn& t);
    void add(const Message& m);
    void written(const Step& step, const Message& m, Turn& t);
    [[nodiscard]] std::string id_conflict(std::uint8_t index, std::int64_t value) const;
    [[nodiscard]] std::string storage_note() const;

    const Binding* binding_ = nullptr;
    std::int64_t wanted_ = 0;
};

/// native_lines.cpp: the drive's own language, and the actions of this family, which are lines of it.
class NativeLines final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void answered(const Step& step, const Message* m, Turn& t) override;
    void done(Turn& t) override;
    /// As the result has it: CW, DL and the data.
    static void keep(const Message& m, std::vector<std::uint8_t>& bytes);

private:
    void plan_messages(const std::vector<Message>& messages, Turn& t);
    void restart(Turn& t);

    std::optional<std::uint8_t> system_;  ///< index of the SY that it ends with: 1 reboot, 2 factory defaults
};

}  // namespace axisgate::uim342
