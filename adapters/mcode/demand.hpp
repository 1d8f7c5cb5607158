// AxisDemand: where the axis of one drive should be, and who says so: its own lag register, this gateway's reckoning, or nobody.
// In: lines as the drive acknowledged them, readings of its polls, the values that its moves take. Out: the demand part of the feedback.
// Never reckons what it cannot: moves of programs, of others or of natives, S ramps and backlash leave it without a word until the axis
// stands again.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "gateway/axis/demand.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate::mcode {

class AxisDemand {
public:
    /// What moves take, in the drive's own units; 0: not known.
    struct Values {
        std::int64_t vi = 0, vm = 0, a = 0, d = 0;
        bool encoder = false;  ///< EE = 1
    };
    /// One poll.
    struct Reading {
        Instant at{};  ///< when the drive worked it out
        std::int64_t position = 0, velocity = 0;
        std::optional<std::int64_t> lag;  ///< LL, if it was asked for
        int hmt = 0;                      ///< AS
        bool energised = false;           ///< current in the motor
        bool moving = false;              ///< MV
        bool changing = false;            ///< VC
        bool stalled = false;             ///< ST
        bool program = false;             ///< BY
        bool homing = false;
    };

    /// The drive was lost or has restarted.
    void lost() noexcept { *this = {}; }
    void knows(const Values& v) noexcept;
    /// One of VI, VM, A, D was read or is set; another word is none of its business.
    void value(std::string_view word, std::int64_t v) noexcept;
    /// AT and DT are linear and no backlash is made up for (BE = 0): what a trapezoid can follow.
    void shape(bool plain) noexcept { plain_ = plain; }
    /// EE = 1 and the shape is not known: to be asked for.
    [[nodiscard]] bool wants_shape() const noexcept { return values_.encoder && !plain_; }

    /// A line was acknowledged that the drive had at `at`. `own`: this gateway's move or stop, not somebody's text.
    void published(std::string_view line, Instant at, bool own);
    /// Nobody knows whether the drive took this line.
    void doubt(std::string_view line);
    /// What was published last was refused after all.
    void withdraw() noexcept;
    /// A line was refused at once: nothing has changed.
    void refused() noexcept { before_.reset(); }
    /// The drive tells why its motion ended by itself: limit, stop input, fault.
    void ended(Instant now) noexcept;
    /// Nobody knows what it does until it is read as standing.
    void forget() noexcept {
        demand_.forget();
        still_ = false;
    }

    void read(const Reading& r, AxisFeedback& fb) noexcept;

private:
    void order(std::string_view word, std::optional<std::int64_t> number, Instant at, bool own) noexcept;
    [[nodiscard]] DemandRamps ramps() const noexcept;
    [[nodiscard]] bool strange(const Reading& r) const noexcept;
    void judge(const Reading& r) noexcept;

    Demand demand_;
    Values values_;
    std::optional<bool> plain_;
    struct Before {
        Demand demand;
        Values values;
        std::optional<bool> plain;
        bool still = false;
    };
    std::optional<Before> before_;  ///< what was known before the last line
    bool still_ = false;            ///< as last read: energised and at rest
    bool moving_ = false;           ///< as last read: MV
    bool stalled_ = false;          ///< as last read: ST
    bool stall_is_new_ = false;     ///< ST came with the present order
    bool ordered_ = false;          ///< something was published since the last reading
    int strange_ = 0;               ///< readings in a row with a speed that is not this order's
    int way_ = 1;                   ///< sign of the last speed that was read: LL counts lag in that direction
    std::int64_t position_ = 0;     ///< as last read
};

}  // namespace axisgate::mcode
