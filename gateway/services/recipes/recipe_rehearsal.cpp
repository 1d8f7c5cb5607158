// The recipe service itself plays the run, so that a rehearsal and a real run follow the same rules.
#include "gateway/services/recipes/recipe_rehearsal.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gateway/core/specimen.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/recipes/recipe_read.hpp"
#include "gateway/services/recipes/recipe_service.hpp"
#include "gateway/services/recipes/recipe_steps.hpp"
#include "gateway/services/recipes/rehearsal_gateway.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {

std::vector<std::string> axes_in(const Recipe& recipe) {
    std::vector<std::string> out;
    const auto add = [&](const std::string& axis) {
        if (!axis.empty() && std::ranges::find(out, axis) == out.end()) out.push_back(axis);
    };
    for_each_step(recipe.steps, [&](const RecipeStep& s) {
        add(s.axis);
        if (s.condition) add(s.condition->axis);
    });
    return out;
}

/// Without the lines on which the recipe uses no axis: they cost time and change nothing. Mappings stay; the recipe uses none of the
/// others.
void leave_lines_of(Site& site, const std::vector<std::string>& axes) {
    std::set<std::string, std::less<>> lines;
    for (const AxisSpec& axis : site.axes) {
        const DriveSpec* drive = std::ranges::find(axes, axis.name) == axes.end() ? nullptr : site.drive(axis.drive);
        if (drive) lines.insert(drive->line);
    }
    std::erase_if(site.axes, [&](const AxisSpec& a) {
        const DriveSpec* drive = site.drive(a.drive);
        return !drive || !lines.contains(drive->line);
    });
    std::erase_if(site.drives, [&](const DriveSpec& d) { return !lines.contains(d.line); });
    std::erase_if(site.lines, [&](const LineSpec& l) { return !lines.contains(l.name); });
}

/// The names of axes that did not come online; the gateway runs until there are none, or the limit has passed.
std::string wait_for_drives(RehearsalGateway& gateway, const std::vector<std::string>& axes, const std::atomic<bool>& ended) {
    const auto site = gateway.site();
    const auto missing = [&] {
        std::string names;
        for (std::size_t i = 0; i < site->site.axes.size(); ++i) {
            const std::string& name = site->site.axes[i].name;
            if (std::ranges::find(axes, name) != axes.end() && !gateway.online(site->axis_ids[i]))
                names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
        }
        return names;
    };
    std::string names = missing();
    for (const Instant end = gateway.now() + RecipeRehearsal::start_limit; !names.empty() && gateway.now() < end && !ended;
         names = missing())
        gateway.step(end);
    return names;
}

std::string text_of_report(const json::object& report, std::string_view member) {
    const auto* v = report.if_contains(member);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}
}  // namespace

json::object to_json(const RehearsedSpecimen& r) {
    return {{"specimen", r.specimen},
            {"passed", r.passed},
            {"step", text_or_null(r.step)},
            {"pointer", text_or_null(r.pointer)},
            {"text", text_or_null(r.text)},
            {"event", text_or_null(r.event)},
            {"seconds", std::round(r.seconds * 1000) / 1000}};
}

std::vector<std::string> read_specimens(std::string_view text, std::string& fault) {
    std::vector<std::string> out;
    const auto refuse = [&](std::string why) {
        fault = std::move(why);
        out.clear();
        return out;
    };
    const auto add = [&](std::string name) {
        if (std::ranges::find(out, name) == out.end()) out.push_back(std::move(name));
    };
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string_view part = text.substr(begin, end - begin);
        begin = end + 1;
        const auto dots = part.find("..");
        if (dots == std::string_view::npos) {
            if (auto wrong = check_specimen(part); !wrong.empty()) return refuse(std::move(wrong));
            add(std::string(part));
            continue;
        }
        const auto first = parse_whole(part.substr(0, dots), 0, largest_specimen);
        const auto last = parse_whole(part.substr(dots + 2), 0, largest_specimen);
        if (!first || !last || *first > *last)
            return refuse(fmt::format("{} is no range of specimens: write two seeds such as 1..100, the smaller one first", part));
        if (static_cast<std::size_t>(*last - *first) >= most_rehearsed_specimens)
            return refuse(fmt::format("{} has more than {} specimens: divide it", part, most_rehearsed_specimens));
        if (out.empty()) {  // seeds of one range are different from each other
            for (auto seed = *first; seed <= *last; ++seed)
                out.push_back(std::to_string(seed));
            continue;
        }
        for (auto seed = *first; seed <= *last; ++seed)
            add(std::to_string(seed));
    }
    if (out.size() > most_rehearsed_specimens)
        return refuse(fmt::format("{} has more than {} specimens: divide it", text, most_rehearsed_specimens));
    return out;
}

