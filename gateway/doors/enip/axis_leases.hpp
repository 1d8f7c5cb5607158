// An owner of outputs in run mode holds its axes, so that no other client commands beside it; a client that takes one over by the site's
// rules has it for that lease. Results of the HoldAxis commands are not waited for.
#pragma once

#include <span>

#include "gateway/engine/door.hpp"

namespace axisgate::enip {

class AxisLeases {
public:
    AxisLeases(DoorPort& port, std::int64_t lease_s) : port_(port), lease_s_(lease_s) {}
    void use_number(DoorNumber number) noexcept { number_ = number; }
    /// Takes the axes without a holder; `renews`: prolongs its own leases, too.
    void hold(const Origin& by, std::span<const AxisId> axes, bool renews, Instant now);
    void let_go(const Origin& by, std::span<const AxisId> axes);
    /// True if the result belongs to a lease: the holder is visible in the axis' picture.
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
