// A site that is staged, applied on trial, confirmed or rolled back, with the permissions for each step, and the site's history. A staged
// site is applied as a whole, and rolled back unless the client that applied it confirms it in the same session.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/connections.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/stage.hpp"
#include "gateway/services/refusal.hpp"
#include "gateway/services/site/stage_owner.hpp"

namespace axisgate {

struct ApplyWish {
    std::optional<std::string> stage{};  ///< the id of the stage that the request names; empty: the present one
    std::int64_t confirm_within_s = 60;  ///< 0: permanently
};
[[nodiscard]] ApplyWish read_apply_wish(const boost::json::object& body, std::vector<Fault>& faults);

[[nodiscard]] boost::json::object document_of(const ClientConnection& connection);

/// A value, made where the ports and the owner are available.
class SiteStaging {
public:
    using Needs = PortSet<ClockPort, ConnectionPort, SitePort, StagePort>;
    using Ended = std::function<void(std::optional<ServiceRefusal>)>;
    SiteStaging(const Needs& ports, std::shared_ptr<StageOwner> owner) : ports_(ports), owner_(std::move(owner)) {}

    [[nodiscard]] SiteStage::State state() const { return now().state(); }
    /// `closes` are connections that the staged site would close; empty: unknown.
    [[nodiscard]] boost::json::object document(const ConnectionPort::List& closes = std::vector<ClientConnection>{}) const;
    /// The same after asking the doors which connections it would close. Called once, perhaps at once.
    void ask(std::function<void(boost::json::object)> then) const;

    /// Refuses to replace another client's stage without `replace`.
    [[nodiscard]] std::optional<ServiceRefusal> refuse_taken(const Origin& origin) const;
    [[nodiscard]] std::optional<ServiceRefusal> stage(const boost::json::value& document, const Origin& origin) const;
    [[nodiscard]] std::optional<ServiceRefusal> discard() const;
    /// `session` is the one in which the client is signed in (session_of). `then` is called once, perhaps at once.
    void apply(const ApplyWish& wish, const Origin& origin, std::string session, Ended then) const;
    void confirm(const Origin& origin, const std::string& session, Ended then) const;
    void roll_back(const Origin& origin, Ended then) const;

private:
    [[nodiscard]] const SiteStage& now() const { return ports_.get<StagePort>().site_stage(); }
    [[nodiscard]] std::string stager_text() const;

    Needs ports_;
    std::shared_ptr<StageOwner> owner_;
};

/// Newest first, without the documents; with `before` only smaller numbers.
[[nodiscard]] boost::json::array site_history(const SitePort& sites, std::size_t limit, std::uint64_t before);
/// The document of a revision, whose number is given as text.
[[nodiscard]] Refusable<boost::json::value> site_revision(const SitePort& sites, std::string_view number);

}  // namespace axisgate
