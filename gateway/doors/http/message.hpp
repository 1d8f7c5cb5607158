// Message: a request and a response as values, and the shape of a handler's answer, which may come later.
// In: made by the connection from bytes, or by a test. Out: read by the router and the handlers.
// Never holds a socket: the same values go through the router in a test and in service.
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
    std::string target;  ///< as it came: "/api/v1/axes/feeder?x=1"
    bool http_1_0 = false;
    Headers headers;
    std::string body;
    std::optional<std::uint64_t> announced_bytes{};  ///< Content-Length; nothing: none, or chunks
    std::string peer;                                ///< "192.0.2.7:51123"
    bool secure = false;                             ///< came over TLS
};

struct Response {
    unsigned status = 200;
    Headers headers;
    std::string body;
    /// The body is only measured, not sent (answers to HEAD, and 304).
    bool without_body = false;
    bool changed_nothing = false;  ///< though it is a good answer to what could have: there is nothing to write down
    /// Of an error, what the body says, for whoever writes it down.
    struct Told {
        std::string reason, detail, axis;
    } told{};
};

using Respond = std::function<void(Response)>;

/// What a handler gives back: an answer now, or a promise that its Respond will be called once, and what to say if it is not in time.
struct Handled {
    std::optional<Response> now;
    std::chrono::nanoseconds limit{};  ///< if `now` is empty: answer `at_limit` when this has passed without a call
    Response at_limit;
    std::optional<bool> known{};      ///< whether it came from somebody: signed in, a token, or this machine; nothing: not looked at
    bool commands = false;            ///< of a route that may set something in motion
    std::string_view route = "none";  ///< for a counter, set by the router: a path of its table, "static" for files, "none"

    Handled() = default;
    Handled(Response response) : now(std::move(response)) {}  // NOLINT(google-explicit-constructor): a response is an answer
    Handled(std::chrono::nanoseconds wait, Response otherwise) : limit(wait), at_limit(std::move(otherwise)) {}
};

}  // namespace axisgate::http