void check_fixed(const FixedSpecimens& fixed, const Families& families, std::vector<SiteFault>& faults) {
    for (const auto& [family, specimen] : fixed) {
        if (!families.find(family).family)
            faults.push_back({"/fixed", fmt::format("there is no family {}", family), "families: " + families.names(), false});
        else if (auto wrong = check_specimen(specimen); !wrong.empty())
            faults.push_back({"/fixed", std::move(wrong), "name one of the family's specimens", false});
    }
}

Site site_of_specimen(Site site, std::string_view specimen, const FixedSpecimens& fixed) {
    for (DriveSpec& drive : site.drives) {
        const auto own = fixed.find(site.family_of(drive));
        drive.options["specimen"] = own == fixed.end() ? std::string(specimen) : own->second;
    }
    return site;
}

RecipeRehearsal::RecipeRehearsal(const Families& families, RecipeRehearsalWish wish, std::vector<SiteFault>& faults)
    : families_(families), wish_(std::move(wish)) {
    check_fixed(wish_.fixed, families, faults);
    wish_.site = simulated_site(std::move(wish_.site), families);
    auto recipe = read_recipe(wish_.document, &wish_.arguments, faults);
    if (!recipe) return;
    recipe_ = std::move(*recipe);
    const RehearsalGateway gateway(families_, wish_.site, wish_.memory, wish_.lease);
    check_recipe(recipe_, gateway, faults);
    axes_ = axes_in(recipe_);
    if (axes_.empty() && faults.empty())
        faults.push_back(
            {"/steps", "the recipe uses no axis, so no drive can make a difference to it", "rehearse a recipe with axes", false});
    leave_lines_of(wish_.site, axes_);
}

const std::atomic<bool> RecipeRehearsal::never_ended{false};

RehearsedSpecimen RecipeRehearsal::play(std::string_view specimen, const std::atomic<bool>& ended) const {
    RehearsedSpecimen out;
    out.specimen = specimen;
    RehearsalGateway gateway(families_, site_of_specimen(wish_.site, specimen, wish_.fixed), wish_.memory, wish_.lease);
    if (const std::string missing = wait_for_drives(gateway, axes_, ended); !missing.empty()) {
        out.text =
            fmt::format("not online within {} s: {}", std::chrono::duration_cast<std::chrono::seconds>(start_limit).count(), missing);
        out.event = gateway.last_warning();
        return out;
    }
    gateway.forget_warning();
    const Instant began = gateway.now();
    const auto service = std::make_shared<RecipeService>(gateway, [&gateway] { return gateway.now(); });
    json::object report;
    service->publish = [&report](const std::string&, const json::object& now) { report = now; };
    const auto started = service->start(wish_.name, recipe_, wish_.arguments, wish_.by);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&started)) {
        out.text = refusal->text;
        return out;
    }
    service->on_deadline(gateway.now());
    while (service->running(wish_.name) != 0 && !ended) {  // ends: a run has a limit of time, and each step advances it
        gateway.step(service->deadline());
        if (service->deadline() <= gateway.now()) service->on_deadline(gateway.now());
    }
    out.seconds = std::chrono::duration<double>(gateway.now() - began).count();
    out.passed = text_of_report(report, "state") == name_of(RecipeRun::State::done);
    out.event = gateway.last_warning();
    if (out.passed) return out;
    out.pointer = text_of_report(report, "at_step");
    out.step = text_of_report(report, "at_label");
    out.text = text_of_report(report, "text");
    return out;
}

}  // namespace axisgate
