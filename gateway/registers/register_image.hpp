// All units of registers of the gateway: the standard map, and the user maps and profiles of the site in force. It belongs to no protocol,
// exists without any door, and is shared by all doors.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "gateway/engine/door.hpp"
#include "gateway/registers/profiles/profile_map.hpp"
#include "gateway/registers/standard_map.hpp"
#include "gateway/registers/ticket_table.hpp"
#include "gateway/registers/user_map.hpp"

namespace axisgate::registers {

/// Is informed before a map is destroyed, so that it drops its pointers.
struct MapUser {
    virtual void forget(const UnitMap& map) noexcept = 0;
    virtual ~MapUser() = default;
};

class RegisterImage final : public HotDoor {
public:
    struct Settings {
        WordOrder word_order = WordOrder::high_first;  ///< of the standard map
        MapGaps gaps = MapGaps::zero;                  ///< of units that the site does not name
        Languages languages{};                         ///< of the site's profiles; one whose page is absent is not served
    };
    /// Limit of outstanding reads of mapped parameters, of all units; further ones wait for the next request.
    static constexpr std::size_t most_readings = 2048;
    static constexpr Duration reading_limit = std::chrono::seconds(30);  ///< after this time a read counts as not answered

    RegisterImage(DoorPort& port, Settings settings);
    ~RegisterImage() override;
    RegisterImage(const RegisterImage&) = delete;
    RegisterImage& operator=(const RegisterImage&) = delete;

    /// nullptr if the unit has no map.
    [[nodiscard]] UnitMap* unit(std::uint8_t id) noexcept { return maps_[id]; }
    [[nodiscard]] bool is_standard(std::uint8_t id) const noexcept { return maps_[id] == &standard_; }
    [[nodiscard]] StandardMap& standard() noexcept { return standard_; }
    [[nodiscard]] WordOrder word_order() const noexcept { return settings_.word_order; }
    [[nodiscard]] const Languages& languages() const noexcept { return settings_.languages; }

    /// For readers that are not doors: 1..2000 bits or 1..125 registers from `address` on, which end at 65535 at the latest.
    [[nodiscard]] RegisterRead read(std::uint8_t unit, Table table, std::uint16_t address, std::uint16_t count);

    /// Assigns a map to a unit id (2..254), or removes it (nullptr). The map must outlive its assignment.
    void set_map(std::uint8_t unit, UnitMap* map);
    /// Replaces the user maps by those of a site.
    void set_mappings(std::vector<PlacedMapping> mappings, const std::map<std::uint8_t, MapGaps>& gaps);
    /// Replaces the profiles by those of a site; unchanged ones keep their state.
    void set_profiles(const SiteState& site);
    /// Gives a command of a map to the gateway; its result goes to map.on_own_result(note). Returns false if there is no free place.
    [[nodiscard]] bool ask_for(UnitMap& map, PlannedCommand command);
    /// Registers a keeper of pointers to maps. It must be removed before its destruction.
    void add_user(MapUser& user) { users_.push_back(&user); }
    void remove_user(MapUser& user) { std::erase(users_, &user); }

    [[nodiscard]] std::span<const WayIn> ways_in() const override { return {}; }  // the doors with registers have their own
    [[nodiscard]] std::string_view name() const override { return "registers"; }
    void on_result(const Result& result) override;
    void on_site(const SiteState& site) override;
    void on_sample(const Sample& sample) override;

private:
    void expire(Instant now);

    DoorPort& port_;
    Settings settings_;
    StandardMap standard_;
    std::array<UnitMap*, 256> maps_{};
    std::map<std::uint8_t, std::unique_ptr<UserMap>> user_maps_;
    std::map<std::uint8_t, std::unique_ptr<UnitMap>> profiles_;
    std::vector<ProfileSpec> profile_specs_;  ///< the specifications from which profiles_ was made
    std::map<std::uint8_t, MapGaps> profile_gaps_;
    std::vector<PlacedProfileAxis> profile_axes_;  ///< their axes, one after the other
    TicketTable readings_{most_readings};
    std::vector<MapUser*> users_;
};

}  // namespace axisgate::registers
