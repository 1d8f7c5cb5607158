// Reads the body of a request to take or restore a snapshot; every fault has its place.
#include <fmt/core.h>

#include <algorithm>
#include <initializer_list>

#include "gateway/services/parameters/snapshots.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
std::string text_in(const json::object& body, const char* name, std::size_t low, std::size_t high, std::vector<Fault>& faults) {
    const auto* v = body.if_contains(name);
    if (!v && low == 0) return {};
    if (v && v->is_string() && v->get_string().size() >= low && v->get_string().size() <= high) return std::string(v->get_string());
    faults.push_back({fmt::format("/{}", name),
                      v ? fmt::format("{} must be a text of {} to {} bytes", name, low, high) : fmt::format("{} is missing", name),
                      fmt::format("write a text of {} to {} bytes", low, high)});
    return {};
}
bool flag_in(const json::object& body, std::string_view name, std::vector<Fault>& faults) {
    const auto* v = body.if_contains(name);
    if (v && !v->is_bool())
        faults.push_back({fmt::format("/{}", name), fmt::format("{} must be true or false", name), "write true or false"});
    return v && v->is_bool() && v->get_bool();
}
void refuse_unknown(const json::object& body, std::initializer_list<std::string_view> allowed, std::vector<Fault>& faults) {
    for (const auto& [k, v] : body) {
        if (std::ranges::find(allowed, std::string_view(k)) == allowed.end())
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "leave it out"});
    }
}
}  // namespace

SnapshotWish read_snapshot_wish(const json::object& body, std::vector<Fault>& faults) {
    refuse_unknown(body, {"name", "comment", "from"}, faults);
    SnapshotWish wish;
    wish.name = text_in(body, "name", 1, 256, faults);
    wish.comment = text_in(body, "comment", 0, 65'536, faults);
    const auto* from = body.if_contains("from");
    wish.from_stored = from && *from == json::value("stored");
    if (from && !wish.from_stored && *from != json::value("device"))
        faults.push_back({"/from", "from must be device or stored", "write \"device\" or \"stored\""});
    return wish;
}

RestoreWish read_restore_wish(const json::object& body, const AxisSnapshot& snapshot, std::vector<Fault>& faults) {
    refuse_unknown(body, {"parameters", "dry_run", "include_addressing", "include_live"}, faults);
    RestoreWish wish;
    wish.dry_run = flag_in(body, "dry_run", faults);
    wish.include.addressing = flag_in(body, "include_addressing", faults);
    wish.include.live = flag_in(body, "include_live", faults);
    const auto* list = body.if_contains("parameters");
    if (!list) return wish;
    if (!list->is_array()) {
        faults.push_back({"/parameters", "parameters must be a list of ids", "leave it out for all of them"});
        return wish;
    }
    wish.parameters.emplace();
    for (std::size_t i = 0; i < list->get_array().size(); ++i) {
        const auto& v = list->get_array()[i];
        const bool there = v.is_string() && std::ranges::find(snapshot.parameters, std::string(v.get_string()),
                                                              &SnapshotValue::parameter) != snapshot.parameters.end();
        if (there)
            wish.parameters->insert(std::string(v.get_string()));
        else
            faults.push_back({fmt::format("/parameters/{}", i), "this is no parameter of the snapshot",
                              "name parameters by their id, as the snapshot does"});
    }
    return wish;
}

}  // namespace axisgate
