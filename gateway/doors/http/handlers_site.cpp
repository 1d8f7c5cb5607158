// Handlers of the site: lines, drives and axes one by one, and the whole document.
// In: calls. Out: documents with their live state; changes go through parse_site as a whole and through Gateway::apply_site.
#include <fmt/format.h>

#include "gateway/doors/http/documents.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/site_edit.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// A change that lost a race against another one is made again on the newer site, so often.
constexpr int most_attempts = 3;

std::string tag_of(std::uint64_t revision) { return fmt::format("\"{}\"", revision); }

void put_revision(Response& r, const SiteState& site) { r.headers.set("Site-Revision", std::to_string(site.revision)); }

json::object document_of(Gateway& gateway, const std::shared_ptr<const SiteState>& site, Collection collection, std::size_t i) {
    switch (collection) {
        case Collection::lines:
            return line_document(*site, i, i < site->line_ids.size() ? gateway.line_report(site->line_ids[i]) : LineReport{});
        case Collection::drives:
            return drive_document(*site, i, i < site->drive_ids.size() ? gateway.drive_status(site->drive_ids[i]) : DriveStatus{});
        case Collection::axes:
            break;
    }
    const AxisPlace place = axis_at(gateway, site, i);
    const AxisPicture picture = place.id() == no_axis ? AxisPicture{} : gateway.picture(place.id());
    return axis_document(
        {place.spec(), place.line, place.family, place.catalogue, picture, gateway.to_unix_ns(picture.at), gateway.now_unix_ns()});
}

std::size_t size_of(const Site& site, Collection collection) {
    switch (collection) {
        case Collection::lines:
            return site.lines.size();
        case Collection::drives:
            return site.drives.size();
        case Collection::axes:
            return site.axes.size();
    }
    return 0;
}

std::optional<std::size_t> find_in(const Site& site, Collection collection, std::string_view name) {
    switch (collection) {
        case Collection::lines:
            return index_of_name(site.lines, name);
        case Collection::drives:
            return index_of_name(site.drives, name);
        case Collection::axes:
            return index_of_name(site.axes, name);
    }
    return std::nullopt;
}

Handled list(Call& c, Collection collection) {
    const auto site = c.gateway().site();
    json::array out;
    for (std::size_t i = 0; i < size_of(site->site, collection); ++i)
        out.push_back(document_of(c.gateway(), site, collection, i));
    Response r = json_response(out);
    put_revision(r, *site);
    return r;
}

Handled get(Call& c, Collection collection) {
    const auto site = c.gateway().site();
    const auto i = find_in(site->site, collection, c.names[0]);
    if (!i) return nothing_named(item_name(collection), c.names[0]);
    Response r = json_response(document_of(c.gateway(), site, collection, *i));
    put_revision(r, *site);
    return r;
}

/// 412 or 428 where If-Match says so.
std::optional<Response> precondition(const Call& c, const SiteState& site, bool demanded) {
    const auto header = c.request.headers.get("If-Match");
    if (header.empty()) {
        if (!demanded) return std::nullopt;
        return problem(428, "precondition_required", "say with If-Match which revision of the site you change: its ETag");
    }
    if (tag_listed(header, tag_of(site.revision), false)) return std::nullopt;
    Response r = problem(412, "precondition_failed",
                         fmt::format("the site has the revision {} by now, not {}: read it again", tag_of(site.revision), header));
    r.headers.set("ETag", tag_of(site.revision));
    put_revision(r, site);
    return r;
}

/// Pointers into the site become pointers into the request's body where they point into the changed entry.
std::vector<Fault> faults_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document) {
    std::vector<Fault> out;
    for (const auto& f : faults) {
        const bool inside =
            !entry.empty() && f.pointer.starts_with(entry) && (f.pointer.size() == entry.size() || f.pointer[entry.size()] == '/');
        out.push_back({inside ? f.pointer.substr(entry.size()) : f.pointer, f.text, f.remedy, whole_document || inside});
    }
    return out;
}

/// What a change comes to on the site in force, and how its success is shown; or why it cannot be.
struct Plan {
    Site site;
    std::function<Response(const std::shared_ptr<const SiteState>& now)> show;
};
using Planned = std::variant<Plan, Response>;

