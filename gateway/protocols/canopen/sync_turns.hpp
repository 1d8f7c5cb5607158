// SYNC turns: distributes the PDOs of the nodes over the beats of a SYNC, so that they take at most half of the capacity of the bus.
// Nodes report in turns (transmission type n: at each n-th SYNC, CiA 301 7.5.2.37), each group of them in beats of its own; the targets of
// axes with a leading client have places beside them. The functions are pure and bounded: from the nodes of a line, the wanted beat, the
// bit rate and the sizes of the PDOs they compute a plan and the places of targets.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/core/instant.hpp"

namespace axisgate::canopen {

/// The largest number of bits of a frame with this many bytes and an 11-bit identifier: 44, and 8 for each byte; one stuff bit for each
/// four bits after the first, up to the checksum (ISO 11898-1); and 3 between frames.
[[nodiscard]] constexpr std::uint32_t most_bits(std::uint32_t bytes) noexcept { return 44 + 8 * bytes + (33 + 8 * bytes) / 4 + 3; }

struct TurnsWish {
    struct Node {
        int axes = 1;   ///< all of them report in one beat; 0: the node reports nothing
        int slot = -1;  ///< its slot in the present plan, which it keeps if the number of turns stays the same
    };
    Duration beat{};                ///< time between two SYNCs, whole milliseconds
    std::uint32_t bit_rate = 0;     ///< 0: unknown, 1 Mbit/s is assumed
    std::uint32_t axis_bits = 0;    ///< bits of the PDOs with which an axis reports
    std::uint32_t target_bits = 0;  ///< bits of a PDO with a target
    int places = 0;                 ///< number of targets in use that must not be lost
    std::vector<Node> nodes{};
};

struct SyncTurns {
    Duration beat{};         ///< as wished, or longer if not even one node fits
    int turns = 1;           ///< a node reports every `turns` beats: its transmission type
    int axes = 0;            ///< number of axes that report in the fullest beat
    int places = 1;          ///< number of targets that also fit in each beat
    std::uint64_t bits = 0;  ///< bits of the fullest beat with the SYNC, without targets
    std::vector<int> slots;  ///< one for each node of the wish: it reports in beats with this remainder when divided by `turns`
    [[nodiscard]] Duration cycle() const noexcept { return beat * turns; }  ///< between two reports of an axis
    bool operator==(const SyncTurns&) const = default;
};

inline constexpr int most_turns = 240;  ///< transmission types 1..240
/// Half of the bus capacity in that time is for PDOs: the rest is for SDOs, heartbeats and other families.
[[nodiscard]] std::uint64_t pdo_share(Duration time, std::uint32_t bit_rate) noexcept;
/// Plans as few turns as fit. A quarter of the share, for one to four targets, is kept free for axes with targets.
[[nodiscard]] SyncTurns plan_turns(const TurnsWish& wish);

/// Places of targets: a target has a place in each beat, or in each 2nd, 4th ... if there are many; an axis keeps its place.
class TargetTurns {
public:
    static constexpr int most = 128;
    struct Place {
        int turns = 1;  ///< a target is sent every `turns` beats
        int phase = 0;
        [[nodiscard]] bool due(std::uint64_t beat) const noexcept { return static_cast<int>(beat % static_cast<unsigned>(turns)) == phase; }
        bool operator==(const Place&) const = default;
    };
    /// Takes a place, with `places` in each beat. For each of the `others` that may come later, one place every `longest` beats (a power of
    /// 2, up to `most`) stays free. Nothing if there is no room.
    [[nodiscard]] std::optional<Place> take(int places, int others, int longest);
    void give_back(const Place& place) noexcept;
    [[nodiscard]] int in(std::uint64_t beat) const noexcept { return used_[beat % most]; }
    [[nodiscard]] int fullest() const noexcept;
    [[nodiscard]] bool none() const noexcept { return fullest() == 0; }

private:
    std::array<int, most> used_{};
};
/// The longest wait of an axis between two targets, in beats, a power of 2: twice as long as if all axes shared the places evenly. Thus one
/// half of the places is guaranteed to all, and the other half goes to the axes that came first.
[[nodiscard]] int longest_turns(int axes, int places) noexcept;

}  // namespace axisgate::canopen
