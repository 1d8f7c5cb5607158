// Verbs: CiA 402's and the drive's own, each as the telegrams that it takes one after the other.
// In: the job, what the drive shows. Out: telegrams, the job's end. Never goes on where the drive shows something else than it should.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/drive_job.hpp"

namespace axisgate::linmot {

/// power.cpp: the control word as the drive has it.
class ControlWord : public Part {
public:
    using Part::Part;
    [[nodiscard]] Telegram write(std::uint16_t word);
    [[nodiscard]] std::uint16_t word() const noexcept { return word_; }
    /// After a restart of the gateway, or somebody else's telegram: as the status word shows it.
    void shown(const Status& status) noexcept;
    void forget() noexcept { known_ = false; }
    /// The drive has restarted.
    void cleared() noexcept { word_ = cw_off; }

private:
    std::uint16_t word_ = cw_off;  ///< last written, or read off the status word
    bool known_ = false;
};

/// power.cpp: Enable.
class Power final : public Verb {
public:
    using Verb::Verb;
    std::optional<Telegram> request(Turn& t) override;
};

/// power.cpp: ResetFault.
class FaultReset final : public Verb {
public:
    using Verb::Verb;
    std::optional<Telegram> request(Turn& t) override;
};

/// motion.cpp: a motion command: sent once with a new count, executed when the drive shows that count. Takes over jobs of other verbs.
class MotionOrders final : public Verb {
public:
    using Verb::Verb;
    /// The job goes on as this motion; it is sent when the line is free.
    void begin_motion(const Motion& motion, std::vector<Value> values);
    std::optional<Telegram> request(Turn& t) override;
    void answered(const Telegram& telegram, Turn& t) override;

    [[nodiscard]] Telegram telegram(const Motion& motion, std::uint8_t count, std::span<const Value> values) const;
    [[nodiscard]] std::uint8_t next_count() noexcept { return count_ = static_cast<std::uint8_t>((count_ + 1) & 0x0F); }
    /// A default response is here.
    void seen(const Status& status, Turn& t);
    void found() noexcept { count_ = 0; }
    void has_target(bool target) noexcept { to_target_ = target, wanted_ = target ? Course::to_target : Course::unknown; }
    /// The motion that is being sent is a move to the end of the numbers: it runs until it is told otherwise.
    void endless() noexcept { wanted_ = Course::endless; }
    void no_target() noexcept { to_target_ = false, course_ = wanted_ = Course::unknown; }
    void forget() noexcept { fresh_ = to_target_ = false, course_ = wanted_ = Course::unknown; }
    /// Of the last motion that the drive has taken.
    [[nodiscard]] Course course() const noexcept { return course_; }
    /// A move was answered as failed: should the drive show its count all the same, it is stopped.
    void given_up(std::uint8_t count) noexcept { orphan_ = count; }
    /// Counts are somebody else's from here on.
    void no_orphan() noexcept { orphan_.reset(); }
    [[nodiscard]] bool fresh() const noexcept { return fresh_; }
    [[nodiscard]] bool to_target() const noexcept { return to_target_; }

private:
    std::uint8_t count_ = 0;                                      ///< of the last motion command, as the drive shows it in state 8
    bool fresh_ = false;                                          ///< taken, and not yet seen by a poll
    bool to_target_ = false;                                      ///< the last motion has a target
    Course course_ = Course::unknown, wanted_ = Course::unknown;  ///< of the motion that was taken; of the one that is being sent
    std::optional<std::uint8_t> orphan_;                          ///< count of a move that was answered as failed
};

/// motion.cpp: Move, SetPosition.
class Moves final : public Verb {
public:
    using Verb::Verb;
    void begin(Turn& t) override;
    std::optional<Telegram> request(Turn&) override { return std::nullopt; }  // it has begun a motion, or has ended

private:
    void begin_move(const Move& move, Turn& t);
};

/// homing.cpp: Home, and the watch over a search.
class Homing final : public Verb {
public:
    using Verb::Verb;
    void begin(Turn& t) override;
    std::optional<Telegram> request(Turn& t) override;
    /// With each status: has the search ended, or was it ended?
    void watch(Turn& t);
    /// The drive is in an error. True: a search has ended by it.
    [[nodiscard]] bool broken() noexcept { return std::exchange(searching_, false); }
    /// The search has ended: the control word's bit is to be taken back.
    [[nodiscard]] bool to_release() const noexcept { return release_; }
    void release(Turn& t);
    void release_lost() noexcept { release_ = true; }
    void no_release() noexcept { release_ = false; }
    void forget() noexcept { release_ = searching_ = false; }

private:
    bool release_ = false, searching_ = false;
};

/// parameters.cpp: points of the catalogue.
class Parameters final : public Verb {
public:
    using Verb::Verb;
    std::optional<Telegram> request(Turn& t) override;
    void answered(const Telegram& telegram, Turn& t) override;
    void without_success(drive::Failure& how, Turn& t) override;

private:
    [[nodiscard]] Point point();
    [[nodiscard]] bool begin_text(const Parameter& parameter, Turn& t);
    void done(Value value, Turn& t);
    void rom_answered(const Telegram& telegram, ValueType type, Turn& t);
};

/// parameters_transfer.cpp: what takes many telegrams: a job's transfer, asked before its verb.
class Transfers : public Part {
public:
    using Part::Part;
    /// Reads, or writes these blocks and reads them back.
    void begin_read(bool curve, std::uint16_t id);
    void begin_write(bool curve, std::uint16_t id, std::vector<std::uint8_t> first, std::vector<std::uint8_t> second = {});
    [[nodiscard]] bool active() const noexcept;
    [[nodiscard]] std::optional<Telegram> request();
    /// True: it is over, and the job's transfer has what the drive has. An end with a fault is told here.
    [[nodiscard]] bool answered(const Telegram& telegram, Turn& t);
    /// After a silence: from the beginning, three times in all.
    [[nodiscard]] bool again();
    /// What was read or written, as text.
    [[nodiscard]] std::string text() const;

private:
    [[nodiscard]] Transfer& now() const noexcept;
};

/// native.cpp: a telegram of the client's own.
class NativeTelegram final : public Verb {
public:
    using Verb::Verb;
    std::optional<Telegram> request(Turn& t) override;
    void answered(const Telegram& telegram, Turn& t) override;
};

/// actions.cpp: motion commands by name, and the messages beyond them.
class Actions final : public Verb {
public:
    using Verb::Verb;
    void begin(Turn& t) override;
    std::optional<Telegram> request(Turn& t) override;
    void answered(const Telegram& telegram, Turn& t) override;

private:
    void begin_transfer(const Action& action, Turn& t);
    void program_answered(const std::string& name, const Telegram& telegram, Turn& t);
    void errors_answered(const std::string& name, const Telegram& telegram, Turn& t);
    void rows_answered(const std::string& name, const Telegram& telegram, Turn& t);
    void info_answered(int step, const ConfigAnswer& answer, Turn& t);
    void add_row(std::string row);
};

}  // namespace axisgate::linmot
