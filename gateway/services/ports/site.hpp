// The site in force, the families that it may name, its changes and its history. Results come by callbacks on the service thread; listeners
// get each site that comes into force. Calls wait for local reads of the database at most.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/records.hpp"
#include "gateway/site/site.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

struct SiteListener {
    /// The site has changed: names and ids must be looked up again.
    virtual void on_site(const std::shared_ptr<const SiteState>& site) = 0;
    virtual ~SiteListener() = default;
};

/// The outcome of an attempt to put a site in force.
struct SiteAnswer {
    bool good = false;
    std::string fault;                     ///< the reason why it could not be stored or applied
    std::shared_ptr<const SiteState> now;  ///< the site in force afterwards
    bool not_stored = false;               ///< the database could not store it
};

class SitePort {
public:
    virtual ~SitePort() = default;
    [[nodiscard]] virtual std::shared_ptr<const SiteState> site() const = 0;
    [[nodiscard]] virtual const Families& families() const = 0;
    /// Puts a checked site in force: stored first, then applied without a restart; only changed parts are disturbed. `expected_revision`:
    /// refuse if the site has another revision by now (0: any).
    virtual void apply_site(Site site, std::uint64_t expected_revision, Origin origin, std::function<void(SiteAnswer)> then) = 0;
    /// Newest first, without the documents, at most `limit`; with `before` only smaller numbers.
    [[nodiscard]] virtual std::vector<SiteRevision> site_history(std::size_t limit, std::uint64_t before) const = 0;
    [[nodiscard]] virtual std::optional<SiteRevision> site_revision(std::uint64_t revision) const = 0;
    virtual void listen(SiteListener* listener) = 0;
    virtual void unlisten(SiteListener* listener) = 0;
};

}  // namespace axisgate
