// Reads a JSON object whose members are all known; stops at the first fault.
#include "gateway/doors/http/stream_request.hpp"

#include <fmt/core.h>

#include <cmath>

#include "gateway/core/json_read.hpp"

namespace axisgate::http {
namespace {
namespace json = boost::json;

bool read_topics(const json::value& v, std::string_view key, std::vector<std::string>& into, std::string& fault) {
    if (!v.is_array() || v.get_array().size() > most_topics_per_request) {
        fault = fmt::format("{} must be a list of at most {} topics", key, most_topics_per_request);
        return false;
    }
    for (const auto& t : v.get_array()) {
        if (!t.is_string()) {
            fault = fmt::format("{} must hold texts", key);
            return false;
        }
        into.emplace_back(t.get_string());
    }
    return true;
}
}  // namespace

std::optional<StreamRequest> read_stream_request(std::string_view text, std::string& fault) {
    JsonFault unread;
    const auto document = read_json(text, unread);
    if (!document && unread.twice) {
        fault = fmt::format("{} ({}): keep one of them", unread.text, unread.pointer);
        return std::nullopt;
    }
    if (!document || !document->is_object()) {
        fault = "a request is a JSON object: {\"subscribe\": [\"axes/*\"], \"period_ms\": 50}";
        return std::nullopt;
    }
    StreamRequest r;
    bool asks = false;
    for (const auto& [k, x] : document->get_object()) {
        if (k == "subscribe" || k == "unsubscribe") {
            asks = true;
            if (!read_topics(x, k, k == "subscribe" ? r.subscribe : r.unsubscribe, fault)) return std::nullopt;
        } else if (k == "set_point") {
            asks = true;
            if (!x.is_object() || x.get_object().empty()) {
                fault = "set_point must be an object: {\"axis\": \"feeder\", \"mode\": \"position\", \"value\": 12.5}";
                return std::nullopt;
            }
            r.set_point = x.get_object();
        } else if (k == "period_ms") {
            const double ms = x.is_number() ? x.to_number<double>() : 0;
            if (!(ms >= 10 && ms <= 10'000) || std::nearbyint(ms) != ms) {
                fault = "period_ms must be a whole number from 10 to 10000";
                return std::nullopt;
            }
            r.period_ms = (static_cast<std::int64_t>(ms) + 9) / 10 * 10;
        } else {
            fault = fmt::format("{} is not known here: use subscribe, unsubscribe, period_ms, set_point", std::string_view(k));
            return std::nullopt;
        }
    }
    if (!asks) {
        fault = "subscribe, unsubscribe or set_point is missing";
        return std::nullopt;
    }
    return r;
}

}  // namespace axisgate::http
