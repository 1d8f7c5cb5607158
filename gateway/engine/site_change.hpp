// A change of the site while axes move: axes that the new site removes or replaces are stopped first, while their line still works. The
// wait is bounded: a drive that cannot be stopped, or does not answer, does not prevent the change.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class SiteChange {
public:
    SiteChange(Machine& machine, Pending& pending, Publisher& publisher, Orders& orders, SiteInForce& site_in_force)
        : machine_(machine), pending_(pending), publisher_(publisher), orders_(orders), site_in_force_(site_in_force) {}
    std::shared_ptr<const SiteState> apply_at_once(Site site, SiteMemory memory, std::uint64_t revision, Instant now);
    void begin(Site site, SiteMemory memory, std::uint64_t revision, Instant now, Engine::Applied then);
    void check(Instant now);
    [[nodiscard]] bool waits() const noexcept { return change_ != nullptr; }

private:
    /// A site that comes into force as soon as the axes that it removes or replaces stand.
    struct Change {
        struct Stopped {
            AxisId axis = no_axis;
            Instant asked{};
        };
        Site site;
        SiteMemory memory;
        std::uint64_t revision = 0;
        Engine::Applied then;
        Instant until{};
        std::vector<Stopped> stopped;
    };
    void record(const Site& site, const SiteMemory& memory, std::uint64_t revision, bool at_once, Instant now);
    [[nodiscard]] bool awaits_answer(const Axis& axis) const;
    [[nodiscard]] bool under_way(const Axis& axis) const;
    void put_in_force(Instant now);

    Machine& machine_;
    Pending& pending_;
    Publisher& publisher_;
    Orders& orders_;
    SiteInForce& site_in_force_;
    std::unique_ptr<Change> change_;
};

}  // namespace axisgate::engine
