// SYNC turns: who shares which beats of a SYNC, so that no beat's PDOs are more than half of what the bus carries in it. Nodes tell in
// turns (transmission type n: at each n-th SYNC, CiA 301 7.5.2.37), each group of them at beats of its own; targets of led axes have
// places beside them.
// In: the nodes of a line, the beat that is wanted, bit rate, bits. Out: the plan as a value; places of targets. Pure and bounded. Never
// knows what a PDO carries, nor which beat it is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/core/instant.hpp"

namespace axisgate::canopen {

/// Bits that a frame of so many bytes has at most with an identifier of 11 bits: 44 and 8 for each byte, of those up to the checksum one
/// stuff bit for each four after the first (ISO 11898-1), and 3 between frames.
[[nodiscard]] constexpr std::uint32_t most_bits(std::uint32_t bytes) noexcept { return 44 + 8 * bytes + (33 + 8 * bytes) / 4 + 3; }

struct TurnsWish {
    struct Node {
        int axes = 1;   ///< all of them tell in one beat; 0: it tells nothing
        int slot = -1;  ///< where it is in the plan in force: it stays there if the turns stay as many
    };
    Duration beat{};                ///< between two SYNCs, whole milliseconds
    std::uint32_t bit_rate = 0;     ///< 0: not known, 1 Mbit/s
    std::uint32_t axis_bits = 0;    ///< of the PDOs in which an axis tells
    std::uint32_t target_bits = 0;  ///< of one that leads it
    int places = 0;                 ///< of targets that are in use and must not be lost
    std::vector<Node> nodes{};
};

struct SyncTurns {
    Duration beat{};         ///< as wished, or longer where not even one node fits it
    int turns = 1;           ///< a node tells at each so many beats: its transmission type
    int axes = 0;            ///< that tell in the fullest beat
    int places = 1;          ///< of targets that have room in each beat beside them
    std::uint64_t bits = 0;  ///< of the fullest beat with the SYNC, and no target
    std::vector<int> slots;  ///< of each node of the wish: it tells at beats that leave this when divided by `turns`
    [[nodiscard]] Duration cycle() const noexcept { return beat * turns; }  ///< of an axis
    bool operator==(const SyncTurns&) const = default;
};

inline constexpr int most_turns = 240;  ///< transmission types 1..240
/// Half of what the bus carries in that time is for PDOs: the rest is for SDOs, heartbeats and other families.
[[nodiscard]] std::uint64_t pdo_share(Duration time, std::uint32_t bit_rate) noexcept;
/// As few turns as fit. A quarter of the share, but not more than four targets and at least one, is kept free for axes that are led.
[[nodiscard]] SyncTurns plan_turns(const TurnsWish& wish);

/// Places of targets: a led axis has one in each beat, or each 2nd, 4th ... as few are led; it keeps what it has.
class TargetTurns {
public:
    static constexpr int most = 128;
    struct Place {
        int turns = 1;  ///< a target goes each so many beats
        int phase = 0;
        [[nodiscard]] bool due(std::uint64_t beat) const noexcept { return static_cast<int>(beat % static_cast<unsigned>(turns)) == phase; }
        bool operator==(const Place&) const = default;
    };
    /// Of `places` in each beat. The `others` that may come later keep room for a place each `longest` beats (a power of 2, up to `most`).
    /// Nothing: there is no room.
    [[nodiscard]] std::optional<Place> take(int places, int others, int longest);
    void give_back(const Place& place) noexcept;
    [[nodiscard]] int in(std::uint64_t beat) const noexcept { return used_[beat % most]; }
    [[nodiscard]] int fullest() const noexcept;
    [[nodiscard]] bool none() const noexcept { return fullest() == 0; }

private:
    std::array<int, most> used_{};
};
/// The longest that an axis waits between two targets, in beats, a power of 2: twice as long as if all of them shared the places evenly. So
/// one half of the room is everybody's, and the other half makes those quicker who are led first.
[[nodiscard]] int longest_turns(int axes, int places) noexcept;

}  // namespace axisgate::canopen
