// Checks a request completely before any part of it is carried out.
#include "gateway/services/drive_access.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "gateway/core/text.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
constexpr std::size_t most_native_bytes = 1024;

ServiceRefusal not_simulated(const DrivePort& drives, DriveId id, std::string_view name) {
    const DriveStatus status = drives.drive_status(id);
    std::string why = status.presence == Presence::device ? "the real drive serves it" : "it is offline";
    if (!status.text.empty()) why += " (" + status.text + ")";
    return {ServiceRefusal::Why::not_simulated, fmt::format("drive {} is not simulated now: {}", name, why)};
}

/// The twin reports in words what it refuses; the pointer is that of the only member, or of the one that the words name.
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

std::optional<DrivePlace> find_drive(const SitePort& sites, std::string_view name) {
    auto site = sites.site();
    const auto index = index_of_name(site->site.drives, name);
    if (!index) return std::nullopt;
    return DrivePlace{std::move(site), *index};
}

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

Refusable<std::size_t> axis_for(const DrivePlace& drive) {
    const auto& axes = drive.site->site.axes;
    const std::string& name = drive.spec().name;
    std::optional<std::size_t> lowest;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].drive == name && (!lowest || axes[i].channel < axes[*lowest].channel)) lowest = i;
    }
    if (lowest && *lowest < drive.site->axis_ids.size()) return *lowest;
    return ServiceRefusal{ServiceRefusal::Why::conflict, fmt::format("drive {} has no axis: add one, so that commands can name it", name)};
}

json::object hand_document(const HandItems& items) {
    json::object o;
    for (const auto& i : items)
        o[i.name] = to_json(i.value);
    return o;
}

json::array hand_description(const HandItems& items) {
    json::array list;
    for (const auto& i : items)
        list.push_back(
            json::object{{"name", i.name}, {"value", to_json(i.value)}, {"writable", i.writable}, {"description", i.description}});
    return list;
}

HandWish read_hand_wish(const json::object& body, std::vector<Fault>& faults) {
    HandWish wanted;
    for (const auto& [k, v] : body) {
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
    return wanted;
}

void get_hand(DrivePort& drives, const DrivePlace& drive, std::function<void(Refusable<HandItems>)> then) {
    drives.hand(drive.id(), [&drives, id = drive.id(), name = drive.spec().name, then = std::move(then)](std::optional<HandItems> items) {
        if (!items) return then(not_simulated(drives, id, name));
        then(*std::move(items));
    });
}

void set_hand(DrivePort& drives, const DrivePlace& drive, HandWish wanted, Origin origin, std::function<void(Refusable<HandItems>)> then) {
    // The conditions are read first, because a drive that is not simulated and an unknown name can then be reported better.
    get_hand(drives, drive,
             [&drives, drive, wanted = std::move(wanted), origin = std::move(origin),
              then = std::move(then)](Refusable<HandItems> answer) mutable {
                 const auto* items = std::get_if<HandItems>(&answer);
                 if (!items) return then(std::move(answer));
                 std::vector<Fault> wrong;
                 std::string names;
                 for (const auto& i : *items) {
                     if (i.writable) names += (names.empty() ? "" : ", ") + i.name;
                 }
                 for (const auto& [k, v] : wanted) {
                     const auto it = std::ranges::find(*items, k, &HandItem::name);
                     if (it == items->end()) {
                         wrong.push_back({"/" + k, fmt::format("drive {} has no {}", drive.spec().name, k), "use one of: " + names});
                     } else if (!it->writable) {
                         wrong.push_back({"/" + k, k + " can only be read", "use one of: " + names});
                     }
                 }
                 if (!wrong.empty()) return then(faulty(std::move(wrong)));
                 if (wanted.empty()) return then(std::move(answer));
                 std::vector<std::string> asked;
                 for (const auto& [k, v] : wanted)
                     asked.push_back(k);
                 drives.set_hand(drive.id(), std::move(wanted), std::move(origin),
                                 [&drives, drive, asked = std::move(asked), then](std::string wrong_text) {
                                     if (!wrong_text.empty()) return then(faulty({hand_fault(asked, std::move(wrong_text))}));
                                     get_hand(drives, drive, then);
                                 });
             });
}

}  // namespace axisgate
