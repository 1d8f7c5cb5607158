// Handlers of the site: lines, drives and axes one by one, and the whole document. Changes go through parse_site as a whole and through the
// site port.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/site/site_edit.hpp"
#include "gateway/services/site/site_entries.hpp"
#include "gateway/site/names.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Handled list(const EntryPorts& ports, Collection collection) {
    const auto site = ports.get<SitePort>().site();
    json::array out;
    for (std::size_t i = 0; i < entries_of(site->site, collection); ++i)
        out.push_back(entry_document(ports, site, collection, i));
    return site_answer(*site, out);
}

Handled get(Call& c, const EntryPorts& ports, Collection collection) {
    const auto site = ports.get<SitePort>().site();
    const auto i = entry_named(site->site, collection, c.names[0]);
    if (!i) return nothing_named(item_name(collection), c.names[0]);
    if (collection == Collection::axes) {
        Response r;
        r.headers.fields.reserve(12);  // including the fields that the router adds
        r.headers.set("Content-Type", "application/json");
        r.body = c.context.axis_texts->text(ports, site, *i);
        put_revision(r, *site);
        return r;
    }
    return site_answer(*site, entry_document(ports, site, collection, *i));
}

/// A change of one entry: made on the document, checked as a whole, answered by its entry.
Handled change_entry(Call& c, SitePort& sites, const StagePort& staging, std::function<Edited(json::object document)> make,
                     std::function<Response(const std::shared_ptr<const SiteState>& now, const Edit& edit)> show) {
    return change_site(
        c, sites, staging, false, [&sites, make = std::move(make), show = std::move(show)](const SiteState& before) -> Planned {
            auto edited = make(to_json(before.site));
            if (auto* refusal = std::get_if<ServiceRefusal>(&edited)) return std::move(*refusal);
            auto& edit = std::get<Edit>(edited);
            auto site = checked_site(edit.document, sites.families(), edit.pointer);
            return planned(std::move(site),
                           [show, edit = std::move(edit)](const std::shared_ptr<const SiteState>& now) { return show(now, edit); });
        });
}

/// 200, or 201 with its place, with the present entry.
auto show_entry(const EntryPorts& ports, Collection collection, bool created) {
    return [ports, collection, created](const std::shared_ptr<const SiteState>& now, const Edit& edit) {
        const auto i = entry_named(now->site, collection, edit.name);
        if (!i)
            return problem(409, "conflict", fmt::format("{} {} was removed by another client meanwhile", item_name(collection), edit.name));
        Response r = json_response(entry_document(ports, now, collection, *i), created ? 201 : 200);
        if (created) r.headers.set("Location", fmt::format("/api/v1/{}/{}", list_name(collection), percent_encode(edit.name)));
        put_revision(r, *now);
        return r;
    };
}

Handled add(Call& c, const EntryPorts& ports, const StagePort& staging, Collection collection) {
    return change_entry(
        c, ports.get<SitePort>(), staging,
        [collection, entry = c.body.get_object()](json::object d) { return add_entry(std::move(d), collection, entry); },
        show_entry(ports, collection, true));
}
Handled replace(Call& c, const EntryPorts& ports, const StagePort& staging, Collection collection) {
    return change_entry(
        c, ports.get<SitePort>(), staging,
        [collection, name = c.names[0], entry = c.body.get_object()](json::object d) {
            return replace_entry(std::move(d), collection, name, entry);
        },
        show_entry(ports, collection, false));
}
Handled patch(Call& c, const EntryPorts& ports, const StagePort& staging, Collection collection) {
    return change_entry(
        c, ports.get<SitePort>(), staging,
        [collection, name = c.names[0], entry = c.body.get_object()](json::object d) {
            return patch_entry(std::move(d), collection, name, entry);
        },
        show_entry(ports, collection, false));
}
Handled remove(Call& c, SitePort& sites, const StagePort& staging, Collection collection) {
    std::optional<Response> fault;
    const bool cascade = query_flag(c, "cascade", fault);
    if (fault) return *fault;
    return change_entry(
        c, sites, staging,
        [collection, name = c.names[0], cascade](json::object d) { return remove_entry(std::move(d), collection, name, cascade); },
        [](const std::shared_ptr<const SiteState>& now, const Edit&) { return site_without(now); });
}

