// Every way in which an axis can be set in motion, each with its client: how it prepares the axis, starts the motion, continues as such a
// client does (a PLC repeats its words, a stream renews its set-points), falls silent or leaves, and returns. Orders go through the same
// doors and calls that the program uses. Statements in a drive's own language are in adapters/<family>/tests/facts.json.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/conformance/doors.hpp"

namespace axisgate::test {

/// The base of a way: one gateway with one axis, including the doors.
struct Bench {
    Bench(const Subject& subject, std::uint64_t seed, std::shared_ptr<Plant> plant);
    /// A site is in force; the doors are informed.
    void use(std::shared_ptr<const SiteState> in_force);
    /// Runs until the condition is true, and delivers results to the doors meanwhile.
    bool until(const std::function<bool()>& condition, Duration limit);
    void run(Duration time);
    /// Gives a client's command; returns its ticket.
    Ticket give(CommandBody body, const Origin& by);
    /// Gives it and waits for its answer.
    const Result* ask(CommandBody body, const Origin& by, Duration limit = std::chrono::seconds(20));
    /// The CiA 402 state in the status word.
    [[nodiscard]] PowerState state() const { return power_state_of(picture().statusword); }
    /// The client's cycle, which continues while time passes here.
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

/// The motions in the drive's own language, from adapters/<family>/tests/facts.json.
[[nodiscard]] const boost::json::object& facts_of(const Subject& subject);

class Way {
public:
    virtual ~Way() = default;
    static constexpr std::int64_t speed = 4000, ramp = 20'000, far = 300'000;

    /// Returns false if the drive or the language lacks this way; an order is then refused with a text and nothing moves. `why` names what
    /// is missing.
    [[nodiscard]] virtual bool offered(const Subject&, std::string& why) const { return (void)why, true; }
    /// Adds the entries of the site that this way needs.
    virtual void fit(Site&, const Subject&) const {}
    /// A motion that it begins has no end of its own.
    [[nodiscard]] virtual bool endless() const { return true; }
    /// Its motion begins at the drive, or existed before: no client of this gateway owns it.
    [[nodiscard]] virtual bool unowned() const { return false; }
    /// The causes by which its client can be lost; each of them is tried.
    [[nodiscard]] virtual std::vector<LossCause> losses() const = 0;
    [[nodiscard]] virtual const Origin& origin() const = 0;

    /// Sets power, mode and ramps by its own words, so that set_off() is one message. Returns false if the drive did not follow.
    [[nodiscard]] virtual bool prepare(Bench&) = 0;
    /// Sends the message that begins the motion in positive direction, without waiting for its answer.
    virtual void set_off(Bench&) = 0;
    /// The same to another speed or position, as the way names it.
    virtual void set_off_to(Bench&, std::int64_t target) = 0;
    /// Extreme targets, as set_off_to() takes them.
    [[nodiscard]] virtual std::vector<std::int64_t> ends(const Subject&) const { return {INT32_MAX, INT32_MIN, INT32_MIN + 1}; }
    /// set_off_to() takes a speed, at which the axis continues without another word.
    [[nodiscard]] virtual bool takes_speeds() const { return false; }
    /// The client's action in each of its cycles while nothing changes.
    virtual void cycle(Bench&) {}
    /// Loses the client in this way; from now on it sends nothing.
    virtual void lose(Bench&, LossCause) = 0;
    /// The reason of a refusal, if the client got one; empty: the request was accepted, or there was none.
    [[nodiscard]] virtual std::string refusal(const Bench&) const { return {}; }
    /// Its gateway was killed, and the next one is running: its client connects again, with its former words.
    virtual void returned(Bench&) {}
    /// A fresh edge of its own words after a stop: prepares again and starts.
    [[nodiscard]] virtual bool again(Bench& b) {
        if (!prepare(b)) return false;
        set_off(b);
        return true;
    }
    bool silent = false;  ///< the client was lost
};

struct WayKind {
    std::string_view name;
    std::string_view of_door;  ///< the name of the way in gateway/site/ways_in.hpp; empty: it belongs to no door
    std::unique_ptr<Way> (*make)();
};
/// All of them.
[[nodiscard]] const std::vector<WayKind>& ways_in();

}  // namespace axisgate::test
