// Watches the true mechanics of the drives behind the cables, independent of the wire, and knows the orders of each. The test fails if a
// shaft moves without an order, does not rest after an acknowledged stop, leaves its limits, or has power without an enable. Drives are
// never changed.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tests/world/world.hpp"

namespace axisgate::test {

class Witness {
public:
    /// Returns the number of the shaft for the calls below. It must be at rest.
    std::size_t watch(std::string name, TwinBus& bus, DriveId key, int channel, Instant now) {
        Shaft& s = shafts_.emplace_back();
        s.name = std::move(name);
        s.bus = &bus;
        s.key = key;
        s.channel = channel;
        const TwinMechanics m = mechanics(s, now);
        s.place = m.position;
        s.starts_with_power = m.powered;
        if (m.powered) s.off_from = never;
        return shafts_.size() - 1;
    }
    void limit(std::size_t n, double most) { shafts_[n].limit = most; }
    void lift_limit(std::size_t n) { shafts_[n].limit.reset(); }

    void motion_ordered(std::size_t n) {
        Shaft& s = shafts_[n];
        ++s.motions;
        s.rest_from = never;
    }
    void power_ordered(std::size_t n) { ++shafts_[n].powers, shafts_[n].off_from = never; }
    /// The number of motions when a stop was given, for stopped() and switched_off().
    [[nodiscard]] std::uint64_t motions(std::size_t n) const { return shafts_[n].motions; }
    [[nodiscard]] std::uint64_t powers(std::size_t n) const { return shafts_[n].powers; }
    /// A stop was acknowledged that was given when `motions` had been ordered: from `by` on the shaft rests until the next order.
    void stopped(std::size_t n, std::uint64_t motions, Instant by) {
        Shaft& s = shafts_[n];
        if (s.motions != motions || s.rest_from <= by) return;
        s.rest_from = by;
        s.place.reset();
    }
    /// A disable was answered as good: from `by` on it has no power until the next order. A drive that starts with power has it until then,
    /// and again after its supply has failed (PA-CONTROL's enable mode 1 [L722]).
    void switched_off(std::size_t n, std::uint64_t powers, Instant by) {
        Shaft& s = shafts_[n];
        if (s.powers == powers) s.off_from = std::min(s.off_from, by);
    }
    /// Its supply fails or returns, and its counter may begin anew.
    void power_cycled(std::size_t n) {
        shafts_[n].place.reset();
        if (shafts_[n].starts_with_power) shafts_[n].off_from = never;
    }

    [[nodiscard]] double speed(std::size_t n, Instant now) const { return std::fabs(mechanics(shafts_[n], now).velocity); }

    /// May be called at any rate; one fault is reported once.
    void look(Instant now) {
        for (Shaft& s : shafts_) {
            if (s.published) continue;
            const TwinMechanics m = mechanics(s, now);
            if (s.limit && std::fabs(m.position) > *s.limit) tell(s, "is beyond the limit of its axis", m);
            if (m.powered && now >= s.off_from) tell(s, "has power that nobody gave it", m);
            if (now < s.rest_from) continue;
            if (m.velocity != 0) tell(s, "moves, and no order stands", m);
            if (!s.place) s.place = m.position;
            if (std::fabs(m.position - *s.place) > 1e-6) tell(s, "has moved, and no order stood", m);
        }
    }

private:
    struct Shaft {
        std::string name;
        TwinBus* bus = nullptr;
        DriveId key = no_drive;
        int channel = 1;
        std::uint64_t motions = 0, powers = 0;
        Instant rest_from{};  // from here on it rests; never: an order is in force
        Instant off_from{};
        std::optional<double> place;  // its rest position
        std::optional<double> limit;
        bool starts_with_power = false;  // as some drives do; others need an enable
        bool published = false;
    };
    static TwinMechanics mechanics(const Shaft& s, Instant now) {
        const Twin* t = s.bus->twin(s.key);
        return t ? t->mechanics(s.channel, now) : TwinMechanics{};
    }
    static void tell(Shaft& s, const char* what, const TwinMechanics& m) {
        s.published = true;
        ADD_FAILURE() << "the shaft of " << s.name << " " << what << ": at " << m.position << ", speed " << m.velocity
                      << (m.powered ? ", with" : ", without") << " power";
    }

    std::vector<Shaft> shafts_;
};

}  // namespace axisgate::test
