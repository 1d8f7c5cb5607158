// Plays the whole matrix of loss of command on models, cell by cell, and stores the dated reports as documents. Bounds: one rehearsal at a
// time; a limited number of reports. A rehearsal that the end of the gateway interrupts leaves no report.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/rehearsal.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

/// One cell as shown by the API.
[[nodiscard]] boost::json::object to_json(const RehearsalCell& cell);

class Rehearsals : public std::enable_shared_from_this<Rehearsals> {
public:
    static constexpr std::size_t kept = 20;  ///< number of reports; a new one replaces the oldest

    using Needs = PortSet<ClockPort, DocumentPort, EventPort, RehearsalPort, SitePort>;
    explicit Rehearsals(const Needs& ports)
        : clock_(ports.get<ClockPort>()),
          documents_(ports.get<DocumentPort>()),
          events_(ports.get<EventPort>()),
          player_(ports.get<RehearsalPort>()),
          sites_(ports.get<SitePort>()) {}

    /// Plays every cause for these axes (all if none is named), and the drives' reaction when the gateway is gone without notice. `steps`
    /// are the disturbances of each cell, where possible. Empty if it has begun, otherwise the reason why not.
    [[nodiscard]] std::string start(std::vector<std::string> axes, RehearsalSteps steps, const Origin& origin);
    /// {"state": "none" | "running" | "done", "done", "total", "report"}: the report is the last complete one.
    [[nodiscard]] boost::json::object state() const;
    [[nodiscard]] bool running() const noexcept { return run_.has_value(); }

private:
    struct Run {
        std::shared_ptr<const SiteState> site;
        std::deque<RehearsalWish> left;
        RehearsalSteps steps{};
        std::vector<RehearsalCell> cells;
        std::vector<std::string> left_out;  ///< axes whose drives cannot follow set-points, so that this cause does not apply
        std::size_t total = 0;
        std::string who;
        std::int64_t began_unix_ns = 0;
    };
    [[nodiscard]] bool streams(const SiteState& state, const std::string& axis) const;
    void next();
    void end();

    ClockPort& clock_;
    DocumentPort& documents_;
    EventPort& events_;
    RehearsalPort& player_;
    SitePort& sites_;
    std::optional<Run> run_;
    mutable std::optional<boost::json::object> last_;  ///< as read from the store, or made
};

}  // namespace axisgate
