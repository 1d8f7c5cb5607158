// Register image: every unit of registers that the gateway has: the standard map and the user maps of the site in force.
// In: sites, samples, requests of any door. Out: the map behind a unit id; reads answered at once.
// Never belongs to a protocol: it is there without any door that serves registers, and all of them see the same one.
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

/// Told when a map is about to go: nobody may ask it any more.
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
    /// Readings of mapped parameters on their way at once, of all units; what is beyond waits for the next request.
    static constexpr std::size_t most_readings = 2048;
    static constexpr Duration reading_limit = std::chrono::seconds(30);  ///< then it counts as without an answer

    RegisterImage(DoorPort& port, Settings settings);
    ~RegisterImage() override;
    RegisterImage(const RegisterImage&) = delete;
    RegisterImage& operator=(const RegisterImage&) = delete;

    /// nullptr: nothing stands behind this unit.
    [[nodiscard]] UnitMap* unit(std::uint8_t id) noexcept { return maps_[id]; }
    [[nodiscard]] bool is_standard(std::uint8_t id) const noexcept { return maps_[id] == &standard_; }
    [[nodiscard]] StandardMap& standard() noexcept { return standard_; }
    [[nodiscard]] WordOrder word_order() const noexcept { return settings_.word_order; }
    [[nodiscard]] const Languages& languages() const noexcept { return settings_.languages; }

    /// For a reader that is no door of its own. 1..2000 bits or 1..125 registers from `address` on, which end at 65535 at the latest.
    [[nodiscard]] RegisterRead read(std::uint8_t unit, Table table, std::uint16_t address, std::uint16_t count);

    /// Puts a map behind a unit id (2..254), or takes it away (nullptr). The map outlives its being there.
    void set_map(std::uint8_t unit, UnitMap* map);
    /// The user maps of a site, instead of those of before.
    void set_mappings(std::vector<PlacedMapping> mappings, const std::map<std::uint8_t, MapGaps>& gaps);
    /// The profiles of a site, instead of those of before; they go on as they were where nothing of them has changed.
    void set_profiles(const SiteState& site);
    /// A command that a map gives by itself; its result comes to map.on_own_result(note). False: no place is free.
    [[nodiscard]] bool ask_for(UnitMap& map, PlannedCommand command);
    /// Who keeps pointers to maps. It must be removed before it ends.
    void add_user(MapUser& user) { users_.push_back(&user); }
    void remove_user(MapUser& user) { std::erase(users_, &user); }

    [[nodiscard]] std::span<const WayIn> ways_in() const override { return {}; }  // doors of registers have theirs
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
    std::vector<ProfileSpec> profile_specs_;  ///< those that profiles_ was made of ...
    std::map<std::uint8_t, MapGaps> profile_gaps_;
    std::vector<PlacedProfileAxis> profile_axes_;  ///< ... and their axes, one after another
    TicketTable readings_{most_readings};
    std::vector<MapUser*> users_;
};

}  // namespace axisgate::registers
