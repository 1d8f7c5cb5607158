// A unit belongs to one map: that of its profile, or that of its mappings.
#include "gateway/site/profile.hpp"

#include <array>
#include <set>

#include "gateway/site/document_fields.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace {
constexpr std::array<std::string_view, profile_language_count> language_names{"cia402", "lexium", "pacontrol", "linmot"};

ProfileAxis read_profile_axis(const boost::json::value& v, const std::string& pointer, const Site& site, std::vector<SiteFault>& faults) {
    ProfileAxis a;
    DocumentFields f(v, pointer, faults);
    a.axis = f.text("axis", true, site.axes.empty() ? "feeder" : site.axes.front().name);
    if (!a.axis.empty() && !site.axis(a.axis)) f.fault("axis", fmt::format("there is no axis {}", a.axis), "name an axis of the site");
    a.counts_per_unit = f.number("counts_per_unit", "10000");
    a.velocity = f.number("velocity", "100");
    a.acceleration = f.number("acceleration", "1000");
    for (const auto& [key, x] :
         {std::pair{"counts_per_unit", a.counts_per_unit}, std::pair{"velocity", a.velocity}, std::pair{"acceleration", a.acceleration}}) {
        if (x && !(*x > 0)) f.fault(key, fmt::format("{} must be above 0", key), "leave it out for the language's own");
    }
    f.unknown_keys();
    return a;
}
}  // namespace

std::string_view name_of(ProfileLanguage language) noexcept { return language_names[static_cast<std::size_t>(language)]; }
std::optional<ProfileLanguage> profile_language_named(std::string_view name) noexcept {
    for (std::size_t i = 0; i < language_names.size(); ++i) {
        if (language_names[i] == name) return static_cast<ProfileLanguage>(i);
    }
    return std::nullopt;
}
std::size_t most_axes(ProfileLanguage language) noexcept { return language == ProfileLanguage::pacontrol ? 8 : 1; }

void read_profiles(const boost::json::value* list, Site& site, std::vector<SiteFault>& faults) {
    if (!list || list->is_null()) return;
    if (!list->is_array()) {
        faults.push_back({"/profiles", "profiles must be a list",
                          "write [{\"unit\": 10, \"language\": \"lexium\", \"axes\": [{\"axis\": \"feeder\"}]}]"});
        return;
    }
    std::set<std::uint8_t> units;
    for (std::size_t i = 0; i < list->get_array().size(); ++i) {
        const std::string pointer = fmt::format("/profiles/{}", i);
        DocumentFields f(list->get_array()[i], pointer, faults);
        ProfileSpec p;
        if (!f.get("unit")) f.fault("unit", "unit is missing", "write \"unit\": 10, a Modbus unit of its own");
        if (const auto unit = f.integer("unit", 2, 254)) {
            p.unit = static_cast<std::uint8_t>(*unit);
            if (!units.insert(p.unit).second)
                f.fault("unit", fmt::format("unit {} has two profiles", p.unit), "give each a unit of its own");
        }
        const std::string language = f.text("language", true, "lexium");
        if (const auto known = profile_language_named(language)) {
            p.language = *known;
        } else if (!language.empty()) {
            f.fault("language", fmt::format("there is no language {}", language), "use cia402, lexium, pacontrol or linmot");
        }
        if (f.get("word_order")) {
            const std::string order = f.text("word_order", false, "low_first");
            for (const auto o : {MapWordOrder::high_first, MapWordOrder::low_first}) {
                if (name_of(o) == order) p.word_order = o;
            }
            if (p.language == ProfileLanguage::cia402)
                f.fault("word_order", "the block of an axis has the order of unit 1", "leave it out; [modbus] word_order sets it");
            else if (!p.word_order)
                f.fault("word_order", fmt::format("\"{}\" is no order of words", order), "use high_first or low_first");
        }
        const auto* axes = f.get("axes");
        if (!axes || !axes->is_array() || axes->get_array().empty() || axes->get_array().size() > most_axes(p.language)) {
            f.fault("axes", fmt::format("axes must be a list of 1 to {}", most_axes(p.language)), "write [{\"axis\": \"feeder\"}]");
        } else {
            std::set<std::string> names;
            for (std::size_t k = 0; k < axes->get_array().size(); ++k) {
                p.axes.push_back(read_profile_axis(axes->get_array()[k], fmt::format("{}/axes/{}", pointer, k), site, faults));
                if (!p.axes.back().axis.empty() && !names.insert(p.axes.back().axis).second)
                    f.fault(fmt::format("axes/{}/axis", k), fmt::format("axis {} is there twice", p.axes.back().axis), "name each once");
            }
        }
        for (const auto& [key, place] : {std::pair{"input_assembly", &p.input_assembly}, std::pair{"output_assembly", &p.output_assembly},
                                         std::pair{"object_instance", &p.object_instance}}) {
            const bool object = place == &p.object_instance;
            if (const auto n = f.integer(key, 1, object ? 255 : 65535)) *place = static_cast<std::uint16_t>(*n);
        }
        if (p.object_instance && p.language != ProfileLanguage::lexium)
            f.fault("object_instance", fmt::format("{} has no objects of its own on EtherNet/IP", language),
                    "leave it out; input_assembly and output_assembly carry its image");
        f.unknown_keys();
        site.profiles.push_back(std::move(p));
    }
}

void check_profile_units(const Site& site, std::vector<SiteFault>& faults) {
    for (std::size_t i = 0; i < site.profiles.size(); ++i) {
        const auto unit = site.profiles[i].unit;
        const auto mapped = std::ranges::find(site.map(), unit, &Mapping::unit);
        if (mapped != site.map().end())
            faults.push_back({fmt::format("/profiles/{}/unit", i), fmt::format("unit {} has mappings (such as {})", unit, mapped->id),
                              "give the profile or the mappings another unit", true});
    }
}

boost::json::object to_json(const ProfileSpec& p) {
    boost::json::object o{{"unit", std::int64_t{p.unit}}, {"language", name_of(p.language)}};
    if (p.word_order) o["word_order"] = name_of(*p.word_order);
    boost::json::array axes;
    for (const auto& a : p.axes) {
        boost::json::object x{{"axis", a.axis}};
        if (a.counts_per_unit) x["counts_per_unit"] = *a.counts_per_unit;
        if (a.velocity) x["velocity"] = *a.velocity;
        if (a.acceleration) x["acceleration"] = *a.acceleration;
        axes.push_back(std::move(x));
    }
    o["axes"] = std::move(axes);
    if (p.input_assembly) o["input_assembly"] = std::int64_t{*p.input_assembly};
    if (p.output_assembly) o["output_assembly"] = std::int64_t{*p.output_assembly};
    if (p.object_instance) o["object_instance"] = std::int64_t{*p.object_instance};
    return o;
}

}  // namespace axisgate
