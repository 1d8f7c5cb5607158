// One pointer for each number, set once.
#include "gateway/core/door_names.hpp"

#include <fmt/core.h>

#include <array>
#include <atomic>

namespace axisgate {
namespace {
constexpr std::string_view nobody = "none", gateway_itself = "internal", not_known = "unknown";
std::array<std::atomic<const std::string_view*>, 256> words{};
}  // namespace

std::string_view name_of(Door door) noexcept {
    if (door == Door::none) return nobody;
    if (door == Door::internal) return gateway_itself;
    const auto* word = words[static_cast<std::size_t>(door)].load(std::memory_order_acquire);
    return word ? *word : not_known;
}

std::optional<Door> door_named(std::string_view name) noexcept {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto* word = words[i].load(std::memory_order_acquire);
        if (word && *word == name) return static_cast<Door>(i);
    }
    return std::nullopt;
}

std::string name_door(Door door, const std::string_view& name) {
    const int number = static_cast<int>(door);
    if (door == Door::none || door == Door::internal)
        return fmt::format("number {} belongs to \"{}\"; give the door {} another number", number, name_of(door), name);
    if (name.empty() || name == nobody || name == gateway_itself || name == not_known || name.find(' ') != std::string_view::npos)
        return fmt::format("\"{}\" cannot be the word of a door: use one word that is not taken", name);
    if (const auto other = door_named(name); other && *other != door)
        return fmt::format("the word {} belongs to door {}; give door {} another word", name, static_cast<int>(*other), number);
    const std::string_view* before = nullptr;
    if (words[static_cast<std::size_t>(door)].compare_exchange_strong(before, &name, std::memory_order_acq_rel) || *before == name)
        return {};
    return fmt::format("number {} belongs to the door {}; give the door {} another number", number, *before, name);
}

}  // namespace axisgate
