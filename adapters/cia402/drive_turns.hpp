// PdoTurns: that the PDOs of an axis come in the beats that are its node's by the line's plan, and no others.
// In: the beats in which they came, answers. Out: writes that set how many SYNCs a PDO is apart (1800h:02), and in which beat it is taken
// into use: from there a node counts. Never goes by how a node counts: it looks where its PDOs come, and moves them by the difference.
#pragma once

#include <array>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::cia402_drive {
class Axis;

class PdoTurns : public drive::Part<Axis> {
public:
    enum Pdo : std::uint8_t { status, motion };
    using Part::Part;

    /// Its set-up writes PDOs with so many turns.
    void set_up(int turns) noexcept;
    /// What was on its way is gone.
    void forget() noexcept { act_ = Act::rest; }
    /// In the present beat.
    void came(Pdo which, Turn& t);
    /// A write of it may go now.
    [[nodiscard]] bool wants(Instant now) const noexcept;
    [[nodiscard]] Step next();
    void answered(bool done, Turn& t);
    /// Its PDOs do not come in one beat, and cannot be moved.
    [[nodiscard]] bool apart() const noexcept { return reported_[status].tries > most_tries || reported_[motion].tries > most_tries; }

private:
    static constexpr int sure = 4, most_tries = 4, settled = 64;  ///< now and then a PDO is held up behind another frame of its node
    enum class Act : std::uint8_t { rest, off, type, on };
    struct Reported {
        int turns = 1;                ///< its transmission type
        int wanted_slot = -1;         ///< it is taken into use in a beat that leaves this; below 0: with NMT start, in its own
        int error = 0, missed = 0;    ///< so many beats beside its own, so often in a row
        int tries = 0, in_place = 0;  ///< moves that did not help; times in a row in its beat
    };
    [[nodiscard]] bool misplaced(const Reported& pdo) const noexcept;
    void give_up(Reported& pdo, std::string_view why, Turn& t);

    std::array<Reported, 2> reported_{};
    Act act_ = Act::rest;
    std::size_t at_ = 0;
};

}  // namespace axisgate::cia402_drive
