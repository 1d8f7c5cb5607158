// The verbs of a LinMot drive: those of CiA 402 and the drive's own, each as a sequence of telegrams. A verb ends its job when the drive
// shows an unexpected state.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/drive_job.hpp"

namespace axisgate::linmot {

/// power.cpp: the control word that is in force in the drive.
class ControlWord : public Part {
public:
    using Part::Part;
    [[nodiscard]] Telegram write(std::uint16_t word);
    [[nodiscard]] std::uint16_t word() const noexcept { return word_; }
    /// After a restart of the gateway, or a telegram of another master: the control word that the status word shows.
    void shown(const Status& status) noexcept;
    void forget() noexcept { known_ = false; }
    /// The drive has restarted.
    void cleared() noexcept { word_ = cw_off; }

private:
    std::uint16_t word_ = cw_off;  ///< last written, or derived from the status word
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

/// motion.cpp: a motion command is sent once with a new count, and was executed when the drive shows that count. Also continues jobs of
/// other verbs.
class MotionOrders final : public Verb {
public:
    using Verb::Verb;
    /// The job continues with this motion, which is sent when the line is free.
    void begin_motion(const Motion& motion, std::vector<Value> values);
    std::optional<Telegram> request(Turn& t) override;
    void answered(const Telegram& telegram, Turn& t) override;

    [[nodiscard]] Telegram telegram(const Motion& motion, std::uint8_t count, std::span<const Value> values) const;
    /// The count of a motion command that is sent now: neither the last one that was sent nor the one that the drive shows.
    [[nodiscard]] std::uint8_t next_count(Instant now) noexcept;
    /// A default response has arrived.
    void seen(const Status& status, Turn& t);
    void found() noexcept { count_ = 0, shown_ = no_count, sent_at_ = Instant{}; }
    void has_target(bool target) noexcept { to_target_ = target, wanted_ = target ? Course::to_target : Course::unknown; }
    /// The motion that is being sent is a move to the end of the number range: it runs until the next order.
    void endless() noexcept { wanted_ = Course::endless; }
    void no_target() noexcept { to_target_ = false, course_ = wanted_ = Course::unknown; }
    void forget() noexcept { fresh_ = to_target_ = false, course_ = wanted_ = Course::unknown; }
    /// Of the last motion that the drive has accepted.
    [[nodiscard]] Course course() const noexcept { return course_; }
    /// A move was answered as failed: if the drive shows its count later, it is stopped.
    void given_up(std::uint8_t count) noexcept { orphan_ = count; }
    /// From now on, the counts belong to another master.
    void no_orphan() noexcept { orphan_.reset(); }
    [[nodiscard]] bool fresh() const noexcept { return fresh_; }
    [[nodiscard]] bool to_target() const noexcept { return to_target_; }

private:
    static constexpr std::uint8_t no_count = 0xFF;
    std::uint8_t count_ = 0;                                      ///< of the last motion command: as it was sent, later as it is shown
    std::uint8_t shown_ = no_count;                               ///< by the drive, in state 8
    Instant sent_at_{};                                           ///< of the last motion command
    bool fresh_ = false;                                          ///< accepted, and not yet seen by a poll
    bool to_target_ = false;                                      ///< the last motion has a target
    Course course_ = Course::unknown, wanted_ = Course::unknown;  ///< of the accepted motion; of the one that is being sent
    std::optional<std::uint8_t> orphan_;                          ///< count of a move that was answered as failed
};

/// motion.cpp: Move, SetPosition.
class Moves final : public Verb {
public:
    using Verb::Verb;
    void begin(Turn& t) override;
    std::optional<Telegram> request(Turn&) override { return std::nullopt; }  // the verb has begun a motion, or has ended

private:
    void begin_move(const Move& move, Turn& t);
};

/// homing.cpp: Home, and the monitoring of the drive's search.
class Homing final : public Verb {
public:
    using Verb::Verb;
    void begin(Turn& t) override;
    std::optional<Telegram> request(Turn& t) override;
    /// To be called with each status: detects the end of the search.
    void watch(Turn& t);
    /// The drive is in an error. True: a search has ended by it.
    [[nodiscard]] bool broken() noexcept { return std::exchange(searching_, false); }
    /// The search has ended: the homing bit of the control word is to be reset.
    [[nodiscard]] bool to_release() const noexcept { return release_; }
    void release(Turn& t);
    void release_lost() noexcept { release_ = true; }
    void no_release() noexcept { release_ = false; }
    void forget() noexcept {
        release_ = searching_ = false;
        ended_at_.reset();
    }
    /// The search has ended, and the drive still shows the state of it: orders are refused until it shows state 8.
    [[nodiscard]] bool settles(Instant now) const noexcept { return ended_at_ && now - *ended_at_ < shown_within; }

private:
    bool release_ = false, searching_ = false;
    std::optional<Instant> ended_at_;  ///< when a search of this gateway has shown its end, until the drive has left its state
};

/// parameters.cpp: parameters of the catalogue.
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

/// parameters_transfer.cpp: values that need many telegrams. A job's transfer is served before its verb.
class Transfers : public Part {
public:
    using Part::Part;
    /// Reads, or writes these blocks and reads them back.
    void begin_read(bool curve, std::uint16_t id);
    void begin_write(bool curve, std::uint16_t id, std::vector<std::uint8_t> first, std::vector<std::uint8_t> second = {});
    [[nodiscard]] bool active() const noexcept;
    [[nodiscard]] std::optional<Telegram> request();
    /// True: the transfer is complete and contains the drive's values. A fault is answered here.
    [[nodiscard]] bool answered(const Telegram& telegram, Turn& t);
    /// After a time-out: begins again, three attempts in all.
    [[nodiscard]] bool again();
    /// The value that was read or written, as text.
    [[nodiscard]] std::string text() const;

private:
    [[nodiscard]] Transfer& now() const noexcept;
};

/// native.cpp: a telegram that the client has written.
class NativeTelegram final : public Verb {
public:
    using Verb::Verb;
    std::optional<Telegram> request(Turn& t) override;
    void answered(const Telegram& telegram, Turn& t) override;
};

/// actions.cpp: motion commands by name, and further messages.
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