/// One change on its way: planned on the site in force, applied; and planned again if another change came between.
struct Change : std::enable_shared_from_this<Change> {
    Gateway& gateway;
    Origin origin;
    std::optional<std::uint64_t> only_for;  ///< If-Match was given: the change is for this revision alone
    std::function<Planned(const SiteState& before)> plan;
    Respond respond;
    std::function<void()> done;
    int attempts = 0;

    Change(Gateway& g, Origin o) : gateway(g), origin(std::move(o)) {}

    void end(Response r) {
        respond(std::move(r));
        done();
    }
    void attempt() {
        ++attempts;
        const auto before = gateway.site();
        if (only_for && *only_for != before->revision) return end(overtaken());
        auto planned = plan(*before);
        if (auto* refusal = std::get_if<Response>(&planned)) return end(std::move(*refusal));
        auto& [site, show] = std::get<Plan>(planned);
        if (to_json(site) == to_json(before->site)) return end(show(before));  // nothing changes: nothing is disturbed
        auto then = [self = shared_from_this(), before, show = std::move(show)](Gateway::SiteAnswer answer) {
            if (answer.good) return self->end(show(answer.now));
            if (!answer.now || answer.now->revision == before->revision) {
                return self->end(problem(507, "not_stored", answer.fault.empty() ? "the site could not be stored" : answer.fault));
            }
            if (!self->only_for && self->attempts < most_attempts) return self->attempt();
            self->end(self->only_for ? overtaken() : problem(503, "busy", "other clients keep changing the site: try again"));
        };
        gateway.apply_site(std::move(site), before->revision, origin, std::move(then));
    }
    static Response overtaken() {
        return problem(412, "precondition_failed", "the site was changed by another client meanwhile: read it again");
    }
};

Handled change(Call& c, bool if_match_demanded, std::function<Planned(const SiteState& before)> plan) {
    const auto site = c.gateway().site();
    if (auto refusal = precondition(c, *site, if_match_demanded)) return *refusal;
    auto order = std::make_shared<Change>(c.gateway(), c.origin());
    if (!c.request.headers.get("If-Match").empty()) order->only_for = site->revision;
    order->plan = std::move(plan);
    order->respond = c.respond;
    const bool taken = c.context.changes->run([order](std::function<void()> done) {
        order->done = std::move(done);
        order->attempt();
    });
    if (!taken) return problem(503, "busy", "too many changes of the site wait already: try again");
    return {gateway_limit, problem(504, "time_out", "the change was not applied in time: look at the site before trying again")};
}

/// A change of one entry: made on the document, checked as a whole, shown by its entry.
Handled change_entry(Call& c, std::function<Edited(json::object document)> make,
                     std::function<Response(const std::shared_ptr<const SiteState>& now, const Edit& edit)> show) {
    return change(c, false, [&gateway = c.gateway(), make = std::move(make), show = std::move(show)](const SiteState& before) -> Planned {
        auto edited = make(to_json(before.site));
        if (auto* refusal = std::get_if<Response>(&edited)) return std::move(*refusal);
        auto& edit = std::get<Edit>(edited);
        std::vector<SiteFault> faults;
        auto site = parse_site(edit.document, gateway.families(), faults);
        if (!site) return invalid(faults_for(faults, edit.pointer, false));
        return Plan{std::move(*site),
                    [show, edit = std::move(edit)](const std::shared_ptr<const SiteState>& now) { return show(now, edit); }};
    });
}

/// 200, or 201 with its place, with the entry as it is now.
auto show_entry(Gateway& gateway, Collection collection, bool created) {
    return [&gateway, collection, created](const std::shared_ptr<const SiteState>& now, const Edit& edit) {
        const auto i = find_in(now->site, collection, edit.name);
        if (!i)
            return problem(409, "conflict", fmt::format("{} {} was removed by another client meanwhile", item_name(collection), edit.name));
        Response r = json_response(document_of(gateway, now, collection, *i), created ? 201 : 200);
        if (created) r.headers.set("Location", fmt::format("/api/v1/{}/{}", list_name(collection), percent_encode(edit.name)));
        put_revision(r, *now);
        return r;
    };
}

