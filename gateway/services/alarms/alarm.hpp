// Alarms: what is wrong or has been wrong and nobody has seen yet, in the words of ISA-18.2. A pure state machine.
// In: events, acknowledgements, shelving, the site's names, time as an argument. Out: the current list, what changed, the next deadline.
// Bounds: 1000 alarms. At the bound the alarm that was cleared first goes; if none is cleared the new one is dropped and counted.
// Never has a clock, a store or a door: whoever owns it hands in time and keeps what changed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/core/event.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

enum class AlarmState : std::uint8_t { unacknowledged_active, acknowledged_active, unacknowledged_cleared, shelved };
[[nodiscard]] std::string_view name_of(AlarmState state) noexcept;

/// One alarm: the same (axis, drive or line, code, kind) is one alarm however often it comes.
struct Alarm {
    std::uint64_t id = 0;           ///< of the event that raised it first; never given twice
    std::string axis, drive, line;  ///< empty where they do not apply
    std::string kind;
    std::int32_t code = 0;  ///< the drive's own, 0 if none
    std::string text;       ///< of the newest occurrence
    Severity severity = Severity::alarm;
    bool active = true;
    bool acknowledged = false;
    std::int64_t since_unix_ns = 0;          ///< of the newest occurrence after it had been cleared
    std::int64_t cleared_unix_ns = 0;        ///< 0: active
    std::string acknowledged_by, comment;    ///< of the last acknowledgement
    std::int64_t acknowledged_unix_ns = 0;   ///< 0: not acknowledged
    std::int64_t shelved_until_unix_ns = 0;  ///< 0: not shelved
    std::string shelved_by, reason;
    std::uint64_t count = 1;  ///< how often it came
    std::int64_t doubtful_until_unix_ns =
        0;  ///< another one serves the drive: if it does not come again until then, it is cleared; 0: sure

    [[nodiscard]] AlarmState state() const noexcept;
};

/// What a list of alarms can be narrowed to; an alarm may fit several. `unacknowledged` is what is counted: shelved ones are not.
enum class AlarmFilter : std::uint8_t { active, cleared, unacknowledged, acknowledged, shelved };
inline constexpr std::string_view alarm_filter_words = "active, cleared, unacknowledged, acknowledged or shelved";
[[nodiscard]] std::optional<AlarmFilter> alarm_filter_named(std::string_view word) noexcept;
[[nodiscard]] bool fits(const Alarm& alarm, AlarmFilter filter) noexcept;

class AlarmList {
public:
    static constexpr std::size_t most_alarms = 1000;
    static constexpr std::int64_t least_shelf_s = 60;
    static constexpr std::int64_t most_shelf_s = 86400;
    /// After a drive is served by another (or the gateway has started) a fault that it still has shows within this time.
    static constexpr std::int64_t settle_ns = 10'000'000'000;

    /// What an axis tells so shortly before or after its fault belongs to it: one alarm, which says both.
    static constexpr std::int64_t together_ns = 2'000'000'000;

    /// An alarm as it was kept; not a change.
    void restore(Alarm alarm);
    /// True: something changed.
    bool on_event(const Event& event);
    /// The gateway has started: what the drives and lines had before must show again, as after a change of who serves.
    void on_start(std::int64_t now_unix_ns);
    /// What is no longer in the site is cleared.
    bool on_site(const Site& site, std::int64_t now_unix_ns);
    /// Shelves and doubts that have come to their end.
    bool on_time(std::int64_t now_unix_ns);
    /// When on_time wants to be called; nothing: nothing waits.
    [[nodiscard]] std::optional<std::int64_t> deadline() const;

    /// Each: empty, or why not. Acknowledging what is cleared takes it off the list.
    [[nodiscard]] std::string acknowledge(std::uint64_t id, std::string who, std::string comment, std::int64_t now_unix_ns);
    [[nodiscard]] std::string shelve(std::uint64_t id, std::int64_t for_s, std::string who, std::string reason, std::int64_t now_unix_ns);
    [[nodiscard]] std::string unshelve(std::uint64_t id);

    [[nodiscard]] const std::map<std::uint64_t, Alarm>& all() const noexcept { return alarms_; }
    [[nodiscard]] const Alarm* find(std::uint64_t id) const;
    [[nodiscard]] std::size_t unacknowledged() const;  ///< those that are not shelved
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
    /// Ids that have changed or gone since the last call.
    [[nodiscard]] std::set<std::uint64_t> take_changed() { return std::exchange(changed_, {}); }

private:
    void raise(const Event& event, bool momentary);
    void clear(Alarm& alarm, std::int64_t now_unix_ns);
    void settle(std::uint64_t id);
    [[nodiscard]] bool joins_fault(const Event& event);
    [[nodiscard]] std::string take_forerunners(const Event& fault);
    [[nodiscard]] bool fault_active(const std::string& axis) const;

    std::map<std::uint64_t, Alarm> alarms_;
    std::set<std::uint64_t> changed_;
    std::uint64_t dropped_ = 0;
};

}  // namespace axisgate
