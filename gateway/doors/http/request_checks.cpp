// Checks a request by the list of its route. Compressed bodies are refused, because a few bytes can expand to any length.
#include "gateway/doors/http/request_checks.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/json_read.hpp"

namespace axisgate::http {
namespace json = boost::json;
using Takes = Route::Takes;

/// Checks the media type of the body.
std::optional<Response> check_media(const Request& request, Takes takes) {
    const auto given = request.headers.get("Content-Type");
    const auto media = media_of(given);
    const auto refused = [&](std::string_view header, std::string_view taken, std::string text) {
        Response r = problem(415, "unsupported_media_type", std::move(text));
        if (!header.empty()) r.headers.set(header, std::string(taken));
        return r;
    };
    switch (takes) {
        case Takes::nothing:
            return std::nullopt;
        case Takes::bytes:
            if (media == "application/octet-stream") return std::nullopt;
            return refused({}, {}, "send the file with Content-Type: application/octet-stream");
        case Takes::csv:
            if (media == "text/csv") return std::nullopt;
            return refused("Accept-Post", "text/csv", fmt::format("send a table with Content-Type: text/csv in UTF-8, not \"{}\"", given));
        case Takes::eds:
            if (media == "text/plain" || media == "application/octet-stream" || media == "application/json") return std::nullopt;
            return refused("Accept-Post", "text/plain, application/octet-stream, application/json",
                           fmt::format("send the file with Content-Type: text/plain, or JSON with name and text, not \"{}\"", given));
        case Takes::json:
            if (media == "application/json") return std::nullopt;
            return refused("Accept-Post", "application/json",
                           fmt::format("send a JSON object with Content-Type: application/json in UTF-8, not \"{}\"", given));
        case Takes::patch:
            if (media == "application/json" || media == "application/merge-patch+json") return std::nullopt;
            return refused("Accept-Patch", "application/merge-patch+json, application/json",
                           fmt::format("send a JSON object with Content-Type: application/json in UTF-8, not \"{}\"", given));
    }
    return std::nullopt;
}

/// Compressed bodies are refused, because a few bytes can expand to any length. `identity` is no compression (RFC 9110 8.4).
std::optional<Response> check_coding(const Request& request, Takes takes) {
    if (takes == Takes::nothing) return std::nullopt;
    for (const auto& [name, value] : request.headers.fields) {
        if (lower(name) != "content-encoding") continue;
        for (std::string_view rest = value; !rest.empty();) {
            const auto coding = trimmed(next_item(rest));
            if (coding.empty() || lower(coding) == "identity") continue;
            Response r = problem(415, "unsupported_media_type",
                                 fmt::format("the body comes with Content-Encoding: {}: send it as it is, without one", coding));
            r.headers.set("Accept-Encoding", "identity");
            return r;
        }
    }
    return std::nullopt;
}

/// Reads the body if the route takes JSON, and returns its faults. Handlers read tables and files.
std::optional<Response> read_body(const Request& request, Takes takes, json::value& into) {
    const bool json_file = takes == Takes::eds && media_of(request.headers.get("Content-Type")) == "application/json";
    if (takes != Takes::json && takes != Takes::patch && !json_file) return std::nullopt;
    JsonFault unread;
    auto value = read_json(request.body, unread);
    if (!value && unread.twice) {
        return to_response(Problem{.status = 400,
                                   .reason = "bad_request",
                                   .detail = fmt::format("{} ({}, line {}): keep one of them", unread.text, unread.pointer, unread.line),
                                   .faults = {{unread.pointer, unread.text, "keep one of them"}}});
    }
    if (!value) return problem(400, "bad_request", fmt::format("the body is not JSON: {}", unread.text));
    into = std::move(*value);
    if (!into.is_object()) return problem(400, "bad_request", "the body must be a JSON object");
    return std::nullopt;
}

/// Checks the names of the query: each must be one of the route's, and none may occur twice.
std::optional<Response> check_query(const Query& query, std::string_view known) {
    const auto is_known = [known](std::string_view name) {
        for (std::string_view rest = known; !rest.empty();) {
            const auto end = std::min(rest.find(' '), rest.size());
            if (rest.substr(0, end) == name) return true;
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        return false;
    };
    std::string list;
    for (const char x : known)
        x == ' ' ? list += ", " : list += x;
    for (std::size_t i = 0; i < query.pairs.size(); ++i) {
        const auto& name = query.pairs[i].first;
        if (!is_known(name)) {
            const auto shown = name.size() > 100 ? name.substr(0, 100) : name;
            return problem(400, "bad_request",
                           known.empty() ? fmt::format("\"{}\" is not known here: this takes no query", shown)
                                         : fmt::format("\"{}\" is not known here: the query may have {}", shown, list));
        }
        for (std::size_t k = 0; k < i; ++k) {
            if (query.pairs[k].first == name) return problem(400, "bad_request", fmt::format("{} stands twice in the query", name));
        }
    }
    return std::nullopt;
}

}  // namespace axisgate::http