Handled add(Call& c, Collection collection) {
    return change_entry(
        c, [collection, entry = c.body.get_object()](json::object d) { return add_entry(std::move(d), collection, entry); },
        show_entry(c.gateway(), collection, true));
}
Handled replace(Call& c, Collection collection) {
    return change_entry(
        c,
        [collection, name = c.names[0], entry = c.body.get_object()](json::object d) {
            return replace_entry(std::move(d), collection, name, entry);
        },
        show_entry(c.gateway(), collection, false));
}
Handled patch(Call& c, Collection collection) {
    return change_entry(
        c,
        [collection, name = c.names[0], entry = c.body.get_object()](json::object d) {
            return patch_entry(std::move(d), collection, name, entry);
        },
        show_entry(c.gateway(), collection, false));
}
Handled remove(Call& c, Collection collection) {
    std::optional<Response> fault;
    const bool cascade = query_flag(c, "cascade", fault);
    if (fault) return *fault;
    return change_entry(
        c, [collection, name = c.names[0], cascade](json::object d) { return remove_entry(std::move(d), collection, name, cascade); },
        [](const std::shared_ptr<const SiteState>& now, const Edit&) {
            Response r;
            r.status = 204;
            put_revision(r, *now);
            return r;
        });
}

Response site_change(const SiteState& now, bool dry_run, const std::vector<std::string>& differences, const std::vector<Fault>& faults) {
    json::array d, f;
    for (const auto& x : differences)
        d.emplace_back(x);
    for (const auto& x : faults)
        f.push_back(to_json(x));
    Response r = json_response(json::object{{"dry_run", dry_run},
                                            {"valid", faults.empty()},
                                            {"revision", now.revision},
                                            {"differences", std::move(d)},
                                            {"faults", std::move(f)}});
    r.headers.set("ETag", tag_of(now.revision));
    put_revision(r, now);
    return r;
}
}  // namespace

Handled list_lines(Call& c) { return list(c, Collection::lines); }
Handled list_drives(Call& c) { return list(c, Collection::drives); }
Handled list_axes(Call& c) { return list(c, Collection::axes); }
Handled get_line(Call& c) { return get(c, Collection::lines); }
Handled get_drive(Call& c) { return get(c, Collection::drives); }
Handled get_axis(Call& c) { return get(c, Collection::axes); }
Handled add_line(Call& c) { return add(c, Collection::lines); }
Handled add_drive(Call& c) { return add(c, Collection::drives); }
Handled add_axis(Call& c) { return add(c, Collection::axes); }
Handled replace_line(Call& c) { return replace(c, Collection::lines); }
Handled replace_drive(Call& c) { return replace(c, Collection::drives); }
Handled replace_axis(Call& c) { return replace(c, Collection::axes); }
Handled change_line(Call& c) { return patch(c, Collection::lines); }
Handled change_drive(Call& c) { return patch(c, Collection::drives); }
Handled change_axis(Call& c) { return patch(c, Collection::axes); }
Handled remove_line(Call& c) { return remove(c, Collection::lines); }
Handled remove_drive(Call& c) { return remove(c, Collection::drives); }
Handled remove_axis(Call& c) { return remove(c, Collection::axes); }

Handled get_site(Call& c) {
    const auto site = c.gateway().site();
    Response r;
    if (tag_listed(c.request.headers.get("If-None-Match"), tag_of(site->revision), true)) {
        r.status = 304;
        r.without_body = true;
    } else {
        r = json_response(to_json(site->site));
    }
    r.headers.set("ETag", tag_of(site->revision));
    put_revision(r, *site);
    return r;
}

Handled replace_site(Call& c) {
    std::optional<Response> fault;
    const bool dry_run = query_flag(c, "dry_run", fault);
    if (fault) return *fault;
    const auto before = c.gateway().site();
    std::vector<SiteFault> site_faults;
    auto site = parse_site(c.body, c.gateway().families(), site_faults);
    const auto faults = faults_for(site_faults, "", true);
    const bool demanded = c.context.settings.require_if_match && !dry_run;
    if (dry_run || !site) {
        if (auto refusal = precondition(c, *before, demanded)) return *refusal;
        if (!dry_run) return invalid(faults);
        return site_change(*before, true, site ? differences(before->site, *site) : std::vector<std::string>{}, faults);
    }
    return change(c, demanded, [site = std::move(*site)](const SiteState& now) -> Planned {
        return Plan{site, [changes = differences(now.site, site)](const std::shared_ptr<const SiteState>& after) {
                        return site_change(*after, false, changes, {});
                    }};
    });
}

}  // namespace axisgate::http
