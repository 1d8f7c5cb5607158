// The list of alarms in the terms of ISA-18.2: active alarms, and cleared ones that nobody has acknowledged. A pure state machine: events,
// acknowledgements, shelving, the site and the time are arguments; the owner stores the changes. Bound: 1000 alarms. At the bound the alarm
// that was cleared first is removed; if none is cleared, the new one is dropped and counted.
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

/// One alarm: the combination of axis, drive or line, code and kind is one alarm, however often it occurs.
struct Alarm {
    std::uint64_t id = 0;           ///< the id of the event that raised it first; never used twice
    std::string axis, drive, line;  ///< empty if not applicable
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
    std::uint64_t count = 1;  ///< number of occurrences
    std::int64_t doubtful_until_unix_ns =
        0;  ///< another side serves the drive: if it does not occur again until then, it is cleared; 0: not in doubt

    [[nodiscard]] AlarmState state() const noexcept;
};

/// The filters of the list; an alarm may match several. `unacknowledged` matches the number of the same name, which does not include
/// shelved alarms.
enum class AlarmFilter : std::uint8_t { active, cleared, unacknowledged, acknowledged, shelved };
inline constexpr std::string_view alarm_filter_words = "active, cleared, unacknowledged, acknowledged or shelved";
[[nodiscard]] std::optional<AlarmFilter> alarm_filter_named(std::string_view word) noexcept;
[[nodiscard]] bool fits(const Alarm& alarm, AlarmFilter filter) noexcept;

class AlarmList {
public:
    static constexpr std::size_t most_alarms = 1000;
    static constexpr std::int64_t least_shelf_s = 60;
    static constexpr std::int64_t most_shelf_s = 86400;
    /// After a change of the serving side, or the start of the gateway, a fault that still exists occurs again within this time.
    static constexpr std::int64_t settle_ns = 10'000'000'000;

    /// Reports of an axis within this time before or after its fault belong to the fault: one alarm contains both.
    static constexpr std::int64_t together_ns = 2'000'000'000;

    /// Restores a stored alarm; this does not count as a change.
    void restore(Alarm alarm);
    /// Returns true if something changed.
    bool on_event(const Event& event);
    /// The gateway has started: alarms of drives and lines must occur again, as after a change of the serving side.
    void on_start(std::int64_t now_unix_ns);
    /// Clears the alarms of objects that are no longer in the site.
    bool on_site(const Site& site, std::int64_t now_unix_ns);
    /// Ends shelves and doubts whose time has passed.
    bool on_time(std::int64_t now_unix_ns);
    /// When on_time must be called; empty if nothing is waiting.
    [[nodiscard]] std::optional<std::int64_t> deadline() const;

    /// Each returns an empty text, or the reason for a refusal. An acknowledged alarm that is cleared leaves the list.
    [[nodiscard]] std::string acknowledge(std::uint64_t id, std::string who, std::string comment, std::int64_t now_unix_ns);
    [[nodiscard]] std::string shelve(std::uint64_t id, std::int64_t for_s, std::string who, std::string reason, std::int64_t now_unix_ns);
    [[nodiscard]] std::string unshelve(std::uint64_t id);

    [[nodiscard]] const std::map<std::uint64_t, Alarm>& all() const noexcept { return alarms_; }
    [[nodiscard]] const Alarm* find(std::uint64_t id) const;
    [[nodiscard]] std::size_t unacknowledged() const;  ///< the number of those that are not shelved
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
    /// Ids that have changed or been removed since the last call.
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
