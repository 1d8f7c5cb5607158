// Control: what all parts of one drive know: the site's words about it, its operating status and error, its axes, who waits for a result.
// In: what the parts learn. Out: judgements on it in words (why an axis cannot move, what has ended a motion), notices, samples.
// Never sends, and never changes an axis.
#pragma once

#include <string>
#include <vector>

#include "adapters/pacontrol/drive_axis.hpp"
#include "gateway/drive/bus.hpp"
#include "gateway/drive/drive_base.hpp"

namespace axisgate::pacontrol {

/// What all of a line have in common.
struct Bus : drive::Bus {
    explicit Bus(const Catalogue& of_family) : drive::Bus(of_family), elements(of_family) {}
    const Elements elements;
    CheckMode check = CheckMode::learn;
    bool strict = false;
};

/// The drive's options of the site (README.md).
struct DriveOptions {
    bool online_auto = true;       ///< online = auto: enable starts ONLINE; manual: it must run already
    bool give_back_auto = true;    ///< give_back = auto: the last disable returns a control that the gateway brought into ONLINE
    bool parameters_wait = false;  ///< when = wait: system and axis parameters wait for home position
    Duration wait_limit = std::chrono::seconds(30);         ///< when_timeout_ms
    Duration processing_limit = std::chrono::seconds(120);  ///< processing_timeout_ms: end of processing must come within
    bool set_by_g26 = false;                                ///< set_position = g26
    bool release = false;                                   ///< reference = release: enable releases an axis without a run (0A83)
    std::vector<int> reference_order;
    std::vector<std::string> faults;  ///< options that could not be read
};
[[nodiscard]] DriveOptions drive_options(const DriveSetup& setup);

/// A command whose end of processing is outstanding: until then the control takes polls and the stops that pass, and nothing else.
struct Processing {
    bool active = false;
    bool foreign = false;    ///< no job waits for it
    bool hidden = false;     ///< a stop of another axis took the poll's answer: the axis' status tells
    bool by_status = false;  ///< the last poll was not answered: the axis' status is asked next
    std::size_t axis = 0;    ///< that moves
    std::size_t owner = 0;   ///< whose job it is: another one when one axis has the others referenced
    std::uint16_t code = 0;
    Instant next_poll{};
    Instant limit = never;
};

struct Control : drive::DriveBase {
    static constexpr int channels = 16;
    static constexpr std::size_t stop_limit = 32;  ///< urgent commands that wait; one more is refused as busy

    Control(Bus& of_line, const DriveSetup& of_site);

    Bus& bus;
    DriveOptions options;
    std::vector<Axis> axes;  ///< by channel - 1; those that the site does not have carry no_axis

    int mode = -1;  ///< operating status [L3991-L4019]; -1: not known
    std::uint16_t error = 0;
    Instant trouble_at{};        ///< since when an error or a malfunction is shown: statuses from before do not tell whose it is
    bool started_by_us = false;  ///< this gateway brought it into ONLINE
    bool leaving = false;        ///< this gateway has ordered it to leave
    bool give_back_due = false;
    bool system_flags_missing = false;
    bool stop_axis_missing = false;  ///< 0A9A is unknown (13h): 0A93 stops one axis
    Instant busy_until{};            ///< the operating mode was changed: until then 15h may only mean "not yet"
    Instant parameters_at{};         ///< not before: the control has just refused to tell them
    Processing processing;
    std::uint64_t exchanges = 0;
    bool wake = false;  ///< something changed that a waiting job may want to see

    [[nodiscard]] Axis* axis_of(AxisId id) noexcept;
    /// Everything that may have changed while nobody listened.
    void forget();
    void begin_processing(std::size_t axis, std::uint16_t code, bool foreign, Instant now);

    void sample(const Axis& a, Point point, const Value& value, Turn& t) const;

    [[nodiscard]] bool in_trouble() const noexcept { return error != 0 || is_malfunction(mode); }
    /// The axis whose malfunction it is (1910, 1921); nothing: nobody's, or not read yet.
    [[nodiscard]] const Axis* culprit() const noexcept;
    [[nodiscard]] bool fault_of_all(Instant now) const noexcept;
    [[nodiscard]] std::string mode_text() const;  ///< "operating status 31 (ONLINE)"
    [[nodiscard]] std::string error_text() const;
    /// Why the control has ended what `a` was doing, as far as its status and its error tell; empty: they tell nothing.
    [[nodiscard]] std::string what_ended(const Axis& a) const;
    [[nodiscard]] std::string why_not_online() const;
    [[nodiscard]] std::string why_not_movable(const Axis& a) const;
    [[nodiscard]] bool powered_at_home(const Axis& a) const noexcept;
    [[nodiscard]] bool parameters_readable(Instant now) const noexcept { return is_home(mode) && now >= parameters_at; }
};

}  // namespace axisgate::pacontrol
