// Handlers of drives: one exchange in the drive's own language, and the tester's hand of simulated drives.
// In: calls. Out: what the drive answered; the outside conditions as they are.
#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::size_t most_native_bytes = 1024;

struct DrivePlace {
    std::shared_ptr<const SiteState> site;
    std::size_t index = 0;
    [[nodiscard]] const DriveSpec& spec() const { return site->site.drives[index]; }
    [[nodiscard]] DriveId id() const { return index < site->drive_ids.size() ? site->drive_ids[index] : no_drive; }
};

std::optional<DrivePlace> find_drive(const SitePort& sites, std::string_view name) {
    auto site = sites.site();
    const auto index = index_of_name(site->site.drives, name);
    if (!index) return std::nullopt;
    return DrivePlace{std::move(site), *index};
}

Response not_simulated(const DrivePort& drives, DriveId id, std::string_view name) {
    const DriveStatus status = drives.drive_status(id);
    std::string why = status.presence == Presence::device ? "the real drive serves it" : "it is offline";
    if (!status.text.empty()) why += " (" + status.text + ")";
    return problem(409, "not_simulated", fmt::format("drive {} is not simulated now: {}", name, why));
}

json::object flat(const std::vector<HandItem>& items) {
    json::object o;
    for (const auto& i : items)
        o[i.name] = to_json(i.value);
    return o;
}

/// The bytes to send, or what is wrong with the body.
std::optional<Native> read_native(const json::object& body, std::vector<Fault>& faults) {
    for (const auto& [k, v] : body) {
        if (k != "send" && k != "send_hex") {
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)),
                              "write {\"send\": \"...\"} or {\"send_hex\": \"...\"}"});
        }
    }
    const auto* text = body.if_contains("send");
    const auto* hex = body.if_contains("send_hex");
    if ((text != nullptr) == (hex != nullptr)) {
        faults.push_back(
            {"", text ? "send and send_hex are both there" : "send is missing", "write {\"send\": \"...\"} or {\"send_hex\": \"...\"}"});
        return std::nullopt;
    }
    Native native;
    native.is_text = text != nullptr;
    const std::string_view key = text ? "send" : "send_hex";
    const json::value& v = text ? *text : *hex;
    if (!v.is_string()) {
        faults.push_back({"/" + std::string(key), fmt::format("{} must be a text", key), "write it in quotes"});
        return std::nullopt;
    }
    const std::string_view s = v.get_string();
    if (text) {
        native.send.assign(s.begin(), s.end());
    } else if (auto bytes = from_hex(s)) {
        native.send = std::move(*bytes);
    } else {
        faults.push_back({"/send_hex", "send_hex must be pairs of hex digits", "write \"send_hex\": \"95 00\""});
        return std::nullopt;
    }
    if (native.send.empty() || native.send.size() > most_native_bytes) {
        faults.push_back({"/" + std::string(key), fmt::format("{} bytes cannot be sent at once", native.send.size()),
                          fmt::format("send 1 to {} bytes", most_native_bytes)});
        return std::nullopt;
    }
    return native;
}
}  // namespace

