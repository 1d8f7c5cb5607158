// The laws that every specimen of every family keeps, as functions of one subject: a drive that is late, that lacks a part or is weak is
// served with what it has, what it lacks is said, and what was accepted is made or is told as not made. The judge is the twin's mechanics.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "gateway/core/specimen.hpp"
#include "gateway/doors/enip/words.hpp"
#include "tests/world/world.hpp"

namespace axisgate::test {

/// The longest time by which a drive of these values may be late: all of its delays together.
[[nodiscard]] Duration slowness_of(const Catalogue& family, const FreedomValues& values);
/// Sets the reply time-out of the site's first line as a person sets it for a drive that answers so late.
void fit_line(Site& wanted, const FreedomValues& values);
/// The family's facts.json has drives of these values as such that no gateway can serve, and an event says why.
[[nodiscard]] bool told_as_not_served(const Subject& subject, const FreedomValues& values, const std::vector<Event>& events);

class SpecimenDay {
public:
    explicit SpecimenDay(const Subject& subject) : e(subject) {}

    void is_found_and_stays_served();
    void a_motion_is_made_or_told_as_not_made();
    void an_accepted_motion_begins_within_its_bound();
    void a_stop_ends_each_motion();
    void a_stream_begins_where_the_axis_is();
    void the_next_gateway_finds_it();

private:
    Subject e;
    FreedomValues values = specimen_values(*e.catalogue, e.specimen);
    std::shared_ptr<Plant> plant = std::make_shared<Plant>();
    std::unique_ptr<World> world = std::make_unique<World>(1, plant);
    std::shared_ptr<const SiteState> site;
    AxisId axis = no_axis;
    bool behind_a_cable = false;

    [[nodiscard]] AxisPicture now() const { return world->picture(axis); }
    [[nodiscard]] bool online() const { return (now().flags & flag_online) && now().ever_seen; }
    [[nodiscard]] bool moving() const { return (now().flags & flag_moving) != 0; }
    [[nodiscard]] TwinMechanics shaft() const;
    [[nodiscard]] double speed() const { return std::fabs(shaft().velocity); }
    [[nodiscard]] Duration slowness() const { return slowness_of(*e.catalogue, values); }
    /// How far a shaft of this specimen may be from its target at rest, increments.
    [[nodiscard]] double looseness() const;
    /// The drive and the last events, for people.
    [[nodiscard]] std::string in_words() const;

    void gateway(std::uint64_t seed, Duration after);
    [[nodiscard]] bool found();
    [[nodiscard]] bool refused_with_reason() const { return told_as_not_served(e, values, world->events); }
    /// The answer to a Disable: the drive is off, or the answer says that it keeps its power and the axis is still shown as enabled.
    [[nodiscard]] bool off_or_told(const Result& disabled) const;
    [[nodiscard]] bool served();
    [[nodiscard]] bool powered();
    [[nodiscard]] bool rests(Duration limit);
    const Result* ask(CommandBody body, bool until_done, Duration limit);
    /// Asks as a person does: an order that is refused is repeated a few times, after the action that the answer names, or a pause. One
    /// whose outcome is not known is repeated only if it is an Enable.
    const Result* ask_with_remedy(const CommandBody& body, Duration limit, bool until_done = true);
    [[nodiscard]] static Move to(std::int64_t target, Move::Kind kind);
    /// The same with ramps that the motor of this specimen can follow, where the law is not about its strength.
    [[nodiscard]] Move gently(std::int64_t target, Move::Kind kind) const;
    [[nodiscard]] std::int64_t gentle_ramp() const;
    /// Since the last order, a motor that lacks force has ended its motion with the drive's own fault, or another master has stopped the
    /// drive, which has lost its power by that. Both are shown and told.
    [[nodiscard]] bool gave_up() const;
    void told_as_not_done(const Result& r);
    void stops_and_serves();

    std::size_t told_before_ = 0;  ///< number of events before the last order
};

}  // namespace axisgate::test
