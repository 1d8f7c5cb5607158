// The doors of a program outside at a gateway in virtual time, by their numbers. A door detaches itself before its end.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "gateway/engine/door.hpp"

namespace axisgate {

class RehearsalDoors {
public:
    [[nodiscard]] DoorNumber attach(HotDoor& door) {
        doors_.push_back(&door);
        return static_cast<DoorNumber>(doors_.size());
    }
    void detach(HotDoor& door) { std::ranges::replace(doors_, &door, nullptr); }

    /// All doors take over the site.
    void on_site(const SiteState& site) {
        for (HotDoor* door : doors_)
            if (door) door->on_site(site);
    }
    void on_sample(const Sample& sample) {
        for (HotDoor* door : doors_)
            if (door) door->on_sample(sample);
    }
    /// False if the ticket is none of a door.
    [[nodiscard]] bool on_result(const Result& result) {
        const DoorNumber number = door_of(result.ticket);
        if (number == 0 || number > doors_.size()) return false;
        if (HotDoor* door = doors_[number - 1u]) door->on_result(result);
        return true;
    }
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient& who) const {
        std::optional<Instant> newest;
        for (const HotDoor* door : doors_) {
            const auto at = door ? door->last_received(who) : std::nullopt;
            if (at && (!newest || *at > *newest)) newest = at;
        }
        return newest;
    }

private:
    std::vector<HotDoor*> doors_;  // by number - 1; nullptr: detached
};

}  // namespace axisgate
