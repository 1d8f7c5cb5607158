#include "gateway/site/rehearsal_cell.hpp"

#include <algorithm>

namespace axisgate {
namespace {
constexpr std::array<std::string_view, rehearsal_steps.size()> step_names{"second_client", "refused_commands", "gateway_restart",
                                                                          "old_image"};
}  // namespace

std::string_view name_of(RehearsalStep step) noexcept { return step_names[static_cast<std::size_t>(step)]; }

std::optional<RehearsalStep> rehearsal_step_of(std::string_view name) noexcept {
    const auto found = std::ranges::find(step_names, name);
    if (found == step_names.end()) return std::nullopt;
    return static_cast<RehearsalStep>(found - step_names.begin());
}

std::string_view situation_of(const RehearsalCell& cell) noexcept {
    if (cell.cause != LossCause::none) return name_of(cell.cause);
    return cell.restart ? "gateway_restarts" : "gateway_gone";
}

}  // namespace axisgate
