// Ways in: everything by which an axis can be set in motion, each with the client that stands behind it: how it prepares the axis, sets it
// off, goes on as such a client does (a PLC repeats its words, a stream renews its set-points), falls silent or leaves, and comes back.
// In: a world whose site has the way. Out: orders through the same doors and calls that the program uses. Never names a family: what a
// drive's own language says stands in adapters/<family>/tests/facts.json.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/conformance/doors.hpp"

namespace axisgate::test {

/// What a way in stands on: one gateway with one axis, from the doors down.
struct Bench {
    Bench(const Subject& subject, std::uint64_t seed, std::shared_ptr<Plant> plant);
    /// The site is in force: the doors learn of it.
    void use(std::shared_ptr<const SiteState> in_force);
    /// Runs until the condition holds, and hands results to the doors meanwhile.
    bool until(const std::function<bool()>& condition, Duration limit);
    void run(Duration time);
    /// A client's command; its ticket.
    Ticket give(CommandBody body, const Origin& by);
    /// Gives it and waits for its answer.
    const Result* ask(CommandBody body, const Origin& by, Duration limit = std::chrono::seconds(20));
    /// The state that the status word shows, as CiA 402 has it.
    [[nodiscard]] PowerState state() const { return power_state_of(picture().statusword); }
    /// What its client does in each cycle goes on while time passes here.
    std::function<void()> meanwhile;
    [[nodiscard]] AxisPicture picture() const { return world.picture(axis); }
    [[nodiscard]] bool moving() const { return (picture().flags & flag_moving) != 0; }
    [[nodiscard]] bool enabled() const { return power_state_of(picture().statusword) == PowerState::operation_enabled; }

    const Subject& subject;
    World world;
    WorldDoors port{world};
    std::unique_ptr<registers::RegisterImage> image;
    std::unique_ptr<WriterDoor> modbus;
    std::unique_ptr<EnipDoor> enip;
    std::shared_ptr<const SiteState> site;
    AxisId axis = no_axis;
    std::uint64_t tickets = 1;
};

/// What adapters/<family>/tests/facts.json says of motions in the drive's own language.
[[nodiscard]] const boost::json::object& facts_of(const Subject& subject);

class Way {
public:
    virtual ~Way() = default;
    static constexpr std::int64_t speed = 4000, ramp = 20'000, far = 300'000;

    /// The drive or the language cannot do that; then an order by it is refused in words and nothing moves. `why`: what it lacks.
    [[nodiscard]] virtual bool offered(const Subject&, std::string& why) const { return (void)why, true; }
    /// What the site needs so that this way is there.
    virtual void fit(Site&, const Subject&) const {}
    /// A motion that it begins has no end of its own.
    [[nodiscard]] virtual bool endless() const { return true; }
    /// Its motion begins at the drive, or was there first: no client of this gateway owns it.
    [[nodiscard]] virtual bool unowned() const { return false; }
    /// The causes by which its client can be lost; each of them is tried.
    [[nodiscard]] virtual std::vector<LossCause> losses() const = 0;
    [[nodiscard]] virtual const Origin& origin() const = 0;

    /// Power, mode and ramps, by its own words, so that set_off() is one message. False: the drive did not follow.
    [[nodiscard]] virtual bool prepare(Bench&) = 0;
    /// The message that begins the motion in positive direction. Its answer is not waited for.
    virtual void set_off(Bench&) = 0;
    /// The same to another speed or place, as the way names it.
    virtual void set_off_to(Bench&, std::int64_t target) = 0;
    /// Targets at the ends of numbers, as set_off_to() takes them.
    [[nodiscard]] virtual std::vector<std::int64_t> ends(const Subject&) const { return {INT32_MAX, INT32_MIN, INT32_MIN + 1}; }
    /// set_off_to() takes a speed, at which the axis goes on without another word.
    [[nodiscard]] virtual bool takes_speeds() const { return false; }
    /// What its client says in each of its cycles while nothing changes.
    virtual void cycle(Bench&) {}
    /// The client is lost in this way; from now on it says nothing.
    virtual void lose(Bench&, LossCause) = 0;
    /// What was not taken, if its client was told; empty: it was taken, or nothing was asked.
    [[nodiscard]] virtual std::string refusal(const Bench&) const { return {}; }
    /// Its gateway was killed, and the next one is there: its client connects again, with the words that it had.
    virtual void returned(Bench&) {}
    /// A fresh edge of its own words, after a stop: prepares again and sets off.
    [[nodiscard]] virtual bool again(Bench& b) {
        if (!prepare(b)) return false;
        set_off(b);
        return true;
    }
    bool silent = false;  ///< it was lost
};

struct WayKind {
    std::string_view name;
    std::string_view of_door;  ///< as gateway/site/ways_in.hpp calls the way; empty: it is no door's
    std::unique_ptr<Way> (*make)();
};
/// All of them.
[[nodiscard]] const std::vector<WayKind>& ways_in();

}  // namespace axisgate::test
