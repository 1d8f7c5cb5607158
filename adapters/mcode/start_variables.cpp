// Drive: its user variables: which of them the site's option names, and which it does not.
// In: the drive's own listing (PR UV), asked for once when it was found. Out: one notice for each difference; sentences for what it lacks.
// Never declares a variable, and never refuses one that a program may declare later.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/mcode/drive.hpp"
#include "adapters/mcode/parameters_variables.hpp"

namespace axisgate::mcode {
namespace {
/// "Q1, Q2 and 30 more".
std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t most = 16;
    std::string s;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
        s += (i > 0 ? ", " : "") + names[i];
    return names.size() > most ? fmt::format("{} and {} more", s, names.size() - most) : s;
}
}  // namespace

void Drive::variables_listed(std::string_view listing, Turn& t) {
    const auto all = listed_variables(listing);
    const auto has = [](const std::vector<std::string>& list, std::string_view name) {
        return std::ranges::find(list, name) != list.end();
    };
    std::vector<std::string> named, lacking, unnamed;
    for (const Parameter& p : drive_catalogue().parameters()) {
        if (p.wire.contains("variable")) named.push_back(word(p));
    }
    for (const auto& n : named)
        if (!has(all, n)) lacking.push_back(n);
    for (const auto& n : global_variables(listing))
        if (!has(named, n)) unnamed.push_back(n);
    if (!lacking.empty()) {
        note(Severity::warning, "variables", 0,
             fmt::format("{} does not have the user variable{} {} of the site's option variables: declare them (VA {}=0, or in its "
                         "program), or take them out",
                         name(), lacking.size() == 1 ? "" : "s", some_of(lacking), lacking.front()),
             t);
    }
    if (!unnamed.empty()) {
        note(Severity::info, "variables", 0,
             fmt::format("{} has user variables that are no parameters of its axis: {}; the drive's option variables makes them that, the "
                         "action UV lists all",
                         name(), some_of(unnamed)),
             t);
    }
    job_over(Outcome::done, Reason::none, {}, t);
}

/// Of the parameter in hand, if it is a user variable; else empty.
std::string Drive::variable_hint() const {
    const auto* read = std::get_if<ReadParameter>(&job_.command.body);
    const auto* write = std::get_if<WriteParameter>(&job_.command.body);
    const Parameter* p = read || write ? drive_catalogue().parameter(read ? read->point : write->point) : nullptr;
    if (!p || !p->wire.contains("variable")) return {};
    return fmt::format(
        "{0} has no user variable {1} now: declare it (native VA {1}=0, or in its program), or take it out of the drive's option variables",
        name(), word(*p));
}

}  // namespace axisgate::mcode
