// Rehearsals: the whole matrix of loss of command played on models, cell by cell, and the dated reports that come of it.
// In: a start by somebody. Out: progress, and the last reports, kept as documents. Bounds: one rehearsal at a time; so many reports kept;
// a rehearsal that the gateway's end cuts off leaves no report.
// Never moves anything: the port plays on models of its own.
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

/// One cell as the API shows it.
[[nodiscard]] boost::json::object to_json(const RehearsalCell& cell);

class Rehearsals : public std::enable_shared_from_this<Rehearsals> {
public:
    static constexpr std::size_t kept = 20;  ///< reports; the oldest make room

    using Needs = PortSet<ClockPort, DocumentPort, EventPort, RehearsalPort, SitePort>;
    explicit Rehearsals(const Needs& ports)
        : clock_(ports.get<ClockPort>()),
          documents_(ports.get<DocumentPort>()),
          events_(ports.get<EventPort>()),
          player_(ports.get<RehearsalPort>()),
          sites_(ports.get<SitePort>()) {}

    /// Every cause of these axes, and what their drives do when the gateway is gone without a word; of all where none is named. `steps`:
    /// what else happens in each cell where it can. Empty: it has begun; else why not.
    [[nodiscard]] std::string start(std::vector<std::string> axes, RehearsalSteps steps, const Origin& origin);
    /// {"state": "none" | "running" | "done", "done", "total", "report"}: the report is the last one that is complete.
    [[nodiscard]] boost::json::object state() const;
    [[nodiscard]] bool running() const noexcept { return run_.has_value(); }

private:
    struct Run {
        std::shared_ptr<const SiteState> site;
        std::deque<RehearsalWish> left;
        RehearsalSteps steps{};
        std::vector<RehearsalCell> cells;
        std::vector<std::string> left_out;  ///< axes whose drives follow no set-points: that cause is none of theirs
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
    mutable std::optional<boost::json::object> last_;  ///< as it was read or made
};

}  // namespace axisgate
