// An empty text means no memories; a number that does not fit is a fault and is not rounded.
#include "gateway/services/parameters/memory_file.hpp"

#include <fmt/core.h>

#include <boost/json/serialize.hpp>
#include <cmath>

#include "gateway/core/json_read.hpp"

namespace axisgate {
namespace json = boost::json;

std::string memories_to_json(const std::map<std::string, NonVolatile>& memories) {
    json::object all;
    for (const auto& [address, memory] : memories) {
        json::object o;
        for (const auto& [name, value] : memory) {
            json::value v;
            if (const auto* b = std::get_if<bool>(&value)) v = *b;
            if (const auto* i = std::get_if<std::int64_t>(&value)) v = *i;
            if (const auto* d = std::get_if<double>(&value)) v = *d;
            if (const auto* s = std::get_if<std::string>(&value)) v = *s;
            o[name] = std::move(v);
        }
        all[address] = std::move(o);
    }
    return json::serialize(all) + "\n";
}

std::string memories_from_json(std::string_view text, std::map<std::string, NonVolatile>& memories) {
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return {};
    JsonFault unread;
    const auto parsed = read_json(text, unread);
    if (!parsed && unread.twice)
        return fmt::format("{} in the memory of twins, in line {} ({}): keep one of them", unread.text, unread.line, unread.pointer);
    if (!parsed || !parsed->is_object()) return "this is not the memory of twins: expected {\"ADDRESS\": {\"NAME\": VALUE, ...}}";
    for (const auto& [address, entry] : parsed->get_object()) {
        if (!entry.is_object()) return fmt::format("the memory of {} is not an object", std::string_view(address));
        NonVolatile m;
        for (const auto& [name, v] : entry.get_object()) {
            Value value;
            if (v.is_bool()) value = v.get_bool();
            if (v.is_int64()) value = v.get_int64();
            if (v.is_uint64()) return fmt::format("{} of {} is too large", std::string_view(name), std::string_view(address));
            if (v.is_double() && !std::isfinite(v.get_double()))
                return fmt::format("{} of {} is too large", std::string_view(name), std::string_view(address));
            if (v.is_double()) value = v.get_double();
            if (v.is_string()) value = std::string(v.get_string());
            m[std::string(name)] = std::move(value);
        }
        memories[std::string(address)] = std::move(m);
    }
    return {};
}

}  // namespace axisgate
