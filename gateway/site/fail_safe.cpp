// Fail-safe: the registered causes of loss, and the choice of an action: the site's choice for the axis and cause, otherwise the default.
#include "gateway/site/fail_safe.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>

namespace axisgate {
namespace {
constexpr std::array<LossWords, 5> words_of_anybody{{
    {LossCause::set_points_silent, "set_points_silent",
     "the set-points that the axis follows are not renewed in time, or their connection has ended (doors without a cause of their own for "
     "that)",
     "has closed the connection by which it gave set-points", "has not renewed its set-points for {} ms"},
    {LossCause::lease_ended, "lease_ended",
     "the client held the axis by a lease, and the lease has expired or was taken back with the right to command",
     "has let its lease expire", ""},
    {LossCause::line_lost, "line_lost", "the drive could not be reached while it was commanded; the action follows when it answers again",
     "the drive could not be reached meanwhile", ""},
    {LossCause::gateway_ends, "gateway_ends", "the gateway is shutting down", "the gateway ends", ""},
    {LossCause::motion_unowned, "motion_unowned",
     "the axis moves without an order from a client of this gateway: found at the start, or begun at the drive",
     "the axis moves all the same", ""},
}};
std::array<std::atomic<const LossWords*>, most_loss_causes> words_of_doors{};
constexpr std::array<std::string_view, 4> action_names{"nothing", "halt", "quick_stop", "disable"};
}  // namespace

const LossWords* words_of(LossCause cause) noexcept {
    const auto own = std::ranges::find(words_of_anybody, cause, &LossWords::cause);
    if (own != words_of_anybody.end()) return &*own;
    const auto number = static_cast<std::size_t>(cause);
    return number < words_of_doors.size() ? words_of_doors[number].load(std::memory_order_acquire) : nullptr;
}

std::string_view name_of(LossCause cause) noexcept {
    if (cause == LossCause::none) return "none";
    const LossWords* words = words_of(cause);
    return words ? words->name : "unknown";
}

LossCauses loss_causes() noexcept {
    LossCauses known;
    for (std::size_t number = 1; number < most_loss_causes; ++number) {
        if (words_of(static_cast<LossCause>(number))) known.add(static_cast<LossCause>(number));
    }
    return known;
}

std::string name_loss(const LossWords& words) {
    const auto number = static_cast<std::size_t>(words.cause);
    if (number == 0 || number >= most_loss_causes)
        return fmt::format("number {} cannot be that of the cause {}: use 1 to {}", number, words.name, most_loss_causes - 1);
    if (words.name.empty() || words.name == "none" || words.name == "unknown" || words.name == "watchdog_ms" || words.text.empty())
        return fmt::format("\"{}\" cannot be the name of cause {}: use another word, and say what has happened", words.name, number);
    for (const LossCause other : loss_causes()) {
        if (other != words.cause && name_of(other) == words.name)
            return fmt::format("the name {} belongs to cause {}; give cause {} another name", words.name, static_cast<int>(other), number);
    }
    if (const LossWords* before = words_of(words.cause)) {
        if (before->name == words.name) return {};
        return fmt::format("number {} belongs to the cause {}; give the cause {} another number", number, before->name, words.name);
    }
    words_of_doors[number].store(&words, std::memory_order_release);
    return {};
}

std::string_view name_of(FailSafeAction action) noexcept { return action_names[static_cast<std::size_t>(action)]; }

std::optional<FailSafeAction> fail_safe_action_of(std::string_view name) noexcept {
    const auto found = std::ranges::find(action_names, name);
    if (found == action_names.end()) return std::nullopt;
    return static_cast<FailSafeAction>(found - action_names.begin());
}

FailSafeAction FailSafe::action(LossCause cause, const AtLoss& axis) const {
    const auto& wanted = of(cause);
    if (!wanted) {
        if (!axis.moving) return FailSafeAction::nothing;
        if (cause == LossCause::gateway_ends) return FailSafeAction::quick_stop;
        if (cause == LossCause::motion_unowned) return axis.endless ? FailSafeAction::quick_stop : FailSafeAction::nothing;
        return axis.endless ? FailSafeAction::halt : FailSafeAction::nothing;
    }
    if (*wanted == FailSafeAction::disable) return axis.powered || axis.moving ? FailSafeAction::disable : FailSafeAction::nothing;
    return axis.moving ? *wanted : FailSafeAction::nothing;
}

Duration FailSafe::watchdog(Duration by_default) const noexcept {
    return watchdog_ms ? Duration(std::chrono::milliseconds(*watchdog_ms)) : by_default;
}

}  // namespace axisgate