Handled exchange_native(Call& c, AxisPort& axes, const ClockPort& clock, const SitePort& sites) {
    const auto drive = find_drive(sites, c.names[0]);
    if (!drive) return nothing_named("drive", c.names[0]);
    std::vector<Fault> faults;
    auto native = read_native(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    // The exchange belongs to the drive, but every command names an axis: the lowest channel stands for the drive.
    const auto& on_site = drive->site->site.axes;
    std::optional<std::size_t> lowest;
    for (std::size_t i = 0; i < on_site.size(); ++i) {
        if (on_site[i].drive == c.names[0] && (!lowest || on_site[i].channel < on_site[*lowest].channel)) lowest = i;
    }
    if (!lowest || *lowest >= drive->site->axis_ids.size()) {
        return problem(409, "conflict", fmt::format("drive {} has no axis: add one, so that commands can name it", c.names[0]));
    }
    Command command;
    command.axis = drive->site->axis_ids[*lowest];
    command.body = std::move(*native);
    const std::int64_t begun_ns = clock.now_unix_ns();
    // To the microsecond: on a fast line an exchange is over within one millisecond.
    const auto took_ms = [&clock, begun_ns] {
        return number(static_cast<double>(std::max<std::int64_t>(0, (clock.now_unix_ns() - begun_ns) / 1'000)) / 1000.0);
    };
    const std::string axis = on_site[*lowest].name;
    command.origin = c.origin();
    const Ticket ticket = axes.submit(std::move(command), [took_ms, axis, respond = c.respond](const Result& r) {
        if (good(r)) return respond(json_response(json::object{{"reply", r.text}, {"reply_hex", to_hex(r.bytes)}, {"took_ms", took_ms()}}));
        if (r.reason != Reason::drive_refused || r.bytes.empty()) return respond(problem_of(r, axis, "native"));
        // The drive has answered, if with its error: what it said belongs to the answer.
        respond(to_response(Problem{.status = 409,
                                    .reason = std::string(name_of(r.reason)),
                                    .detail = r.text,
                                    .code = r.code,
                                    .axis = axis,
                                    .more = {{"ticket", shown(r.ticket)},
                                             {"result", name_of(r.outcome)},
                                             {"command", "native"},
                                             {"reply_hex", to_hex(r.bytes)},
                                             {"took_ms", took_ms()}}}));
    });
    Result none;
    none.ticket = ticket;
    none.outcome = Outcome::failed;
    none.reason = Reason::no_answer;
    none.text = fmt::format("native: no result within {} s; nobody knows whether it was done", gateway_limit.count());
    return {gateway_limit, problem_of(none, axis, "native")};
}

namespace {
/// The twin says in words what it does not take; the place is the one member there is, or the one that its words name.
Fault hand_fault(const std::vector<std::string>& asked, std::string text) {
    if (asked.size() == 1) return {"/" + asked.front(), std::move(text), "nothing was set; see GET with ?describe=1"};
    const auto is_named = [&text](const std::string& name) {
        const auto in_word = [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
        for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
            const auto end = at + name.size();
            if ((at == 0 || !in_word(text[at - 1])) && (end == text.size() || !in_word(text[end]))) return true;
        }
        return false;
    };
    const auto it = std::ranges::find_if(asked, is_named);
    const bool sure = it != asked.end() && std::find_if(it + 1, asked.end(), is_named) == asked.end();
    return {sure ? "/" + *it : "", std::move(text), "members before it may have been set: look with GET"};
}
}  // namespace

Handled get_hand(Call& c, DrivePort& drives, const SitePort& sites) {
    const auto drive = find_drive(sites, c.names[0]);
    if (!drive) return nothing_named("drive", c.names[0]);
    std::optional<Response> fault;
    const bool describe = query_flag(c, "describe", fault);
    if (fault) return *fault;
    drives.hand(drive->id(),
                [&drives, id = drive->id(), name = c.names[0], describe, respond = c.respond](std::optional<std::vector<HandItem>> items) {
                    if (!items) return respond(not_simulated(drives, id, name));
                    if (!describe) return respond(json_response(flat(*items)));
                    json::array list;
                    for (const auto& i : *items) {
                        list.push_back(json::object{
                            {"name", i.name}, {"value", to_json(i.value)}, {"writable", i.writable}, {"description", i.description}});
                    }
                    respond(json_response(list));
                });
    return {gateway_limit, problem(504, "time_out", fmt::format("the hand of {} was not told in time", c.names[0]))};
}

Handled set_hand(Call& c, DrivePort& drives, const SitePort& sites) {
    const auto drive = find_drive(sites, c.names[0]);
    if (!drive) return nothing_named("drive", c.names[0]);
    std::vector<std::pair<std::string, Value>> wanted;
    std::vector<Fault> faults;
    for (const auto& [k, v] : c.body.get_object()) {
        Value value;
        if (v.is_bool()) value = v.get_bool();
        if (v.is_int64()) value = v.get_int64();
        if (v.is_double()) value = v.get_double();
        if (v.is_string()) value = std::string(v.get_string());
        if (!known(value)) {
            faults.push_back({"/" + std::string(k), fmt::format("{} must be a number, a text, true or false", std::string_view(k)),
                              "see GET with ?describe=1"});
        }
        wanted.emplace_back(std::string(k), std::move(value));
    }
    if (!faults.empty()) return invalid(std::move(faults));
    // Asked first: whether the drive is simulated, and which names there are, is told better before anything is set.
    drives.hand(drive->id(), [&drives, id = drive->id(), name = c.names[0], wanted = std::move(wanted), origin = c.origin(),
                              respond = c.respond](std::optional<std::vector<HandItem>> items) mutable {
        if (!items) return respond(not_simulated(drives, id, name));
        std::vector<Fault> wrong;
        std::string names;
        for (const auto& i : *items) {
            if (i.writable) names += (names.empty() ? "" : ", ") + i.name;
        }
        for (const auto& [k, v] : wanted) {
            const auto it = std::ranges::find(*items, k, &HandItem::name);
            if (it == items->end()) {
                wrong.push_back({"/" + k, fmt::format("drive {} has no {}", name, k), "use one of: " + names});
            } else if (!it->writable) {
                wrong.push_back({"/" + k, k + " can only be read", "use one of: " + names});
            }
        }
        if (!wrong.empty()) return respond(invalid(std::move(wrong)));
        if (wanted.empty()) return respond(json_response(flat(*items)));
        std::vector<std::string> asked;
        for (const auto& [k, v] : wanted)
            asked.push_back(k);
        drives.set_hand(id, std::move(wanted), std::move(origin),
                        [&drives, id, name, asked = std::move(asked), respond](std::string wrong_text) {
                            if (!wrong_text.empty()) return respond(invalid({hand_fault(asked, std::move(wrong_text))}));
                            drives.hand(id, [&drives, id, name, respond](std::optional<std::vector<HandItem>> now) {
                                respond(now ? json_response(flat(*now)) : not_simulated(drives, id, name));
                            });
                        });
    });
    return {gateway_limit,
            problem(504, "time_out", fmt::format("the hand of {} did not answer in time; look again whether it was set", c.names[0]))};
}

}  // namespace axisgate::http
