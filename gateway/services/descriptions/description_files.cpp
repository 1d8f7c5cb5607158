// Adds and removes files in the queue of the site's changes, so that a site on its way cannot lose a file that it names.
#include "gateway/services/descriptions/description_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/parse.hpp>
#include <utility>

#include "gateway/services/descriptions/description.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
using Why = ServiceRefusal::Why;

json::object description_document(const Description& d, const std::vector<std::string>& users) {
    json::object o = d.facts ? *d.facts : json::object{{"name", d.name}};
    json::array used_by;
    for (const auto& u : users)
        used_by.emplace_back(u);
    o["used_by"] = std::move(used_by);
    return o;
}

ServiceRefusal too_many_changes() { return {Why::overloaded, "too many changes of the site wait already: try again"}; }
}  // namespace

std::vector<std::string> DescriptionFiles::users_of(std::string_view name) const {
    const auto& sites = ports_.get<SitePort>();
    std::vector<std::string> out;
    const auto add = [&](std::string drive) {
        if (std::ranges::find(out, drive) == out.end()) out.push_back(std::move(drive));
    };
    const auto of_site = [&](const Site& site) {
        for (const auto& d : site.drives)
            if (d.description == name) add(d.name);
    };
    of_site(sites.site()->site);
    const SiteStage& stage = ports_.get<StagePort>().site_stage();
    if (stage.state() != SiteStage::State::none) of_site(stage.site());
    if (const auto before = stage.busy() ? sites.site_revision(stage.base_revision()) : std::nullopt) {
        boost::system::error_code ec;
        const auto document = json::parse(before->text, ec);
        const auto* drives = !ec && document.is_object() ? document.get_object().if_contains("drives") : nullptr;
        for (const auto& v : drives && drives->is_array() ? drives->get_array() : json::array()) {
            const auto* o = v.if_object();
            const auto* named = o ? o->if_contains("description") : nullptr;
            const auto* drive = o ? o->if_contains("name") : nullptr;
            if (named && drive && named->is_string() && drive->is_string() && std::string_view(named->get_string()) == name)
                add(std::string(drive->get_string()));
        }
    }
    return out;
}

void DescriptionFiles::note(const Origin& origin, std::string text) const {
    Event e;
    e.kind = "site";
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    e.text = std::move(text);
    ports_.get<EventPort>().note(std::move(e));
}

std::shared_ptr<const Description> DescriptionFiles::find(std::string_view name) const {
    return ports_.get<DescriptionPort>().descriptions().find(name);
}

json::object DescriptionFiles::document(const Description& description) const {
    return description_document(description, users_of(description.name));
}

json::array DescriptionFiles::objects(const Description& description) {
    return descriptions::objects_of(descriptions::read(description.text));
}

json::array DescriptionFiles::list() const {
    json::array out;
    for (const auto& [name, d] : ports_.get<DescriptionPort>().descriptions().all()) {
        auto o = document(*d);
        o.erase("pdos");
        o.erase("warnings");
        out.push_back(std::move(o));
    }
    return out;
}

void DescriptionFiles::add(DescriptionText file, const Origin& origin, std::function<void(Refusable<Added>)> then,
                           ChangeQueue::Failed thrown) const {
    Description d;
    static_cast<DescriptionText&>(d) = std::move(file);
    d.who = origin.who ? *origin.who : "";
    d.at_unix_ns = ports_.get<ClockPort>().now_unix_ns();
    const auto read = descriptions::read(d.text);
    if (!read.eds) return then(faulty(descriptions::faults_of(read)));
    d.facts = descriptions::facts(d, read);
    const bool taken = changes_->run(
        [self = *this, d = std::move(d), origin, then](std::function<void()> done) {
            const auto end = [&](Refusable<Added> answer) {
                then(std::move(answer));
                done();
            };
            if (const auto there = self.find(d.name)) {
                if (there->text == d.text) return end(Added{d.name, self.document(*there), false});
                return end(ServiceRefusal{
                    Why::conflict, fmt::format("there is another description {}: choose another name, or delete that one first", d.name)});
            }
            if (self.ports_.get<DescriptionPort>().descriptions().all().size() >= descriptions::most_descriptions)
                return end(ServiceRefusal{Why::too_many, fmt::format("there are {} descriptions: delete those that no drive names",
                                                                     descriptions::most_descriptions)});
            self.ports_.get<DescriptionPort>().add_description(d, [self, d, origin, then, done](const std::string& fault) {
                if (fault.empty()) {
                    self.note(origin, fmt::format("description {} added", d.name));
                    then(Added{d.name, description_document(d, {}), true});
                } else {
                    then(ServiceRefusal{Why::not_stored, fault});
                }
                done();
            });
        },
        std::move(thrown));
    if (!taken) then(too_many_changes());
}

void DescriptionFiles::remove(const std::string& name, const Origin& origin, std::function<void(std::optional<ServiceRefusal>)> then,
                              ChangeQueue::Failed thrown) const {
    const bool taken = changes_->run(
        [self = *this, name, origin, then](std::function<void()> done) {
            const auto refuse = [&](ServiceRefusal refusal) {
                then(std::move(refusal));
                done();
            };
            if (!self.find(name)) return refuse(no_such("description", name));
            std::string list;
            json::array used_by;
            for (const auto& u : self.users_of(name)) {
                list += (list.empty() ? "" : ", ") + u;
                used_by.emplace_back(u);
            }
            if (!used_by.empty()) {
                return refuse(
                    {.why = Why::conflict,
                     .text = fmt::format("description {} is named by {} (in force, staged, or where a trial goes back to): change "
                                         "the site first",
                                         name, list),
                     .more = {{"used_by", std::move(used_by)}}});
            }
            self.ports_.get<DescriptionPort>().remove_description(name, [self, name, origin, then, done](const std::string& fault) {
                if (fault.empty()) self.note(origin, fmt::format("description {} deleted", name));
                then(fault.empty() ? std::nullopt : std::optional(ServiceRefusal{Why::not_stored, fault}));
                done();
            });
        },
        std::move(thrown));
    if (!taken) then(too_many_changes());
}

DescriptionText read_description(const json::value& body, std::string text, std::string named, std::vector<Fault>& faults) {
    DescriptionText d{std::move(named), {}};
    if (!body.is_object()) {
        d.text = std::move(text);
    } else {
        for (const auto& [k, v] : body.get_object()) {
            if (k != "name" && k != "text")
                faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "send name and text"});
            else if (!v.is_string())
                faults.push_back({"/" + std::string(k), fmt::format("{} must be a text", std::string_view(k)), "write it in quotes"});
            else if (k == "text")
                d.text = std::string(v.get_string());
            else if (!d.name.empty() && d.name != std::string_view(v.get_string()))
                faults.push_back({"/name", fmt::format("the name is {} in the query", d.name), "write it once"});
            else
                d.name = std::string(v.get_string());
        }
    }
    if (const auto wrong = descriptions::check_name(d.name); !wrong.empty())
        faults.push_back({body.is_object() ? "/name" : "", wrong, "send ?name=maker-model-1.eds", body.is_object()});
    return d;
}

}  // namespace axisgate
