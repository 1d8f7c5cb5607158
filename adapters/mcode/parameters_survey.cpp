// Survey: what moves take, what shapes them, and which user variables the drive has: read when nothing else is to be done.
// In: the drive's answers. Out: values; one notice for each difference between the site's option `variables` and the drive's own listing.
// Never refuses a variable that a program may declare later.
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

void Survey::plan_listing(Instant now) {
    if (drive_.bus.only_reads) return;          // behind a listing ER is asked if an error stands, which clears it
    if (std::exchange(listing_, true)) return;  // it keeps the turn that it has
    Instant& next = drive_.bus.next_listing;
    listing_at_ = std::max(now, next);
    next = listing_at_ + std::chrono::seconds(1);
}

bool Survey::wants(Instant now) const noexcept {
    return drive_.jobs.idle() && (feedback().relearn || feedback().wants_shape() || feedback().wants_zero() || wants_listing(now));
}

bool Survey::wants_listing(Instant now) const noexcept {
    return listing_ && now >= listing_at_ && feedback().at_rest() && drive_.jobs.idle() && drive_.jobs.queue.empty();
}

void Survey::read_again() {
    shape_ = false;
    if (std::exchange(feedback().relearn, false)) {
        drive_.jobs.begin_own(*this).ask(feedback().value_items());
    } else if (feedback().wants_shape()) {
        shape_ = true;
        drive_.jobs.begin_own(*this).ask(R"(BE,",",AT,",",DT)");
    }
}

void Survey::list_variables(Instant now) {
    if (!wants_listing(now)) return;
    listing_ = false;
    drive_.jobs.begin_own(*this).list("PR UV");
}

void Survey::answered(const std::string& data, Turn& t) {
    std::string bare = data;
    std::erase(bare, ' ');
    if (shape_)
        feedback().demand.shape(bare == "0,1,1");
    else
        feedback().learn_values(data);
    succeed({}, t);
}

void Survey::without_success(drive::Failure& how, Turn&) {
    if (!how.dropped && shape_) feedback().shape_refused = true;
}

void Survey::listed(const std::string& listing, Turn& t) {
    const auto all = listed_variables(listing);
    const auto has = [](const std::vector<std::string>& list, std::string_view name) {
        return std::ranges::find(list, name) != list.end();
    };
    std::vector<std::string> named, lacking, unnamed;
    for (const Parameter& p : drive_.catalogue().parameters()) {
        if (p.wire.contains("variable")) named.push_back(word_of_parameter(p));
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
             fmt::format("{} has user variables that are no parameters of its axis: {}; the drive's option variables makes them "
                         "that, the action UV lists all",
                         name(), some_of(unnamed)),
             t);
    }
    succeed({}, t);
}

}  // namespace axisgate::mcode
