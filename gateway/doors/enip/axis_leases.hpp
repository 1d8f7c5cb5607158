// Axis leases: an owner of outputs in run mode holds its axes, so that nobody commands beside it; who takes one over by the site's rules
// has it for that lease. In: the owner's client and axes, the pictures. Out: HoldAxis commands, whose results nobody waits for.
#pragma once

#include <span>

#include "gateway/engine/door.hpp"

namespace axisgate::enip {

class AxisLeases {
public:
    AxisLeases(DoorPort& port, std::int64_t lease_s) : port_(port), lease_s_(lease_s) {}
    void use_number(DoorNumber number) noexcept { number_ = number; }
    /// Takes those that nobody holds; `renews`: prolongs its own, too.
    void hold(const Origin& by, std::span<const AxisId> axes, bool renews, Instant now);
    void let_go(const Origin& by, std::span<const AxisId> axes);
    /// The result belongs to a lease: who holds the axis is seen in its picture.
    [[nodiscard]] static bool is_mine(Ticket ticket) noexcept { return (ticket & first_ticket) != 0; }

private:
    static constexpr std::uint64_t first_ticket = std::uint64_t{1} << 50;  ///< beyond the door's other tickets
    void submit(const Origin& by, AxisId axis, HoldAxis::Kind kind);
    DoorPort& port_;
    std::int64_t lease_s_;
    DoorNumber number_ = 0;
    std::uint64_t tickets_ = 0;
};

}  // namespace axisgate::enip
