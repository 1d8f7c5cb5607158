// Manners are the freedoms of a simulated MACS that are its own: how its SDO server, its PDOs and its application behave on the bus, and
// the mechanics of its axes. schema/families/aposs.json describes them; the defaults are the controller as the manual shows it.
#pragma once

#include "gateway/core/freedom.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::aposs {

/// The answer of a busy SDO server: an abort (0800 0022h, 0800 0020h), or none.
enum class BusyAnswer : std::uint8_t { device_state, transfer, none };
/// When PDOs may be set up: always; in pre-operational alone; there, and each of them only while it is not valid (bit 31 of its COB-ID).
enum class PdoSetup : std::uint8_t { always, pre_operational, strict };
/// Objects of the profile that the application lacks: none; measured and demand values; also those with which it is configured.
enum class Lacks : std::uint8_t { nothing, values, options };

struct Manners {
    Duration sdo_answer{}, sdo_late{};
    std::int64_t sdo_late_share = 0, sdo_busy_share = 0;  ///< per mille
    BusyAnswer busy_answer = BusyAnswer::device_state;
    PdoSetup pdo_setup = PdoSetup::always;
    Lacks lacks = Lacks::nothing;
    bool sends_emergencies = true;
    Duration emergency_late{}, heartbeat_jitter{}, foreign{}, extra_pdo{};
    Duration axis_start{}, program_cycle{}, status_late{}, position_late{};
    Duration pdo_late{};  ///< of a PDO by its event timer, so that it does not overtake an older one of the same identifier behind a SYNC
    double switch_hysteresis = 0;  ///< qc
    ShaftFreedoms shaft;
    std::uint64_t seed = 0;

    Manners() = default;
    Manners(const FreedomValues& of, std::uint64_t with) : seed(with) {
        const auto number = [&](std::string_view name, std::int64_t fallback = 0) { return freedom(of, name, fallback); };
        const auto ms = [&](std::string_view name) { return Duration(std::chrono::milliseconds(number(name))); };
        sdo_answer = ms("sdo_answer_ms");
        sdo_late = ms("sdo_late_ms");
        sdo_late_share = number("sdo_late_per_mille");
        sdo_busy_share = number("sdo_busy_per_mille");
        busy_answer = static_cast<BusyAnswer>(number("sdo_busy_answer"));
        pdo_setup = static_cast<PdoSetup>(number("pdo_setup"));
        lacks = static_cast<Lacks>(number("lacking_objects"));
        sends_emergencies = number("emergencies", 1) != 0;
        emergency_late = ms("emergency_late_ms");
        heartbeat_jitter = ms("heartbeat_jitter_ms");
        foreign = ms("foreign_ms");
        extra_pdo = ms("extra_pdo_ms");
        if (extra_pdo != Duration::zero()) pdo_late = ms("reply_ms");
        axis_start = ms("axis_start_ms");
        program_cycle = ms("program_cycle_ms");
        status_late = ms("status_late_ms");
        position_late = ms("position_late_ms");
        switch_hysteresis = static_cast<double>(number("switch_hysteresis_increments"));
        shaft = shaft_freedoms(of);
    }
};

}  // namespace axisgate::aposs
