// Assemblies: reads, checks and writes the entries. An instance has one user only, and a range never splits a value.
// An entry is never moved to a free instance automatically.
#include "gateway/site/assembly.hpp"

#include <array>
#include <map>
#include <set>

#include "gateway/site/document_fields.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace {
using enum AssemblyDirection;

std::optional<std::uint16_t> read_number(DocumentFields& f, std::string_view key, std::int64_t low, std::int64_t high,
                                         const char* example) {
    if (!f.get(key)) f.fault(key, fmt::format("{} is missing", key), fmt::format("write \"{}\": {}", key, example));
    const auto n = f.integer(key, low, high);
    return n ? std::optional(static_cast<std::uint16_t>(*n)) : std::nullopt;
}

AssemblySpec read_one(const boost::json::value& v, const std::string& pointer, std::vector<SiteFault>& faults) {
    DocumentFields f(v, pointer, faults);
    AssemblySpec a;
    a.instance = read_number(f, "instance", 1, 65535, "300").value_or(0);
    const std::string direction = f.text("direction", true, "input");
    if (direction == name_of(output)) {
        a.direction = output;
    } else if (!direction.empty() && direction != name_of(input)) {
        f.fault("direction", fmt::format("\"{}\" is no direction", direction), "use input (to the originator) or output (from it)");
    }
    a.unit = static_cast<std::uint8_t>(read_number(f, "unit", 2, 254, "40, a Modbus unit with mappings or a profile").value_or(2));
    a.table = MapTable::holding_registers;
    if (const std::string table = f.get("table") ? f.text("table", false, "holding_registers") : "";
        table == name_of(MapTable::input_registers)) {
        a.table = MapTable::input_registers;
        if (a.direction == output) f.fault("table", "inputs can only be read", "use holding_registers for what the originator renews");
    } else if (!table.empty() && table != name_of(MapTable::holding_registers)) {
        f.fault("table", fmt::format("\"{}\" is no table of registers", table), "use holding_registers or input_registers");
    }
    a.address = static_cast<std::uint16_t>(f.integer("address", 0, 65535).value_or(0));
    a.registers = read_number(f, "registers", 1, most_assembly_registers, "16").value_or(1);
    if (a.address + std::uint32_t{a.registers} > 65536)
        f.fault("registers", fmt::format("{} registers from {} go beyond 65535", a.registers, a.address), "choose fewer");
    if (const std::string order = f.get("byte_order") ? f.text("byte_order", false, "little_endian") : "";
        order == name_of(AssemblyOrder::registers)) {
        a.order = AssemblyOrder::registers;
    } else if (!order.empty() && order != name_of(AssemblyOrder::little_endian)) {
        f.fault("byte_order", fmt::format("\"{}\" is no order of bytes", order), "use little_endian or registers");
    }
    a.comment = f.text("comment", false, "recipe of the press");
    if (a.comment.size() > 64) f.fault("comment", "comment has more than 64 bytes", "make it shorter");
    f.unknown_keys();
    return a;
}

std::string range_text(const AssemblySpec& a) {
    return fmt::format("unit {} {} {}..{}", a.unit, name_of(a.table), a.address, a.address + a.registers - 1);
}
bool meets(const Mapping& m, const AssemblySpec& a) {
    return m.unit == a.unit && m.table == a.table && m.address < a.address + std::uint32_t{a.registers} && m.end() > a.address &&
           m.access != (a.direction == output ? MapAccess::read : MapAccess::write);
}
const ProfileSpec* profile_at(const Site& site, std::uint8_t unit) {
    const auto it = std::ranges::find(site.profiles, unit, &ProfileSpec::unit);
    return it == site.profiles.end() ? nullptr : &*it;
}

