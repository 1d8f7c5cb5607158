// Router: from a request to the handler of its route, with everything that holds for all routes: hosts, origins, methods, media types.
// In: a Request. Out: Handled: an answer, or a promise of one through the Respond that came with the request.
// Never touches a socket. The routes are a table, so that a test can compare it with schema/openapi.yaml.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "gateway/doors/http/access_gate.hpp"
#include "gateway/doors/http/audit.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/hosts.hpp"

namespace axisgate::http {

struct Route {
    enum class Takes : std::uint8_t {
        nothing,
        json,
        patch,
        csv,
        bytes,
        eds
    };  ///< patch: also application/merge-patch+json; csv, bytes: the handler reads it; eds: a file as it is, or JSON that holds it
    enum class Gives : std::uint8_t { json, text, yaml, nothing, own };  ///< own: the handler looks at Accept itself

    std::string_view path;  ///< as the description writes it: "/api/v1/axes/{axis}/commands"
    Method method = Method::get;
    Handler handler = nullptr;
    Takes takes = Takes::nothing;
    Gives gives = Gives::json;
    bool same_origin_only = false;  ///< even though it is a GET: the live feed
    /// The lowest role that may; nothing: viewer for GET, engineer for all other methods. Role::none: open to all. Where it depends on the
    /// body, the table has the lowest one and the handler asks for more with refuse_below.
    std::optional<Role> least = std::nullopt;
    /// Names that its query may have, with blanks between them; any other is refused with 400, so that nobody believes in a `dry_run` or
    /// a filter that does not exist. What a value may be is the handler's.
    std::string_view query = {};
    /// The event that a good answer leaves: what no handler, service or engine tells of. In the text `{}` is the next name of the path,
    /// `{word}` a text of the body.
    std::string_view event_kind = {}, event_text = {};
    bool commands = false;  ///< may set something in motion: the connection is then a path on which it is stopped

    [[nodiscard]] constexpr Route asks(std::string_view names) const {
        Route r = *this;
        r.query = names;
        return r;
    }
    [[nodiscard]] constexpr Route moves() const {
        Route r = *this;
        r.commands = true;
        return r;
    }
    [[nodiscard]] constexpr Route leaves(std::string_view kind, std::string_view text) const {
        Route r = *this;
        r.event_kind = kind;
        r.event_text = text;
        return r;
    }
    [[nodiscard]] constexpr Route needs(Role role) const {
        Route r = *this;
        r.least = role;
        return r;
    }
    [[nodiscard]] constexpr Role needed() const { return least.value_or(method == Method::get ? Role::viewer : Role::engineer); }
};

/// What is known of a request before its body has been read.
struct Admission {
    std::optional<Response> refusal;  ///< the answer, if the body is not wanted
    std::size_t max_body_bytes = 0;   ///< otherwise: of the body
};

/// Every route of this door, HEAD and OPTIONS apart: those follow from these.
[[nodiscard]] std::span<const Route> all_routes() noexcept;

class Router {
public:
    explicit Router(Context context) : context_(std::move(context)), audit_(std::make_shared<Audit>(context_.ports.get<EventPort>())) {}

    /// `respond` is called at most once, later, and only if the answer is not in the result. It may be called after the promise's limit:
    /// then it is the caller's to ignore it.
    [[nodiscard]] Handled handle(const Request& request, Respond respond) const;
    /// Everything that is decided without the body: host, route, role, CSRF, origin, announced length, query, media type. A refusal here is
    /// the one that handle() would give, and is written down as there. Changes nothing: no session is renewed by it.
    [[nodiscard]] Admission admit(const Request& head) const;
    /// Whether it may set something in motion, or stop it: such a request is taken up before all others.
    [[nodiscard]] bool moves(const Request& request) const;
    /// Why a live feed that was opened by this request may not go on, for its close frame; empty: its session or token still holds.
    [[nodiscard]] std::string_view why_not_watched_on(const Request& request) const;
    /// Who commands over a live feed that was opened by this request; nothing: it has no role that may.
    [[nodiscard]] std::optional<Origin> commander_of(const Request& request) const;
    /// The route's path for a counter: as in the table, "static" for files, "none" where nothing matched.
    [[nodiscard]] std::string_view route_of(const Request& request) const;
    [[nodiscard]] Audit& audit() const noexcept { return *audit_; }

private:
    struct Entry;
    [[nodiscard]] Handled dispatch(const Request& request, std::optional<Target> target, const Respond& respond, Audit::Asked& asked) const;
    void fill(Audit::Asked& asked, const Request& request, const Entry& entry) const;
    [[nodiscard]] Entry enter(const Request& head, std::optional<Target> target, bool touch) const;
    [[nodiscard]] std::size_t most_bytes(const Route& route, const Identity& identity) const noexcept;
    [[nodiscard]] std::optional<Response> check_host(const Request& request) const;
    [[nodiscard]] static std::optional<Response> check_origin(const Request& request);
    static void finish(Response& response, bool is_head);

    Context context_;
    std::shared_ptr<Audit> audit_;  // kept by answers that come late
};

}  // namespace axisgate::http
