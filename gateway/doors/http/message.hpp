// A request and a response as values, and the form of a handler's answer, which may come later. There is no socket, so the router works in
// the same way in a test and in service.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace axisgate::http {

enum class Method : std::uint8_t { get, head, post, put, patch, remove, options, other };
[[nodiscard]] std::string_view name_of(Method method) noexcept;
/// Methods are case-sensitive (RFC 9110 9.1).
[[nodiscard]] Method method_named(std::string_view name) noexcept;

struct Headers {
    std::vector<std::pair<std::string, std::string>> fields;
    /// Value of the first field of that name, case-insensitive; empty if there is none.
    [[nodiscard]] std::string_view get(std::string_view name) const noexcept;
    [[nodiscard]] std::size_t count(std::string_view name) const noexcept;
    void set(std::string_view name, std::string value);
    void remove(std::string_view name);
};

struct Request {
    Method method = Method::get;
    std::string target;  ///< as received: "/api/v1/axes/feeder?x=1"
    bool http_1_0 = false;
    Headers headers;
    std::string body;
    std::optional<std::uint64_t> announced_bytes{};  ///< Content-Length; empty: none, or chunks
    std::string peer;                                ///< "192.0.2.7:51123"
    bool secure = false;                             ///< received over TLS
};

struct Response {
    unsigned status = 200;
    Headers headers;
    std::string body;
    /// The body is only measured, not sent (answers to HEAD, and 304).
    bool without_body = false;
    bool changed_nothing = false;  ///< although it is a good answer to a request that could change something: no event is necessary
    /// For an error, the content of the body for the event.
    struct Told {
        std::string reason, detail, axis;
    } told{};
};

using Respond = std::function<void(Response)>;

/// The result of a handler: an answer now, or a promise that its Respond will be called once, with the answer for the case that it is late.
struct Handled {
    std::optional<Response> now;
    std::chrono::nanoseconds limit{};  ///< if `now` is empty: `at_limit` is the answer after this time without a call
    Response at_limit;
    std::optional<bool> known{};      ///< whether the client is known: signed in, a token, or this machine; empty: not determined
    bool commands = false;            ///< of a route that may start a motion
    std::string_view route = "none";  ///< for a counter, set by the router: a path of its table, "static" for files, "none"

    Handled() = default;
    Handled(Response response) : now(std::move(response)) {}  // NOLINT(google-explicit-constructor): a response is an answer
    Handled(std::chrono::nanoseconds wait, Response otherwise) : limit(wait), at_limit(std::move(otherwise)) {}
};

}  // namespace axisgate::http
