// Clients remove "." and ".." from a path before they send it; a name that does not begin with a letter or digit is an option for a shell,
// or a hidden file.
#include "gateway/site/names.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/text.hpp"

namespace axisgate {

std::vector<SiteFault> names_to_change(const Site& site, const Site* before) {
    std::vector<SiteFault> out;
    const auto tell = [&out](std::string_view list, std::string_view kind, const auto& now, const auto* old, auto&& is_good) {
        for (std::size_t i = 0; i < now.size(); ++i) {
            const std::string& name = now[i].name;
            if (is_good(name) || (old && std::ranges::any_of(*old, [&name](const auto& o) { return o.name == name; }))) continue;
            out.push_back({fmt::format("/{}/{}/name", list, i), fmt::format("the {} \"{}\" cannot be asked for by its name", kind, name),
                           "give it another name, which must begin with a letter or digit (PUT /api/v1/site)"});
        }
    };
    const auto begins_well = [](const std::string& name) { return !name.empty() && (is_letter(name.front()) || is_digit(name.front())); };
    const auto no_dots = [](const std::string& name) { return name != "." && name != ".."; };
    tell("lines", "line", site.lines, before ? &before->lines : nullptr, no_dots);
    tell("drives", "drive", site.drives, before ? &before->drives : nullptr, no_dots);
    tell("axes", "axis", site.axes, before ? &before->axes : nullptr, begins_well);
    return out;
}

}  // namespace axisgate
