// The registered doors, by their numbers.
#include "gateway/site/ways_in.hpp"

#include <fmt/core.h>

#include <atomic>

#include "gateway/core/door_names.hpp"

namespace axisgate {
namespace {
std::array<std::atomic<const DoorWords*>, 256> brought{};
}  // namespace

const DoorWords* words_of(Door door) noexcept { return brought[static_cast<std::size_t>(door)].load(std::memory_order_acquire); }

std::vector<const DoorWords*> known_doors() {
    std::vector<const DoorWords*> known;
    for (const auto& place : brought) {
        if (const DoorWords* words = place.load(std::memory_order_acquire)) known.push_back(words);
    }
    return known;
}

std::string bring(const DoorWords& words) {
    if (words_of(words.door) == &words) return {};
    if (!law::each_way_has_a_loss(words))
        return fmt::format("the door {}: each way in needs a name, this door's number and a loss that ends it", words.name);
    if (!law::each_loss_has_a_teller(words)) return fmt::format("the door {}: a cause of loss ends none of its ways in", words.name);
    for (const LossWords& loss : words.losses) {
        if (std::string fault = name_loss(loss); !fault.empty()) return fmt::format("the door {}: {}", words.name, fault);
    }
    for (const WayIn& way : words.ways) {
        for (const LossCause cause : way.losses) {
            if (!words_of(cause)) return fmt::format("the door {}: no words for cause {}", words.name, static_cast<int>(cause));
        }
    }
    for (const LossCause cause : {words.silence, words.unrenewed}) {
        if (cause != LossCause::none && !words_of(cause))
            return fmt::format("the door {}: no words for cause {}", words.name, static_cast<int>(cause));
    }
    if (std::string fault = name_door(words.door, words.name); !fault.empty()) return fault;
    brought[static_cast<std::size_t>(words.door)].store(&words, std::memory_order_release);
    return {};
}

Door door_that_tells(LossCause cause) {
    for (const DoorWords* door : known_doors()) {
        if (std::ranges::any_of(door->ways, [&](const WayIn& way) { return tells(way, cause); })) return door->door;
    }
    return Door::none;
}

bool of_streams_alone(LossCause cause) {
    bool streams = false;
    for (const DoorWords* door : known_doors()) {
        for (const WayIn& way : door->ways) {
            if (!tells(way, cause)) continue;
            if (!way.streams) return false;
            streams = true;
        }
    }
    return streams;
}

bool is_silence(LossCause cause) {
    if (cause == LossCause::none) return false;
    return std::ranges::any_of(brought, [&](const auto& place) {
        const DoorWords* words = place.load(std::memory_order_acquire);
        return words && words->silence == cause;
    });
}

LossCause unrenewed_of(Door door) noexcept {
    const DoorWords* words = words_of(door);
    return words ? words->unrenewed : LossCause::set_points_silent;
}

bool has_users(Door door) noexcept {
    const DoorWords* words = words_of(door);
    return words && words->of_users;
}

}  // namespace axisgate
