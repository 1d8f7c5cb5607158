// SiteInForce compares a new site with the present one and keeps, makes or removes lines, drives and axes. Unchanged ones are never
// disturbed.
#pragma once

#include <map>
#include <string>

#include "gateway/engine/machine.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate::engine {

class SiteInForce {
public:
    SiteInForce(Machine& machine, Pending& pending, Publisher& publisher, Speakers& speakers, Twins& twins, Presences& presences,
                Clients& clients, Scans& scans)
        : machine_(machine),
          pending_(pending),
          publisher_(publisher),
          speakers_(speakers),
          twins_(twins),
          presences_(presences),
          clients_(clients),
          scans_(scans) {}
    std::shared_ptr<const SiteState> put(Site site, SiteMemory memory, std::uint64_t revision, Instant now);

private:
    struct Ids {
        std::map<std::string, LineId> lines;
        std::map<std::string, DriveId> drives;
        std::map<std::string, AxisId> axes;
    };
    [[nodiscard]] Ids ids_in_force() const;
    [[nodiscard]] std::vector<std::unique_ptr<Axis>> take_away(const Site& old, const KeptParts& kept, const Ids& ids);
    [[nodiscard]] std::vector<LineUnit*> add_lines(const Site& site, const Ids& ids, SiteState& state);
    [[nodiscard]] std::vector<Drive*> add_drives(const Site& site, const Ids& ids, const SiteMemory& memory, SiteState& state, Instant now);
    [[nodiscard]] std::unique_ptr<Axis> new_axis(AxisId id, const AxisSpec& spec, const SiteMemory& memory);
    void add_axes(const Site& site, const Ids& ids, const SiteMemory& memory, SiteState& state);
    void put_to_work(std::span<LineUnit* const> fresh_lines, std::span<Drive* const> fresh_drives, Instant now);
    void drop_axis(Axis& axis, std::string_view why);
    void tell_options(std::span<LineUnit* const> lines, std::span<Drive* const> drives, Instant now);

    Machine& machine_;
    Pending& pending_;
    Publisher& publisher_;
    Speakers& speakers_;
    Twins& twins_;
    Presences& presences_;
    Clients& clients_;
    Scans& scans_;
};

}  // namespace axisgate::engine
