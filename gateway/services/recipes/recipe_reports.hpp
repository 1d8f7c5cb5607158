// The stored reports of the runs of recipes: increasing numbers, the reports of the last 20 runs, and runs that a restart has ended.
// Bounds: 20 reports of each recipe; 64 finished ones on their way to the disk; one document of less than 1 MiB each. Reports that are not
// on the disk yet are answered from memory.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/port_set.hpp"

namespace axisgate {

class RecipeReports : public std::enable_shared_from_this<RecipeReports> {
public:
    static constexpr std::size_t kept = 20;  ///< of each recipe, including the run in progress
    static constexpr std::size_t most_unsaved = 64;

    using Needs = PortSet<ClockPort, DocumentPort, EventPort>;
    explicit RecipeReports(const Needs& ports)
        : clock_(ports.get<ClockPort>()), documents_(ports.get<DocumentPort>()), events_(ports.get<EventPort>()) {}

    /// Once at the start: reports runs that were in progress when the gateway ended as interrupted.
    void begin();
    /// The number of the next run; the oldest reports are deleted for it.
    [[nodiscard]] std::uint64_t next(const std::string& name);
    /// Stores the present state of a run, which survives the program.
    void keep(const std::string& name, const std::string& who, const boost::json::object& report);
    /// A run has ended.
    void end(const std::string& name, std::uint64_t n, const std::string& who, boost::json::object report);
    /// Of finished runs, by number.
    [[nodiscard]] std::optional<boost::json::object> find(const std::string& name, std::uint64_t n) const;
    [[nodiscard]] std::map<std::uint64_t, boost::json::object> all(const std::string& name) const;
    /// Deletes the reports of a removed recipe.
    void forget(const std::string& name);
    /// Returns false if too many wait for the disk.
    [[nodiscard]] bool room() const noexcept { return unsaved_.size() < most_unsaved; }

private:
    [[nodiscard]] bool too_old(const std::string& name, std::uint64_t n) const;
    void remove(const std::string& name, std::uint64_t n);
    void saved(const std::string& name, std::uint64_t n, const std::string& fault);

    ClockPort& clock_;
    DocumentPort& documents_;
    EventPort& events_;
    std::map<std::string, std::uint64_t> last_;                                     ///< last numbers assigned in this process
    std::map<std::pair<std::string, std::uint64_t>, boost::json::object> unsaved_;  ///< finished, not on the disk yet
};

}  // namespace axisgate
