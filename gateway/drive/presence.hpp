// Presence knows whether one drive answers: it controls the search for the drive, its loss, and the pauses between probes, which grow up to
// pause_max. It never sends and never answers commands: its caller ends the waiting commands when it reports the loss (Tickets::fail_all).
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
        probing,   ///< not known yet whether the drive is present: probes follow one another until `silent_limit`
        absent,    ///< the drive does not answer: one probe after each pause, which doubles from pause_min to pause_max
        starting,  ///< the drive answered; the values that commands need are being read
        ready,
        restarting  ///< the drive was ordered to restart: no request until its time is over, then probes
    };
    enum class Silence : std::uint8_t {
        counted,      ///< counted; the phase has not changed
        lost,         ///< the drive has become absent
        still_absent  ///< the drive is still absent; the next pause has begun
    };

    /// `timing` must outlive this object, and may change between two calls.
    Presence(DriveId drive, const Timing& timing) noexcept : drive_(drive), timing_(&timing) {}

    // --- events -----------------------------------------------------------------------------------------------------------
    /// The line is up, or the drive is to be searched for again: the first probe is due at once.
    void begin(Instant now) noexcept;
    /// The line is down, or the drive was removed.
    void close() noexcept;
    /// A probe was sent: the next one is due when it was answered or has timed out.
    void probe_sent() noexcept;
    /// The drive has answered, with any content: the count of time-outs begins again.
    void answered() noexcept { silent_ = 0; }
    /// A drive of this family has answered a probe.
    void found() noexcept;
    /// All values that commands need are known.
    void made_ready() noexcept { phase_ = Phase::ready; }
    /// An exchange has timed out after all its repetitions.
    [[nodiscard]] Silence silent(Instant now) noexcept;
    /// The drive counts as absent for another reason (it belongs to another family, or refuses all requests). `pause` 0: pause_min.
    void lose(Instant now, Duration pause = {}) noexcept;
    /// An unrequested message arrived from the drive: the next probe is sent at once.
    void received(Instant now) noexcept;
    /// The drive was ordered to restart and will not answer for `time`.
    void restart(Instant now, Duration time) noexcept;

    // --- state ------------------------------------------------------------------------------------------------------------
    [[nodiscard]] Phase phase() const noexcept { return phase_; }
    [[nodiscard]] bool is(Phase phase) const noexcept { return phase_ == phase; }
    /// True if the drive has answered and has not been lost since.
    [[nodiscard]] bool online() const noexcept {
        return phase_ == Phase::starting || phase_ == Phase::ready || phase_ == Phase::restarting;
    }
    [[nodiscard]] bool ever_found() const noexcept { return ever_found_; }
    [[nodiscard]] std::uint32_t silences() const noexcept { return silent_; }
    [[nodiscard]] Duration retry_pause() const noexcept { return retry_pause_; }
    /// Time of the next probe; `never` while one is outstanding or none is needed.
    [[nodiscard]] Instant deadline() const noexcept { return next_probe_; }
    [[nodiscard]] bool probe_due(Instant now) const noexcept { return now >= next_probe_; }

    /// The setting of the drive's own watchdog, for the next link report.
    void watched(DriveWatchdog watchdog) { watchdog_ = std::move(watchdog); }
    [[nodiscard]] const DriveWatchdog& watchdog() const noexcept { return watchdog_; }
    /// How the drive has taken over the site's limits, for the next link report.
    void limited(DriveLimits limits) { limits_ = std::move(limits); }
    /// As above; reported at once if a link was reported before.
    void limited(DriveLimits limits, Out& out);
    [[nodiscard]] const DriveLimits& limits() const noexcept { return limits_; }
    /// The intervals at which the drive reports; reported at once if a link was reported before.
    void beats(DriveBeats beats, Out& out);
    /// Reports whether the drive is online, and why, unless the last report was the same.
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
