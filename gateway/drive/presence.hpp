// Presence: whether one drive answers: looking for it, losing it, asking again after growing pauses.
// In: answers and silences of its exchanges, the passing of time. Out: its phase, when the next probe is due, DriveLinks on each change.
// Never sends, and never answers commands: who is told that the drive was lost ends what waits for it (Tickets::fail_all).
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "gateway/core/adapter.hpp"
#include "gateway/drive/timing.hpp"

namespace axisgate::drive {

class Presence {
public:
    enum class Phase : std::uint8_t {
        down,      ///< the line is down
        probing,   ///< nobody knows yet whether it is there: probes follow one another until `silent_limit`
        absent,    ///< it does not answer: a probe after each pause, which doubles from pause_min to pause_max
        starting,  ///< it answered; what commands rest on is being read
        ready,
        restarting  ///< it was told to restart: left alone until its time is over, then probed
    };
    enum class Silence : std::uint8_t {
        counted,      ///< no more is known by that
        lost,         ///< it has become absent just now
        still_absent  ///< and the next pause has begun
    };

    /// `timing` outlives this, and may change between two calls.
    Presence(DriveId drive, const Timing& timing) noexcept : drive_(drive), timing_(&timing) {}

    // --- what happens -----------------------------------------------------------------------------------------------------
    /// The line is up, or the drive is to be looked for anew: the first probe is due at once.
    void begin(Instant now) noexcept;
    /// The line is down, or the drive is removed.
    void close() noexcept;
    /// A probe has gone out: none is due until it is answered or not.
    void probe_sent() noexcept;
    /// It has answered, whatever it said: silences are counted anew.
    void answered() noexcept { silent_ = 0; }
    /// A probe was answered by a drive of this family.
    void found() noexcept;
    /// Everything is known that commands rest on.
    void made_ready() noexcept { phase_ = Phase::ready; }
    /// An exchange has had no answer, however often it was sent.
    [[nodiscard]] Silence silent(Instant now) noexcept;
    /// It counts as absent for another reason (it is no drive of this family; it refuses everything). `pause` 0: pause_min.
    void lose(Instant now, Duration pause = {}) noexcept;
    /// Something came from it that nobody had asked for: who is looked for is asked at once.
    void received(Instant now) noexcept;
    /// It was told to restart, and will not answer for `time`.
    void restart(Instant now, Duration time) noexcept;

    // --- what is known ----------------------------------------------------------------------------------------------------
    [[nodiscard]] Phase phase() const noexcept { return phase_; }
    [[nodiscard]] bool is(Phase phase) const noexcept { return phase_ == phase; }
    /// It has answered, and has not been lost since.
    [[nodiscard]] bool online() const noexcept {
        return phase_ == Phase::starting || phase_ == Phase::ready || phase_ == Phase::restarting;
    }
    [[nodiscard]] bool ever_found() const noexcept { return ever_found_; }
    [[nodiscard]] std::uint32_t silences() const noexcept { return silent_; }
    [[nodiscard]] Duration retry_pause() const noexcept { return retry_pause_; }
    /// Of the next probe; `never` while one is out, or none is wanted.
    [[nodiscard]] Instant deadline() const noexcept { return next_probe_; }
    [[nodiscard]] bool probe_due(Instant now) const noexcept { return now >= next_probe_; }

    /// What its own watchdog was programmed to; said with the next report.
    void watched(DriveWatchdog watchdog) { watchdog_ = std::move(watchdog); }
    [[nodiscard]] const DriveWatchdog& watchdog() const noexcept { return watchdog_; }
    /// What became of the site's limits in the drive; said with the next report.
    void limited(DriveLimits limits) { limits_ = std::move(limits); }
    /// The same, said at once if the drive has been spoken of.
    void limited(DriveLimits limits, Out& out);
    [[nodiscard]] const DriveLimits& limits() const noexcept { return limits_; }
    /// The beats in which it tells; said at once if it has been spoken of.
    void beats(DriveBeats beats, Out& out);
    /// Says whether it is online, and why, unless exactly that was said last.
    void report(std::string text, Out& out);

private:
    DriveId drive_;
    const Timing* timing_;
    Phase phase_ = Phase::down;
    bool ever_found_ = false;
    std::uint32_t silent_ = 0;
    Duration retry_pause_{};
    Instant next_probe_ = never;
    DriveLink reported_;
    DriveWatchdog watchdog_;
    DriveLimits limits_;
    DriveBeats beats_;
};

}  // namespace axisgate::drive
