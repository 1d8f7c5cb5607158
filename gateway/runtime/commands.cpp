// The commands families, catalogue, check, health, bundle and pki. No thread is started.
#include "gateway/runtime/commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/serialize.hpp>
#include <cstdio>
#include <ctime>

#include "gateway/core/assets.hpp"
#include "gateway/runtime/bundle.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/command_tables.hpp"
#include "gateway/runtime/config_host.hpp"
#include "gateway/runtime/door_http.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/own_page.hpp"
#include "gateway/runtime/site_file.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/site/names.hpp"
#include "gateway/site/options.hpp"
#include "gateway/store/store.hpp"

namespace axisgate {
namespace json = boost::json;

void complain(const std::string& text) { fmt::print(stderr, "axisgate: {}\n", text); }

namespace {
std::string plain(const json::value* v) {
    if (!v || v->is_null()) return "";
    if (v->is_string()) return std::string(v->get_string());
    return json::serialize(*v);
}

constexpr std::string_view parameter_fields[] = {"id",      "name",   "group",   "type",        "unit",       "min",  "max",
                                                 "default", "access", "storage", "description", "addressing", "live", "allowed"};

/// {"0": "off", "1": "on"} as "0 = off, 1 = on"; other values unchanged.
std::string cell(std::string_view field, const json::value* v) {
    if (field != "allowed" || !v || !v->is_object()) return plain(v);
    std::string s;
    for (const auto& [value, meaning] : v->get_object())
        s += fmt::format("{}{} = {}", s.empty() ? "" : ", ", std::string_view(value), plain(&meaning));
    return s;
}
}  // namespace

int command_families(const std::string& format) {
    const auto families = families_or_complain();
    if (!families) return exit_failed;
    json::array list;
    std::vector<TableRow> rows;
    for (const auto& e : families->entries) {
        const auto& doc = e.catalogue->document();
        std::string lines = e.family->uses_can && e.family->uses_bytes ? "can, bytes" : e.family->uses_can ? "can" : "bytes";
        rows.push_back({std::to_string(e.catalogue->number()), std::string(e.family->name), plain(doc.if_contains("title")), lines,
                        std::string(e.family->factory_address), std::to_string(e.catalogue->parameters().size()),
                        std::to_string(e.catalogue->commands().size()), std::to_string(e.catalogue->errors().size())});
        list.push_back({{"number", e.catalogue->number()},
                        {"name", e.family->name},
                        {"title", plain(doc.if_contains("title"))},
                        {"can", e.family->uses_can},
                        {"bytes", e.family->uses_bytes},
                        {"factory_address", e.family->factory_address},
                        {"parameters", e.catalogue->parameters().size()},
                        {"commands", e.catalogue->commands().size()},
                        {"errors", e.catalogue->errors().size()}});
    }
    if (format == "json") {
        fmt::print("{}\n", json::serialize(list));
    } else {
        print_table({"number", "name", "title", "lines", "factory address", "parameters", "commands", "errors"}, rows);
    }
    return exit_good;
}

int command_catalogue(const std::string& family, const std::string& what, const std::string& format) {
    const auto families = families_or_complain();
    if (!families) return exit_failed;
    const auto entry = family_or_complain(*families, family);
    if (!entry) return exit_usage;
    const auto* list = entry->catalogue->document().if_contains(what);
    if (!list || !list->is_array()) {
        complain(fmt::format("a catalogue has parameters, commands and errors, not {}", what));
        return exit_usage;
    }
    TableRow head;
    if (what == "parameters") {
        for (const auto f : parameter_fields)
            head.emplace_back(f);
    } else if (what == "commands") {
        head = {"id", "name", "description"};
    } else {
        head = {"code", "through", "kind", "name", "text", "cause", "remedy"};
    }
    if (format == "json") {
        json::array out;
        if (what == "parameters") {  // as /families/{f}/parameters has them
            const auto parameters = entry->catalogue->parameters();
            for (std::size_t i = 0; i < parameters.size(); ++i)
                out.push_back(
                    parameter_document(*entry->catalogue, {static_cast<std::uint16_t>(i), parameters[i].first}, parameters[i].id));
        } else {
            out = list->get_array();
        }
        fmt::print("{}\n", json::serialize(out));
        return exit_good;
    }
    std::vector<TableRow> rows;
    for (const auto& item : list->get_array()) {
        TableRow r;
        for (const auto& f : head)
            r.push_back(cell(f, item.get_object().if_contains(f)));
        rows.push_back(std::move(r));
    }
    if (format == "csv") {
        print_csv(head, rows);
    } else {
        print_table(head, rows);
    }
    return exit_good;
}

void complain(const ConfigFault& f) { complain(fmt::format("{}{}: {}; {}", f.warning ? "warning: " : "", f.place, f.text, f.remedy)); }

int command_check(const ConfigSources& sources, const std::string& site_file, bool all_read) {
    std::vector<ConfigFault> faults;
    const auto config = read_config(sources, faults);
    if (faults.empty()) faults = check_door_files(config, unix_now_ns() / 1'000'000'000);
    for (auto& f : check_host(config))
        faults.push_back(std::move(f));
    for (const auto& f : faults)
        complain(f);
    std::size_t count = (all_read ? 0u : 1u) + static_cast<std::size_t>(std::ranges::count(faults, false, &ConfigFault::warning));
    if (!site_file.empty()) {
        auto families = families_or_complain();
        if (!families) return exit_failed;
        families->descriptions = std::make_shared<DescriptionShelf>();
        const auto read = read_site_file(site_file, *families);
        for (const auto& f : read.faults)
            complain(f);
        count += read.faults.size();
        if (read.site) {
            for (const auto& f : names_to_change(*read.site, nullptr))
                complain(fmt::format("warning: {}, {}: {}; {}", site_file, f.pointer, f.text, f.remedy));
            for (const auto& f : check_options(*read.site, *families))
                complain("warning: " + f.text + "; it counts as not given");
        }
    }
    if (count == 0) fmt::print("no faults found\n");
    return count == 0 ? exit_good : exit_usage;
}

int command_health(const Config& config) {
    const OwnPage page = own_page(config, "/healthz");
    if (page.status == 200) {
        fmt::print("{}\n", page.body);
        return exit_good;
    }
    complain(fmt::format("the gateway at {} is not well: {}",
                         config.of<HttpSettings>().bind.empty() ? "no HTTP door" : config.of<HttpSettings>().bind,
                         page.fault.empty() ? page.body : page.fault));
    return exit_failed;
}

int command_bundle(const ConfigSources& sources, const Config& config, const std::string& file) {
    if (const std::string fault = write_file(file, make_bundle(sources, config)); !fault.empty()) {
        complain(fault);
        return exit_failed;
    }
    fmt::print("{}\n", file);
    return exit_good;
}

int command_pki(const PkiOptions& options) {
    const PkiMade made = make_pki(options, std::time(nullptr));
    for (const auto& folder : made.folders)
        fmt::print("{}\n", folder);
    if (made.fault.empty()) return exit_good;
    complain(made.fault);
    return exit_failed;
}

}  // namespace axisgate
