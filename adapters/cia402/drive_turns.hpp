// PdoTurns makes sure that the PDOs of an axis arrive in the SYNC cycles that the line's plan gives to its node. It writes the transmission
// type (1800h:02), and the cycle in which it enables a PDO decides from where the node counts. Nodes count differently, so the cycle in
// which PDOs actually arrive is observed, and they are moved by the difference.
#pragma once

#include <algorithm>
#include <array>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_pdos.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::cia402_drive {
class Axis;

class PdoTurns : public drive::Part<Axis> {
public:
    using Part::Part;

    /// The set-up of the node writes PDOs with this transmission type.
    void set_up(int turns) noexcept;
    /// The transfer in progress was lost.
    void forget() noexcept { act_ = Act::rest; }
    /// A PDO arrived in the present cycle.
    void came(std::size_t which, Turn& t);
    /// True if a write may be sent now.
    [[nodiscard]] bool wants(Instant now) const noexcept;
    [[nodiscard]] Step next();
    void answered(bool done, Turn& t);
    /// The PDOs of the axis do not arrive in one cycle, and cannot be moved.
    [[nodiscard]] bool apart() const noexcept {
        return std::ranges::any_of(reported_, [](const Reported& p) { return p.tries > most_tries; });
    }

private:
    static constexpr int sure = 4, most_tries = 4, settled = 64;  ///< a PDO is occasionally delayed by another frame of its node
    enum class Act : std::uint8_t { rest, off, type, on };
    struct Reported {
        int turns = 1;                ///< transmission type
        int wanted_slot = -1;         ///< it is enabled in a cycle with this remainder; below 0: enabled by NMT start, in its own
        int error = 0, missed = 0;    ///< difference in cycles, and how often in succession it was seen
        int tries = 0, in_place = 0;  ///< attempts without success; times in succession in the right cycle
    };
    [[nodiscard]] bool misplaced(const Reported& pdo) const noexcept;
    [[nodiscard]] std::size_t first_misplaced() const noexcept;  ///< the number of reports: none is
    void give_up(Reported& pdo, std::string_view why, Turn& t);

    std::array<Reported, AxisPdos::most_reports> reported_{};
    Act act_ = Act::rest;
    std::size_t at_ = 0;
};

}  // namespace axisgate::cia402_drive