Response site_change(const SiteState& now, bool dry_run, const std::vector<std::string>& differences, const std::vector<Fault>& faults) {
    json::array d, f;
    for (const auto& x : differences)
        d.emplace_back(x);
    for (const auto& x : faults)
        f.push_back(fault_document(x));
    Response r = json_response(json::object{{"dry_run", dry_run},
                                            {"valid", faults.empty()},
                                            {"revision", now.revision},
                                            {"differences", std::move(d)},
                                            {"faults", std::move(f)}});
    r.headers.set("ETag", site_tag(now.revision));
    put_revision(r, now);
    return r;
}
}  // namespace

Handled list_lines(Call&, const EntryPorts& ports) { return list(ports, Collection::lines); }
Handled list_drives(Call&, const EntryPorts& ports) { return list(ports, Collection::drives); }
Handled list_axes(Call&, const EntryPorts& ports) { return list(ports, Collection::axes); }
Handled get_line(Call& c, const EntryPorts& ports) { return get(c, ports, Collection::lines); }
Handled get_drive(Call& c, const EntryPorts& ports) { return get(c, ports, Collection::drives); }
Handled get_axis(Call& c, const EntryPorts& ports) { return get(c, ports, Collection::axes); }
Handled add_line(Call& c, const EntryPorts& ports, const StagePort& staging) { return add(c, ports, staging, Collection::lines); }
Handled add_drive(Call& c, const EntryPorts& ports, const StagePort& staging) { return add(c, ports, staging, Collection::drives); }
Handled add_axis(Call& c, const EntryPorts& ports, const StagePort& staging) { return add(c, ports, staging, Collection::axes); }
Handled replace_line(Call& c, const EntryPorts& ports, const StagePort& staging) { return replace(c, ports, staging, Collection::lines); }
Handled replace_drive(Call& c, const EntryPorts& ports, const StagePort& staging) { return replace(c, ports, staging, Collection::drives); }
Handled replace_axis(Call& c, const EntryPorts& ports, const StagePort& staging) { return replace(c, ports, staging, Collection::axes); }
Handled change_line(Call& c, const EntryPorts& ports, const StagePort& staging) { return patch(c, ports, staging, Collection::lines); }
Handled change_drive(Call& c, const EntryPorts& ports, const StagePort& staging) { return patch(c, ports, staging, Collection::drives); }
Handled change_axis(Call& c, const EntryPorts& ports, const StagePort& staging) { return patch(c, ports, staging, Collection::axes); }
Handled remove_line(Call& c, SitePort& sites, const StagePort& staging) { return remove(c, sites, staging, Collection::lines); }
Handled remove_drive(Call& c, SitePort& sites, const StagePort& staging) { return remove(c, sites, staging, Collection::drives); }
Handled remove_axis(Call& c, SitePort& sites, const StagePort& staging) { return remove(c, sites, staging, Collection::axes); }

Handled get_site(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    Response r;
    if (tag_listed(c.request.headers.get("If-None-Match"), site_tag(site->revision), true)) {
        r.status = 304;
        r.without_body = true;
    } else {
        r = json_response(to_json(site->site));
    }
    r.headers.set("ETag", site_tag(site->revision));
    put_revision(r, *site);
    return r;
}

Handled replace_site(Call& c, SitePort& sites, const StagePort& staging) {
    std::optional<Response> fault;
    const bool dry_run = query_flag(c, "dry_run", fault);
    if (fault) return *fault;
    const auto before = sites.site();
    std::vector<SiteFault> site_faults;
    auto site = parse_site(c.body, sites.families(), site_faults);
    if (site) site_faults = names_to_change(*site, &before->site);
    if (!site_faults.empty()) site.reset();
    const auto faults = faults_for(site_faults, "", true);
    const bool demanded = c.context.settings.require_if_match && !dry_run;
    if (dry_run || !site) {
        if (auto refusal = precondition(c, sites, *before, demanded)) return *refusal;
        if (!dry_run) return invalid(faults);
        return site_change(*before, true, site ? differences(before->site, *site) : std::vector<std::string>{}, faults);
    }
    return change_site(c, sites, staging, demanded, [site = std::move(*site)](const SiteState& now) -> Planned {
        return Plan{site, [changes = differences(now.site, site)](const std::shared_ptr<const SiteState>& after) {
                        return site_change(*after, false, changes, {});
                    }};
    });
}

}  // namespace axisgate::http
