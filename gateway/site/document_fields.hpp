// Document fields: reads one object of a site's document, member by member.
// Texts, numbers and options are returned; every fault is collected with its place and a correct example. Unknown members are reported.
#pragma once

#include <fmt/core.h>
#include <boost/json/serialize.hpp>
#include <boost/json/value.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

/// Collects faults, and remembers the keys that were read, so that unknown ones can be reported.
class DocumentFields {
public:
    DocumentFields(const boost::json::value& v, std::string pointer, std::vector<SiteFault>& faults)
        : pointer_(std::move(pointer)), faults_(faults) {
        if (v.is_object()) {
            object_ = &v.get_object();
        } else {
            fault("", "this must be an object", "write {...}");
        }
    }
    void fault(std::string_view key, std::string text, std::string remedy) {
        faults_.push_back({key.empty() ? pointer_ : pointer_ + "/" + std::string(key), std::move(text), std::move(remedy)});
    }
    const boost::json::value* get(std::string_view key) {
        known_.push_back(key);
        if (!object_) return nullptr;
        const auto* v = object_->if_contains(key);
        return v && !v->is_null() ? v : nullptr;
    }
    std::string text(std::string_view key, bool required, std::string_view example) {
        const auto* v = get(key);
        if (v && v->is_string() && (!required || !v->get_string().empty())) return std::string(v->get_string());
        if (v || required) {
            fault(key, v ? fmt::format("{} must be a text", key) : fmt::format("{} is missing", key),
                  fmt::format("write \"{}\": \"{}\"", key, example));
        }
        return {};
    }
    std::optional<double> number(std::string_view key, std::string_view example) {
        const auto* v = get(key);
        if (!v) return std::nullopt;
        if (v->is_number()) {
            const double d = v->to_number<double>();
            if (std::isfinite(d)) return d;
        }
        fault(key, fmt::format("{} must be a number", key), fmt::format("write \"{}\": {}", key, example));
        return std::nullopt;
    }
    std::optional<std::int64_t> integer(std::string_view key, std::int64_t low, std::int64_t high) {
        const auto* v = get(key);
        if (!v) return std::nullopt;
        std::optional<std::int64_t> i;
        if (v->is_int64()) i = v->get_int64();
        if (v->is_uint64() && v->get_uint64() <= INT64_MAX) i = static_cast<std::int64_t>(v->get_uint64());
        if (v->is_double() && std::nearbyint(v->get_double()) == v->get_double() && std::fabs(v->get_double()) < 9e15) {
            i = static_cast<std::int64_t>(v->get_double());
        }
        if (i && *i >= low && *i <= high) return i;
        fault(key, fmt::format("{} must be a whole number", key), fmt::format("write a value from {} to {}", low, high));
        return std::nullopt;
    }
    bool flag(std::string_view key) {
        const auto* v = get(key);
        if (v && !v->is_bool()) fault(key, fmt::format("{} must be true or false", key), "write one of them, or leave it out for false");
        return v && v->is_bool() && v->get_bool();
    }
    std::map<std::string, std::string> options(std::string_view key) {
        std::map<std::string, std::string> out;
        const auto* v = get(key);
        if (!v) return out;
        if (!v->is_object()) {
            fault(key, fmt::format("{} must be an object of names and values", key), "write {\"name\": \"value\"}");
            return out;
        }
        for (const auto& [k, x] : v->get_object()) {
            if (x.is_string()) {
                out[std::string(k)] = std::string(x.get_string());
            } else if (x.is_bool()) {
                out[std::string(k)] = x.get_bool() ? "true" : "false";
            } else if (x.is_number()) {
                out[std::string(k)] = boost::json::serialize(x);
            } else {
                fault(std::string(key) + "/" + std::string(k), "an option is a text, a number, true or false", "write one of them");
            }
        }
        return out;
    }
    void unknown_keys() {
        if (!object_) return;
        for (const auto& [k, v] : *object_) {
            if (std::ranges::find(known_, std::string_view(k)) == known_.end()) {
                fault(k, fmt::format("{} is not known here", std::string_view(k)), "remove it, or use one of: " + quoted_list(known_));
            }
        }
    }

private:
    static std::string quoted_list(const std::vector<std::string_view>& words) {
        std::string s;
        for (const auto w : words)
            s += (s.empty() ? "" : ", ") + std::string(w);
        return s;
    }
    const boost::json::object* object_ = nullptr;
    std::string pointer_;
    std::vector<SiteFault>& faults_;
    std::vector<std::string_view> known_;
};

}  // namespace axisgate