/// The image of a profile: the part that its master writes, and the part that it reads. Its content is in gateway/registers/profiles.
AssemblySpec image_of(const ProfileSpec& p, AssemblyDirection direction) {
    AssemblySpec a;
    a.unit = p.unit;
    a.direction = direction;
    a.instance = (direction == input ? p.input_assembly : p.output_assembly).value_or(0);
    a.table = MapTable::holding_registers;
    switch (p.language) {
        case ProfileLanguage::cia402:
            a.address = direction == input ? 0 : 32;
            a.registers = direction == input ? 32 : 16;
            break;
        case ProfileLanguage::lexium:
            a.registers = 169;
            break;
        case ProfileLanguage::pacontrol:
            if (direction == input) a.table = MapTable::input_registers;
            a.registers = static_cast<std::uint16_t>(8 + 6 * p.axes.size());
            a.order = AssemblyOrder::registers;  // the device's own image begins with the highest byte
            break;
        case ProfileLanguage::linmot:
            if (direction == input) a.table = MapTable::input_registers;
            a.registers = direction == input ? 10 : 17;
            break;
    }
    return a;
}

void check_range(const Site& site, const AssemblySpec& a, const std::string& pointer, std::vector<SiteFault>& faults) {
    if (profile_at(site, a.unit)) return;
    bool any = false;
    for (const Mapping& m : site.map()) {
        if (!meets(m, a)) continue;
        any = true;
        if (m.address >= a.address && m.end() <= a.address + std::uint32_t{a.registers}) continue;
        faults.push_back({pointer + "/registers",
                          fmt::format("assembly {} ({}) cuts mapping {} in two, which takes {}..{}", a.instance, range_text(a), m.id,
                                      m.address, m.end() - 1),
                          "begin and end it between two values"});
    }
    if (!any)
        faults.push_back({pointer + "/address",
                          fmt::format("assembly {} has nothing to {}: nothing is mapped so at {}", a.instance,
                                      a.direction == output ? "write" : "show", range_text(a)),
                          "map points there first, name another unit or range, or take the assembly away"});
}
}  // namespace

std::string_view name_of(AssemblyDirection d) noexcept { return d == input ? "input" : "output"; }
std::string_view name_of(AssemblyOrder o) noexcept { return o == AssemblyOrder::little_endian ? "little_endian" : "registers"; }

std::string fixed_assembly(std::uint32_t n) {
    constexpr std::uint32_t near = last_near_assembly;
    const auto axis = [](std::uint32_t number, const char* way) { return fmt::format("axis number {} {} the originator", number, way); };
    if (n == 100 || n == 150) return fmt::format("all axes together {} the originator", n == 100 ? "to" : "from");
    if (n == 197) return "the heartbeat of connections that listen only";
    if (n == 198) return "the heartbeat of connections that read only";
    if (n == 199) return "the configuration";
    if (n > 100 && n <= 100 + near) return axis(n - 100, "to");
    if (n > 150 && n <= 150 + near) return axis(n - 150, "from");
    if (n > 1000 + near && n <= 1000 + max_axes) return axis(n - 1000, "to");
    if (n > 2000 + near && n <= 2000 + max_axes) return axis(n - 2000, "from");
    return {};
}

void read_assemblies(const boost::json::value* list, Site& site, std::vector<SiteFault>& faults) {
    if (!list || list->is_null()) return;
    if (!list->is_array()) {
        faults.push_back({"/assemblies", "assemblies must be a list",
                          "write [{\"instance\": 300, \"direction\": \"input\", \"unit\": 40, \"address\": 0, \"registers\": 16}]"});
        return;
    }
    const auto& entries = list->get_array();
    if (entries.size() > most_assemblies) {
        faults.push_back(
            {"/assemblies", fmt::format("{} assemblies are too many", entries.size()), fmt::format("at most {}", most_assemblies)});
        return;
    }
    for (std::size_t i = 0; i < entries.size(); ++i)
        site.assemblies.push_back(read_one(entries[i], fmt::format("/assemblies/{}", i), faults));
}

