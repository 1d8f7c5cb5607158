// Errors and Waits: what the drive's error flag stands for, and the commands that wait for their end.
// In: statuses, error reports, alarms, what the axis shows. Out: fault and warning of the axis, notices, results.
// Never takes for a fault what the drive has refused to this gateway.
#pragma once

#include <string>
#include <vector>

#include "adapters/uim342/drive_part.hpp"

namespace axisgate::uim342 {

class Errors : public Part {
public:
    using Part::Part;

    void on_report(const Message& m, Turn& t);  ///< CW 0F that nobody has asked for
    void on_latest(const Message& m, Turn& t);  ///< ER[0]
    void on_alarm(std::uint8_t code, Turn& t);
    void on_status(const Status& s, bool err_is_new) noexcept;
    /// The drive has refused something of ours.
    void refused_ours(const Message& m) noexcept;
    void cleared() noexcept { cause_ = Cause::none, alarm_ = latest_ = 0; }
    /// `ours`: a flag that stood before a silence was for something that it had refused: it is no fault after it. A restart clears the
    /// flag, and then it says nothing.
    void found(bool ours) noexcept { cause_ = ours ? Cause::own : Cause::none, alarm_ = 0; }

    [[nodiscard]] bool to_read() const noexcept { return to_read_; }
    void read(Turn& t);
    void read_again() noexcept { to_read_ = true; }
    void no_read() noexcept { to_read_ = false; }

    [[nodiscard]] bool ours() const noexcept { return cause_ == Cause::own; }
    [[nodiscard]] bool any_latest() const noexcept { return latest_ != 0; }
    [[nodiscard]] bool fault(const Status& s) const noexcept;
    [[nodiscard]] bool warning(const Status& s) const noexcept { return !fault(s) && (s.err || alarm_ != 0); }
    [[nodiscard]] bool at_limit() const noexcept { return alarm_ == 0x1A || alarm_ == 0x1B; }
    [[nodiscard]] std::uint16_t code(const Status& s) const noexcept { return alarm_ != 0 ? alarm_ : s.err ? latest_ : std::uint16_t{0}; }

private:
    enum class Cause : std::uint8_t { none, own, foreign };  ///< of the ERR flag
    Cause cause_ = Cause::none;
    std::uint8_t alarm_ = 0;   ///< last alarm that stands, 0: none
    std::uint8_t latest_ = 0;  ///< code of ER[0] as last read
    bool to_read_ = false;
};

class Waits : public Part {
public:
    static constexpr std::size_t limit = 16;  ///< one more is answered as accepted, unwatched
    enum class Until : std::uint8_t { target, speed, standstill, on, off, boot, share };
    struct Wait {
        Until until = Until::target;
        Ticket ticket = no_ticket;  ///< share: nobody's, the adapter is told
        std::int64_t value = 0;     ///< speed: the one to reach
        Instant since{};
    };

    explicit Waits(Drive& drive) : Part(drive) { waits_.reserve(limit); }

    /// The drive has acknowledged a command: its result now, or when `wait` is over.
    void accepted(const Wait& wait, bool until_done, std::string text, Turn& t);
    void add(const Wait& wait, Turn& t);
    void check(Turn& t);  ///< behind each status and speed
    void end(bool motions_only, Reason reason, const std::string& text, Turn& t);
    void forget_share() {
        std::erase_if(waits_, [](const Wait& w) { return w.until == Until::share; });
    }

private:
    struct Verdict {
        bool over = false;
        Reason reason = Reason::none;  ///< none: it is done
        std::string text{};
    };
    [[nodiscard]] Verdict verdict(const Wait& w, Instant now) const;
    void answer(const Wait& w, Reason reason, std::string text, std::int32_t code, Turn& t);

    std::vector<Wait> waits_;
};

}  // namespace axisgate::uim342
