// Freedoms are the choices that CiA 301 and CiA 402 leave to a drive, as the twin uses them: the values of the page's freedoms
// (schema/families/cia402.json, which has their ranges and descriptions) by the names that the page gives them. Without a value the drive
// answers and acts at once, has all objects, and its shaft is where it should be.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "gateway/core/freedom.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::cia402_drive::twin {

/// An object that a drive need not have, and the freedom that says whether it has it.
struct OptionalObject {
    std::string_view freedom;
    std::uint16_t index;
};
inline constexpr std::array<OptionalObject, 7> optional_objects{{{"has_6062h", 0x6062},
                                                                 {"has_606ch", 0x606C},
                                                                 {"has_6502h", 0x6502},
                                                                 {"has_605ah", 0x605A},
                                                                 {"has_1016h", 0x1016},
                                                                 {"has_60c2h", 0x60C2},
                                                                 {"has_1010h", 0x1010}}};

enum class PdoSetup : std::uint8_t { any_state, mapping_before_start, before_start, fixed_mapping, no_pdos };

struct Freedoms {
    Freedoms() = default;
    explicit Freedoms(const FreedomValues& values, std::uint64_t draws = 0) : shaft(shaft_freedoms(values)), seed(draws) {
        const auto of = [&](std::string_view name, std::int64_t fallback = 0) { return freedom(values, name, fallback); };
        const auto ms = [&](std::string_view name) -> Duration { return std::chrono::milliseconds(of(name)); };
        control_sample = ms("control_sample_ms");
        mode_shown = ms("mode_shown_ms");
        refuses_mode_halted = (of("mode_refusal") & 1) != 0;
        refuses_mode_moving = (of("mode_refusal") & 2) != 0;
        refuses_mode_silently = of("mode_refusal_silent") != 0;
        acknowledges = of("acknowledges", 1) != 0;
        acknowledges_when_taken = of("acknowledges", 1) == 2;
        acknowledge = ms("acknowledge_ms");
        status_bits = ms("status_bits_ms");
        pdo_setup = static_cast<PdoSetup>(of("pdo_setup"));
        strict_cob_id = static_cast<int>(of("strict_cob_id"));
        strict_mapping = of("strict_mapping") != 0;
        sdo_answer = ms("sdo_answer_ms");
        for (std::size_t i = 0; i < optional_objects.size(); ++i)
            has[i] = of(optional_objects[i].freedom, 1) != 0;
        pdo_types_fixed = of("pdo_types_fixed") != 0;
        usual_pdos = of("pdo_defaults") != 0;
        unmappable = static_cast<unsigned>(of("unmappable"));
        extra_tpdos = static_cast<std::uint16_t>(of("extra_tpdos"));
        emergency_after_status = of("emcy_after_status") != 0;
        heartbeat_jitter = ms("heartbeat_jitter_ms");
        stopped_by_other = std::chrono::seconds(of("stopped_by_other_s"));
        sync_watch_periods = static_cast<int>(of("sync_watch_periods"));
        target_watch_periods = static_cast<int>(of("target_watch_periods"));
        boot = ms("boot_ms");
        switch_hysteresis = static_cast<double>(of("switch_hysteresis_increments"));
    }

    Duration control_sample{};  ///< between two samples of 6040h; 0: at once
    Duration mode_shown{};      ///< until a mode that 6060h orders is in force and shown
    bool refuses_mode_halted = false, refuses_mode_moving = false;
    bool refuses_mode_silently = false;    ///< 6060h can be written, and 6061h keeps its mode
    bool acknowledges = true;              ///< status bit 12 in mode 1
    bool acknowledges_when_taken = false;  ///< a set-point that waits for the end of the one before is acknowledged then
    Duration acknowledge{};                ///< until bit 12 follows
    Duration status_bits{};                ///< until bits 10, 12 (except in mode 1) and 13 are set; they are cleared at once
    PdoSetup pdo_setup = PdoSetup::any_state;
    int strict_cob_id = 0;  ///< 1: changed only while invalid, or by the write that makes it invalid; 2: only while invalid
    bool strict_mapping = false;
    Duration sdo_answer{};
    std::array<bool, optional_objects.size()> has{true, true, true, true, true, true, true};
    bool pdo_types_fixed = false;         ///< transmission types are read only
    bool usual_pdos = false;              ///< the default mappings are those of CiA 402-5
    unsigned unmappable = 0;              ///< bit 0: 6061h, 1: 606Ch, 2: 6062h: cannot be mapped
    std::uint16_t extra_tpdos = 0;        ///< further TPDOs that are on at power-on, 0 to 3
    bool emergency_after_status = false;  ///< EMCY is sent after the PDOs with the status word that has changed by the same event
    Duration heartbeat_jitter{};
    Duration stopped_by_other{};   ///< from the first NMT start until another master stops the node; 0: never
    int sync_watch_periods = 0;    ///< missing SYNCs in a cyclic mode that are a fault; 0: any number is permitted
    int target_watch_periods = 0;  ///< missing targets in a cyclic mode that are a fault
    Duration boot{};               ///< after NMT reset node; after power-on the common freedom of this name does the same
    double switch_hysteresis = 0;  ///< increments by which a switch is released later than it was operated
    ShaftFreedoms shaft;
    std::uint64_t seed = 0;  ///< for behaviour that changes each time

    [[nodiscard]] bool maps(std::uint16_t index) const noexcept {
        const unsigned bit = index == 0x6061 ? 1 : index == 0x606C ? 2 : index == 0x6062 ? 4 : 0;
        return (unmappable & bit) == 0 && !lacks(index);
    }
    [[nodiscard]] bool lacks(std::uint16_t index) const noexcept {
        if (pdo_setup == PdoSetup::no_pdos && index >= 0x1400 && index < 0x1C00) return true;
        const auto o = std::ranges::find(optional_objects, index, &OptionalObject::index);
        return o != optional_objects.end() && !has[static_cast<std::size_t>(o - optional_objects.begin())];
    }
};

}  // namespace axisgate::cia402_drive::twin