void check_assemblies(const Site& site, std::vector<SiteFault>& faults, const std::function<std::string(std::size_t)>& called) {
    std::map<std::uint16_t, std::string> held;
    const auto take = [&](std::uint16_t instance, const std::string& pointer, std::string by) {
        if (instance == 0) return;  // it could not be read, and its fault is already reported
        std::string holder = fixed_assembly(instance);
        if (const auto it = held.find(instance); it != held.end()) holder = it->second;
        if (!holder.empty())
            faults.push_back({pointer, fmt::format("instance {} is taken by {}", instance, holder),
                              "choose another, such as one from 200 to 1000", true});
        held.emplace(instance, std::move(by));
    };
    const auto own = [&] {
        for (std::size_t i = 0; i < site.assemblies.size(); ++i) {
            const AssemblySpec& a = site.assemblies[i];
            const std::string name = called ? called(i) : std::string();
            take(a.instance, fmt::format("/assemblies/{}/instance", i),
                 name.empty() ? fmt::format("the assembly of {}", range_text(a)) : fmt::format("{} ({})", name, range_text(a)));
            check_range(site, a, fmt::format("/assemblies/{}", i), faults);
        }
    };
    if (!called) own();
    std::map<std::uint16_t, std::uint8_t> objects;
    for (std::size_t i = 0; i < site.profiles.size(); ++i) {
        const ProfileSpec& p = site.profiles[i];
        const std::string place = fmt::format("/profiles/{}", i), by = fmt::format("the profile of unit {}", p.unit);
        if (p.input_assembly) take(*p.input_assembly, place + "/input_assembly", by);
        if (p.output_assembly) take(*p.output_assembly, place + "/output_assembly", by);
        if (!p.object_instance) continue;
        if (const auto [it, fresh] = objects.emplace(*p.object_instance, p.unit); !fresh)
            faults.push_back({place + "/object_instance",
                              fmt::format("instance {} is taken by the profile of unit {}", *p.object_instance, it->second),
                              "give each profile its own", true});
    }
    if (called) own();
}

boost::json::object to_json(const AssemblySpec& a) {
    boost::json::object o{{"instance", std::int64_t{a.instance}}, {"direction", name_of(a.direction)},
                          {"unit", std::int64_t{a.unit}},         {"table", name_of(a.table)},
                          {"address", std::int64_t{a.address}},   {"registers", std::int64_t{a.registers}}};
    if (a.order != AssemblyOrder::little_endian) o["byte_order"] = name_of(a.order);
    if (!a.comment.empty()) o["comment"] = a.comment;
    return o;
}

std::vector<SiteAssembly> assemblies_of(const Site& site) {
    std::vector<SiteAssembly> all;
    const auto add = [&](AssemblySpec spec, const std::string& what) {
        SiteAssembly a;
        a.spec = std::move(spec);
        a.name = what + (a.spec.direction == input ? " to the originator" : " from the originator");
        std::set<std::string> axes;
        if (const auto* p = profile_at(site, a.spec.unit)) {
            for (const auto& x : p->axes)
                axes.insert(x.axis);
        }
        for (const Mapping& m : site.map()) {
            if (meets(m, a.spec)) axes.insert(m.axis);
        }
        a.axes.assign(axes.begin(), axes.end());
        all.push_back(std::move(a));
    };
    for (const AssemblySpec& a : site.assemblies)
        add(a, !a.comment.empty() ? a.comment : fmt::format("unit {} {}..{}", a.unit, a.address, a.address + a.registers - 1));
    for (const ProfileSpec& p : site.profiles) {
        const std::string what = fmt::format("{} of unit {}", name_of(p.language), p.unit);
        if (p.input_assembly) add(image_of(p, input), what);
        if (p.output_assembly) add(image_of(p, output), what);
    }
    std::ranges::sort(all, {}, [](const SiteAssembly& a) { return a.spec.instance; });
    // An originator that renews an output reads the input of the same unit, or else of the same axes.
    for (SiteAssembly& out : all) {
        if (out.spec.direction != output) continue;
        const auto reads = [&](auto&& fits) {
            const auto it = std::ranges::find_if(all, [&](const SiteAssembly& a) { return a.spec.direction == input && fits(a); });
            return it == all.end() ? std::uint16_t{0} : it->spec.instance;
        };
        out.partner = reads([&](const SiteAssembly& a) { return a.spec.unit == out.spec.unit; });
        if (out.partner == 0) out.partner = reads([&](const SiteAssembly& a) { return std::ranges::includes(a.axes, out.axes); });
    }
    return all;
}

}  // namespace axisgate
