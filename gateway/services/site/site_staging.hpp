// Site staging: a site that is staged, applied on trial, confirmed or taken back, by whom it may be, and the site's history.
// In: documents, who wants what, in which session. Out: the stage as a document with what it changes, disturbs and closes; refusals.
// Never changes a site at once: what is staged is applied as one, and taken back unless it is confirmed by who applied it, from where he
// did.
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
    std::optional<std::string> stage{};  ///< the id of the one that is meant; nothing: whichever is there
    std::int64_t confirm_within_s = 60;  ///< 0: for good
};
[[nodiscard]] ApplyWish read_apply_wish(const boost::json::object& body, std::vector<Fault>& faults);

[[nodiscard]] boost::json::object document_of(const ClientConnection& connection);

/// A value: whoever has the ports and the owner makes one.
class SiteStaging {
public:
    using Needs = PortSet<ClockPort, ConnectionPort, SitePort, StagePort>;
    using Ended = std::function<void(std::optional<ServiceRefusal>)>;
    SiteStaging(const Needs& ports, std::shared_ptr<StageOwner> owner) : ports_(ports), owner_(std::move(owner)) {}

    [[nodiscard]] SiteStage::State state() const { return now().state(); }
    /// `closes`: connections that a staged site would close; nothing: nobody could say.
    [[nodiscard]] boost::json::object document(const ConnectionPort::List& closes = std::vector<ClientConnection>{}) const;
    /// The same of a site that may be staged: the doors are asked which connections it would close. Called once, perhaps at once.
    void ask(std::function<void(boost::json::object)> then) const;

    /// Another client's stage is not replaced in silence.
    [[nodiscard]] std::optional<ServiceRefusal> refuse_taken(const Origin& origin) const;
    [[nodiscard]] std::optional<ServiceRefusal> stage(const boost::json::value& document, const Origin& origin) const;
    [[nodiscard]] std::optional<ServiceRefusal> discard() const;
    /// `session`: in which the client is signed in (session_of). `then` is called once, perhaps at once.
    void apply(const ApplyWish& wish, const Origin& origin, std::string session, Ended then) const;
    void confirm(const Origin& origin, const std::string& session, Ended then) const;
    void roll_back(const Origin& origin, Ended then) const;

private:
    [[nodiscard]] const SiteStage& now() const { return ports_.get<StagePort>().site_stage(); }
    [[nodiscard]] std::string stager_text() const;

    Needs ports_;
    std::shared_ptr<StageOwner> owner_;
};

/// Newest first, without the documents; with `before` those of smaller numbers.
[[nodiscard]] boost::json::array site_history(const SitePort& sites, std::size_t limit, std::uint64_t before);
/// The document of a revision by its number in words.
[[nodiscard]] Refusable<boost::json::value> site_revision(const SitePort& sites, std::string_view number);

}  // namespace axisgate
