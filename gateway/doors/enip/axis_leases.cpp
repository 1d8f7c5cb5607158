// One command per axis and lease, as a client of another door would give it.
#include "gateway/doors/enip/axis_leases.hpp"

#include <utility>

namespace axisgate::enip {

void AxisLeases::submit(const Origin& by, AxisId axis, HoldAxis::Kind kind) {
    Command c;
    c.ticket = make_ticket(number_, first_ticket + ++tickets_);
    c.axis = axis;
    c.body = HoldAxis{kind, lease_s_, false, {}};
    c.origin = by;
    port_.submit(std::move(c));
}

void AxisLeases::hold(const Origin& by, std::span<const AxisId> axes, bool renews, Instant now) {
    const auto me = AuthorityClient::of(by);
    for (const AxisId axis : axes) {
        const AxisPicture& p = port_.image().picture(axis);
        const bool somebody = p.authority_until > now && p.authority_holder[0] != 0;
        const bool mine = somebody && p.authority == me.door && me.name == p.authority_holder.data();
        if (mine ? renews : !somebody) submit(by, axis, HoldAxis::Kind::take);
    }
}

void AxisLeases::let_go(const Origin& by, std::span<const AxisId> axes) {
    for (const AxisId axis : axes)
        submit(by, axis, HoldAxis::Kind::release);
}

}  // namespace axisgate::enip
