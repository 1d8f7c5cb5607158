// One table from the reason of a refusal to its HTTP status and title. Texts that may repeat a client's input are cut at 1024 bytes.
#include "gateway/doors/http/problem.hpp"

#include <fmt/core.h>

#include <utility>

#include "gateway/doors/http/preconditions.hpp"
#include "gateway/doors/http/text.hpp"

namespace axisgate::http {
namespace json = boost::json;

namespace {
constexpr std::size_t most_text_bytes = 1024;  // of one text, because it may repeat the client's input

/// The beginning of a long text, cut between two characters.
std::string shortened(const std::string& text) {
    if (text.size() <= most_text_bytes) return text;
    std::size_t end = most_text_bytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
        --end;
    return text.substr(0, end) + "...";
}
}  // namespace

json::object fault_document(const Fault& f) {
    return {{"document", f.in_body ? "body" : "site"},
            {"pointer", shortened(f.pointer)},
            {"text", shortened(f.text)},
            {"remedy", shortened(f.remedy)}};
}

Response to_response(const Problem& p) {
    std::string title = p.reason;
    for (auto& c : title)
        c = c == '_' ? ' ' : c;
    if (!title.empty() && title[0] >= 'a' && title[0] <= 'z') title[0] = static_cast<char>(title[0] - 'a' + 'A');
    json::object o{{"type", "urn:axisgate:problem:" + p.reason}, {"title", title}, {"status", p.status}, {"detail", shortened(p.detail)}};
    o["code"] = p.code == 0 ? json::value(nullptr) : json::value(p.code);
    o["reason"] = p.reason;
    if (!p.axis.empty()) o["axis"] = p.axis;
    if (!p.faults.empty()) {
        json::array list;
        for (const auto& f : p.faults) {
            if (list.size() == most_faults) break;
            list.push_back(fault_document(f));
        }
        const std::size_t more = p.faults.size() - list.size() + p.more_faults;
        o["faults"] = std::move(list);
        o["more_faults"] = more;
    }
    for (const auto& [k, v] : p.more)
        o[k] = v;
    Response r;
    r.status = p.status;
    r.headers.set("Content-Type", "application/problem+json");
    if (p.status == 503) r.headers.set("Retry-After", "1");
    r.body = json_text(o);
    r.told = {p.reason, shortened(p.detail), p.axis};
    return r;
}

Response problem_of(const ServiceRefusal& r) {
    using Why = ServiceRefusal::Why;
    const auto [status, reason] = [&]() -> std::pair<unsigned, const char*> {
        switch (r.why) {
            case Why::not_found:
                return {404, "not_found"};
            case Why::unknown_point:
                return {404, "unknown_point"};
            case Why::unreadable:
                return {400, "bad_request"};
            case Why::invalid:
                return {422, "invalid"};
            case Why::out_of_range:
                return {422, "out_of_range"};
            case Why::not_writable:
                return {409, "not_writable"};
            case Why::conflict:
                break;
            case Why::overtaken:
                return {412, "precondition_failed"};
            case Why::stage_taken:
                return {409, "stage_taken"};
            case Why::stage_replaced:
                return {409, "stage_replaced"};
            case Why::too_many:
                return {409, "too_many"};
            case Why::in_use:
                return {409, "busy"};
            case Why::running:
                return {409, "running"};
            case Why::not_simulated:
                return {409, "not_simulated"};
            case Why::wrong_state:
                return {409, "wrong_state"};
            case Why::overloaded:
                return {503, "busy"};
            case Why::no_answer:
                return {504, "no_answer"};
            case Why::not_stored:
                return {507, "not_stored"};
        }
        return {409, "conflict"};
    }();
    Problem p{.status = status, .reason = reason, .detail = r.text, .axis = r.axis, .faults = r.faults};
    const std::string tag = r.revision != 0 ? site_tag(r.revision) : r.tag;
    if (r.why == Why::overtaken) p.more["etag"] = text_or_null(tag);
    for (const auto& [k, v] : r.more)
        p.more[k] = v;
    Response answer = to_response(p);
    if (!tag.empty()) answer.headers.set("ETag", tag);
    if (r.revision != 0) answer.headers.set("Site-Revision", std::to_string(r.revision));
    return answer;
}

Response problem(unsigned status, std::string_view reason, std::string detail) {
    return to_response(Problem{.status = status, .reason = std::string(reason), .detail = std::move(detail)});
}

Response invalid(std::vector<Fault> faults, std::string_view axis, std::string_view reason, std::size_t more) {
    std::string detail = first_of(faults, more);
    return to_response(Problem{.status = 422,
                               .reason = std::string(reason),
                               .detail = std::move(detail),
                               .axis = std::string(axis),
                               .faults = std::move(faults),
                               .more_faults = more});
}

unsigned status_of(Reason reason) noexcept {
    switch (reason) {
        case Reason::out_of_range:
            return 422;
        case Reason::unknown_point:
            return 404;
        case Reason::not_writable:
        case Reason::wrong_state:
        case Reason::not_supported:
        case Reason::drive_refused:
        case Reason::interrupted:
        case Reason::authority:
            return 409;
        case Reason::busy:
        case Reason::line_down:
            return 503;
        case Reason::no_answer:
            return 504;
        case Reason::not_stored:
            return 507;
        case Reason::none:  // a refusal without a reason is a fault of the gateway
        case Reason::internal:
            return 500;
    }
    return 500;
}

std::int64_t shown(Ticket ticket) noexcept {
    // The upper byte of a ticket is its door; the rest increases from 1.
    return static_cast<std::int64_t>(ticket & 0x001F'FFFF'FFFF'FFFFull);
}

Response problem_of(const Result& result, std::string_view axis, std::string_view command) {
    Problem p;
    p.status = status_of(result.reason);
    p.reason = std::string(name_of(result.reason == Reason::none ? Reason::internal : result.reason));
    p.detail = !result.text.empty() ? result.text : fmt::format("{}: {}", command, p.reason);
    p.code = result.code;
    p.axis = std::string(axis);
    p.more["ticket"] = result.ticket == no_ticket ? json::value(nullptr) : json::value(shown(result.ticket));
    p.more["result"] = std::string(name_of(result.outcome));
    p.more["command"] = std::string(command);
    return to_response(p);
}

std::string_view phrase_of(unsigned status) noexcept {
    switch (status) {
        case 101:
            return "Switching Protocols";
        case 200:
            return "OK";
        case 201:
            return "Created";
        case 204:
            return "No Content";
        case 304:
            return "Not Modified";
        case 400:
            return "Bad Request";
        case 401:
            return "Unauthorized";
        case 403:
            return "Forbidden";
        case 404:
            return "Not Found";
        case 405:
            return "Method Not Allowed";
        case 406:
            return "Not Acceptable";
        case 408:
            return "Request Timeout";
        case 409:
            return "Conflict";
        case 412:
            return "Precondition Failed";
        case 413:
            return "Content Too Large";
        case 415:
            return "Unsupported Media Type";
        case 417:
            return "Expectation Failed";
        case 421:
            return "Misdirected Request";
        case 422:
            return "Unprocessable Content";
        case 426:
            return "Upgrade Required";
        case 428:
            return "Precondition Required";
        case 429:
            return "Too Many Requests";
        case 431:
            return "Request Header Fields Too Large";
        case 500:
            return "Internal Server Error";
        case 501:
            return "Not Implemented";
        case 503:
            return "Service Unavailable";
        case 504:
            return "Gateway Timeout";
        case 505:
            return "HTTP Version Not Supported";
        case 507:
            return "Insufficient Storage";
        default:
            return "Status";
    }
}

Response json_response(const json::value& document, unsigned status) {
    Response r;
    r.status = status;
    r.headers.set("Content-Type", "application/json");
    r.body = json_text(document);
    return r;
}

}  // namespace axisgate::http
