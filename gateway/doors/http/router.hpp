// From a request to the handler of its route, with the rules for all routes: hosts, origins, methods, media types. The result is an answer,
// or a promise of one through the request's Respond. The routes are a table that a test compares with schema/openapi.yaml.
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
    };  ///< patch: also application/merge-patch+json; csv, bytes: the handler reads it; eds: a file, or JSON that contains it
    enum class Gives : std::uint8_t { json, text, yaml, nothing, own };  ///< own: the handler reads Accept itself

    std::string_view path;  ///< as in the description: "/api/v1/axes/{axis}/commands"
    Method method = Method::get;
    Handler handler = nullptr;
    Takes takes = Takes::nothing;
    Gives gives = Gives::json;
    bool same_origin_only = false;  ///< although it is a GET: the live feed
    /// The lowest sufficient role; empty: viewer for GET, engineer for all other methods. Role::none: open to all. If it depends on the
    /// body, the table has the lowest one and the handler checks the rest with refuse_below.
    std::optional<Role> least = std::nullopt;
    /// The names of its query, separated by blanks; any other is refused with 400, so that nobody relies on a `dry_run` or a filter that
    /// does not exist. Values are checked by the handler.
    std::string_view query = {};
    /// The event for a good answer, if no handler, service or engine reports it. In the text `{}` is the next name of the path, `{word}` a
    /// text of the body.
    std::string_view event_kind = {}, event_text = {};
    bool commands = false;  ///< may start a motion: the connection is then one over which the motion can be stopped

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

/// The decision about a request before its body is read.
struct Admission {
    std::optional<Response> refusal;  ///< the answer, if the body is not wanted
    std::size_t max_body_bytes = 0;   ///< otherwise the limit of the body
};

/// Every route of this door, without HEAD and OPTIONS, which follow from these.
[[nodiscard]] std::span<const Route> all_routes() noexcept;

class Router {
public:
    explicit Router(Context context) : context_(std::move(context)), audit_(std::make_shared<Audit>(context_.ports.get<EventPort>())) {}

    /// `respond` is called at most once, later, and only if the result has no answer. It may be called after the promise's limit; the
    /// caller must ignore it then.
    [[nodiscard]] Handled handle(const Request& request, Respond respond) const;
    /// Everything that is decided without the body: host, route, role, CSRF, origin, announced length, query, media type. A refusal here is
    /// the one of handle(), with the same event. Nothing is changed, and no session is renewed.
    [[nodiscard]] Admission admit(const Request& head) const;
    /// True if it may start or stop a motion: such a request is served before all others.
    [[nodiscard]] bool moves(const Request& request) const;
    /// The reason why a live feed that was opened by this request must be closed, for its close frame; empty: its session or token is still
    /// valid.
    [[nodiscard]] std::string_view why_not_watched_on(const Request& request) const;
    /// The client that commands over a live feed opened by this request; empty: it has no sufficient role.
    [[nodiscard]] std::optional<Origin> commander_of(const Request& request) const;
    /// The route's path for a counter: as in the table, "static" for files, "none" if nothing matched.
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
    std::shared_ptr<Audit> audit_;  // kept alive by late answers
};

}  // namespace axisgate::http
