// AxisValues, outputs written by messages: each write is answered when all of its commands have been answered; its sender is a client that
// can be lost.
#include <algorithm>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/doors/enip/words.hpp"

namespace axisgate::enip {
namespace {
using cip::General;

/// The output exists and can be set, so a refusal concerns the value, the state of the device, or another holder.
General of_output(Reason why) {
    switch (why) {
        case Reason::authority:
            return General::object_state_conflict;
        case Reason::not_supported:
        case Reason::unknown_point:
        case Reason::not_writable:
            return General::invalid_attribute_value;
        default:
            return general_of(why);
    }
}
}  // namespace

Origin AxisValues::origin_for(AxisId axis, const cip::Peer& who) const {
    for (const auto& [output, owner] : owners_) {
        if (std::ranges::find(owner.axes, axis) != owner.axes.end() &&
            owner.origin.client->starts_with(address_text(who.from.address) + " "))
            return owner.origin;
    }
    Origin o;
    o.door = clients;
    o.who = std::make_shared<const std::string>(text_of(who.from));
    return o;
}

Origin AxisValues::commander_for(AxisId axis, const cip::Peer& who) {
    Origin o = origin_for(axis, who);
    if (!o.client) clients_.commanded(AuthorityClient::of(o), who);
    return o;
}

General AxisValues::write(std::uint32_t instance, cip::View data, cip::Token token, const cip::Peer& who, Instant now, bool& later) {
    if (token == 0 || message_writes_.size() + own_writes_.size() >= most_asked) return General::resource_unavailable;
    if (const auto* w = layout_.window(instance)) {
        const Origin origin = commander_for(w->axes.empty() ? no_axis : w->axes.front(), who);
        const auto [it, fresh] = own_writes_.try_emplace(token, *this, token, origin);
        if (!fresh) return General::resource_unavailable;
        const auto done = write_window(image_, writer_, w->spec, it->second, origin, data, now);
        const General at_once = of_output(done.why);
        later = done.outstanding > 0;
        if (later) {
            it->second.left = done.outstanding;
            it->second.general = at_once;
            return General::success;
        }
        own_writes_.erase(it);
        return at_once;
    }
    MessageWrite all;
    layout_.each_axis(instance, [&](std::uint16_t i, AxisId id) {
        if (id == no_axis) return;
        Asked asked;
        asked.kind = Asked::Kind::output;
        asked.token = token;
        asked.origin = commander_for(id, who);
        asked.data = all_of(read_wanted(data.subspan(std::size_t{i} * bytes_per_axis, bytes_per_axis)));
        const ProcessData d = asked.data;
        counters_.commands.add();
        if (submit(id, d, std::move(asked), now))
            ++all.left;
        else
            all.note(Reason::busy);
    });
    if (all.left == 0) return all.general;
    later = true;
    message_writes_.emplace(token, all);
    return General::success;
}

void AxisValues::MessageWrite::note(Reason why) {
    if (general != General::success || why == Reason::none) return;
    general = of_output(why);
    extended = static_cast<std::uint16_t>(why);
}

bool AxisValues::MessageWrite::answered(const Result& result) {
    if (!good(result)) note(result.reason == Reason::none ? Reason::internal : result.reason);
    return --left == 0;
}

void AxisValues::messages_ended(const cip::Peer& way) {
    for (const auto& who : clients_.ended(way))
        lost_.lost(who, loss_session_closed);
}

}  // namespace axisgate::enip
