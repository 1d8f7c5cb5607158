// Axis values: a lane per axis and owner; a ticket for each command, by which its result finds who asked.
// In: assemblies, parameters, results. Out: bytes little endian, commands, set-points. Never waits for a drive.
#include "gateway/doors/enip/axis_values.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/registers/register_map.hpp"
#include "gateway/registers/words.hpp"

namespace axisgate::enip {
namespace {
namespace reg = registers::reg;
using cip::Bytes;
using cip::General;

constexpr std::uint16_t input_registers = bytes_per_axis / 2;
/// Beyond those of the register writer, whose tickets are the door's as well: place and generation, below 2^48.
constexpr std::uint64_t own_tickets = std::uint64_t{1} << 48;

/// A word that stops or switches off is taken though much waits for the drives.
bool only_stops(const CommandBody& body) {
    const auto* d = std::get_if<ProcessData>(&body);
    return d && d->controlword && (*d->controlword & 0x010F) != 0x000F;
}

/// Registers of the standard map, big-endian words in the house's order, as little-endian data.
void put_little_endian(const std::uint8_t* block, MapWordOrder order, Bytes& to) {
    const std::size_t begin = to.size();
    to.resize(begin + bytes_per_axis);
    for (const auto& row : registers::standard_registers()) {
        if (row.offset >= input_registers) break;
        const std::uint8_t* const from = block + 2 * std::size_t{row.offset};
        std::uint8_t* const at = to.data() + begin + 2 * std::size_t{row.offset};
        if (row.width() == 2) {
            cip::set32(at, registers::get32(from, order));
        } else {
            cip::set16(at, registers::get16(from));
        }
    }
}
}  // namespace

std::string address_text(std::uint32_t a) { return fmt::format("{}.{}.{}.{}", a >> 24, a >> 16 & 255, a >> 8 & 255, a & 255); }
std::string text_of(cip::Endpoint e) { return fmt::format("{}:{}", address_text(e.address), e.port); }

General general_of(Reason reason) noexcept {
    switch (reason) {
        case Reason::none:
            return General::success;
        case Reason::out_of_range:
            return General::invalid_attribute_value;
        case Reason::unknown_point:
        case Reason::not_supported:
            return General::attribute_not_supported;
        case Reason::not_writable:
            return General::attribute_not_settable;
        case Reason::wrong_state:
        case Reason::interrupted:
            return General::device_state_conflict;
        case Reason::busy:
            return General::resource_unavailable;
        case Reason::authority:
            return General::privilege_violation;
        case Reason::not_stored:
            return General::store_operation_failure;
        case Reason::line_down:
        case Reason::no_answer:
            return General::connection_lost;
        case Reason::drive_refused:
        case Reason::internal:
            break;
    }
    return General::vendor_specific;
}

AxisValues::AxisValues(DoorPort& port, registers::RegisterImage& image, std::int64_t lease_s)
    : port_(port),
      image_(image),
      writer_(port, image, {.door = Door::ethernet_ip, .answer = [](registers::Verdict) { return std::string(); }}),
      lease_s_(lease_s) {}

void AxisValues::use(Layout layout, bool anew) {
    layout_ = std::move(layout);
    shown_.clear();
    if (anew) owners_.clear();
}

template <class Each>
void AxisValues::each_axis(std::uint32_t instance, Each&& each) const {
    if (const auto* w = layout_.window(instance)) {
        for (std::uint16_t i = 0; i < w->axes.size(); ++i)
            each(i, w->axes[i]);
        return;
    }
    const Layout::Range r = layout_.range_of(instance);
    for (std::uint16_t i = 0; i < r.count; ++i) {
        const LayoutAxis* const a = layout_.axis(static_cast<std::uint16_t>(r.first + i));
        each(i, a ? a->id : no_axis);
    }
}

const std::vector<registers::MapValue>& AxisValues::shown_of(const LayoutWindow& window) const {
    const auto it = shown_.find(window.spec.instance);
    return it != shown_.end() ? it->second : shown_.emplace(window.spec.instance, shown_values(image_, window.spec)).first->second;
}

void AxisValues::read(std::uint32_t instance, Instant now, Bytes& to) {
    const auto info = layout_.assembly(instance);
    if (!info) return;
    if (const auto* w = layout_.window(instance)) return show_window(image_, w->spec, shown_of(*w), now, to);
    const std::size_t begin = to.size();
    const bool input = info->role == cip::AssemblyInfo::Role::input;
    const std::uint16_t from = input ? std::uint16_t{0} : reg::controlword;
    each_axis(instance, [&](std::uint16_t, AxisId id) {
        std::uint8_t block[bytes_per_axis] = {};
        const std::uint16_t number = id == no_axis ? std::uint16_t{0} : port_.image().picture(id).number;
        if (number != 0) {
            const auto address = static_cast<std::uint16_t>((number - 1) * registers::registers_per_axis + from);
            const auto verdict =
                image_.standard().read_registers(registers::Table::holding_registers, address, input_registers, now, block);
            if (verdict != registers::Verdict::good) std::ranges::fill(block, std::uint8_t{0});
        }
        if (input) return put_little_endian(block, image_.word_order(), to);
        // As the standard map lays 32..45 out: one word, one word, five pairs, one word.
        const auto pair = [&](std::size_t at) { cip::put32(to, registers::get32(block + at, image_.word_order())); };
        const auto word = [&](std::size_t at) { cip::put16(to, registers::get16(block + at)); };
        word(0);
        word(2);
        for (std::size_t at = 4; at < 24; at += 4)
            pair(at);
        word(24);
        to.insert(to.end(), 6, 0);
    });
    to.resize(begin + info->size);
}

std::uint64_t AxisValues::revision(std::uint32_t instance) const {
    if (const auto* w = layout_.window(instance)) return window_revision(image_, w->spec, shown_of(*w), port_.now());
    std::uint64_t sum = 0;
    each_axis(instance, [&](std::uint16_t, AxisId id) {
        if (id != no_axis) sum += port_.image().cell(id).revision();
    });
    return sum;
}

Origin AxisValues::origin_of(std::uint32_t output, const cip::Peer& who) const {
    Origin o;
    o.door = Door::ethernet_ip;
    o.who = std::make_shared<const std::string>(text_of(who.from));
    // Each output is a client of its own: the end of one is no loss to the axes of another.
    o.client = std::make_shared<const std::string>(fmt::format("{} assembly {}", address_text(who.from.address), output));
    return o;
}

Origin AxisValues::origin_for(AxisId axis, const cip::Peer& who) const {
    for (const auto& [output, owner] : owners_) {
        if (std::ranges::find(owner.axes, axis) != owner.axes.end() &&
            owner.origin.client->starts_with(address_text(who.from.address) + " "))
            return owner.origin;
    }
    Origin o;
    o.door = Door::ethernet_ip;
    o.who = std::make_shared<const std::string>(text_of(who.from));
    return o;
}

bool AxisValues::submit(AxisId axis, CommandBody body, Asked asked, Instant now) {
    if (asked_.size() >= 2 * most_asked && !only_stops(body)) return false;
    Command c;
    c.ticket = make_ticket(number_, own_tickets + ++tickets_);
    c.axis = axis;
    c.body = std::move(body);
    c.origin = asked.origin;
    asked.axis = axis;
    asked.until = now + patience;
    asked_.emplace(c.ticket, std::move(asked));
    port_.submit(std::move(c));
    return true;
}

General AxisValues::write(std::uint32_t instance, cip::View data, const cip::Peer& who, Instant now) {
    if (const auto* w = layout_.window(instance)) {
        const Origin origin = origin_for(w->axes.empty() ? no_axis : w->axes.front(), who);
        return general_of(write_window(image_, writer_, w->spec, origin, data, now));
    }
    bool taken = true;
    each_axis(instance, [&](std::uint16_t i, AxisId id) {
        if (id == no_axis) return;
        Asked asked;
        asked.origin = origin_for(id, who);
        asked.data = all_of(read_wanted(data.subspan(std::size_t{i} * bytes_per_axis, bytes_per_axis)));
        const ProcessData d = asked.data;
        counters_.commands.add();
        taken = submit(id, d, std::move(asked), now) && taken;
    });
    return taken ? General::success : General::resource_unavailable;
}

bool AxisValues::overlap(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return true;
    if (layout_.window(a) || layout_.window(b)) {
        std::vector<AxisId> of_a;
        each_axis(a, [&](std::uint16_t, AxisId id) { of_a.push_back(id); });
        bool both = false;
        each_axis(b, [&](std::uint16_t, AxisId id) { both = both || (id != no_axis && std::ranges::find(of_a, id) != of_a.end()); });
        return both;
    }
    const Layout::Range x = layout_.range_of(a), y = layout_.range_of(b);
    return x.first < y.first + y.count && y.first < x.first + x.count;
}

bool AxisValues::held_by_another(std::uint32_t output, const cip::Peer& who, Instant now) const {
    const auto me = AuthorityClient::of(origin_of(output, who));
    bool held = false;
    each_axis(output, [&](std::uint16_t, AxisId id) {
        if (id == no_axis) return;
        const AxisPicture& p = port_.image().picture(id);
        const bool somebody = p.authority_until > now && p.authority_holder[0] != 0;
        held = held || (somebody && !(p.authority == Door::ethernet_ip && me.name == p.authority_holder.data()));
    });
    return held;
}

void AxisValues::opened(std::uint32_t output, const cip::Peer& who, Duration time_out, Instant) {
    Owner& owner = owners_[output];
    owner = {};
    owner.origin = origin_of(output, who);
    owner.good_for = std::clamp(time_out, SetPoint::good_for_min, SetPoint::good_for_max);
    each_axis(output, [&](std::uint16_t, AxisId id) {
        if (id != no_axis) owner.axes.push_back(id);
    });
    if (const auto* w = layout_.window(output)) {
        owner.window = std::make_unique<WindowOutput>(port_, image_, writer_, counters_.commands, w->spec, owner.origin);
        for (const auto& [axis, members] : owner.window->members())
            owner.lanes.emplace(axis, OutputLane(members));
    } else {
        for (const AxisId axis : owner.axes)
            owner.lanes.emplace(axis, OutputLane{});
    }
    Event e;
    e.kind = "ethernet_ip";
    e.door = std::string(name_of(Door::ethernet_ip));
    e.who = *owner.origin.who;
    e.text = fmt::format("connection opened: {} ({})", layout_.name_of(output), output);
    port_.note(std::move(e), no_axis);
}

void AxisValues::consumed(std::uint32_t output, cip::View data, const cip::Peer&, Instant now) {
    const auto it = owners_.find(output);
    if (it == owners_.end()) return;
    if (WindowOutput* const window = it->second.window.get()) {
        window->take(data, now);
        for (auto& [axis, lane] : it->second.lanes)
            carry_out(output, it->second, axis, lane.take(window->wanted(axis), port_.image().picture(axis)), now);
        return;
    }
    each_axis(output, [&](std::uint16_t i, AxisId id) {
        const auto lane = it->second.lanes.find(id);
        if (lane == it->second.lanes.end()) return;
        const Wanted wanted = read_wanted(data.subspan(std::size_t{i} * bytes_per_axis, bytes_per_axis));
        carry_out(output, it->second, id, lane->second.take(wanted, port_.image().picture(id)), now);
    });
}

void AxisValues::carry_out(std::uint32_t output, Owner& owner, AxisId axis, OutputLane::Step step, Instant now) {
    if (step.command) {
        Asked asked;
        asked.output = output;
        asked.origin = owner.origin;
        asked.data = *step.command;
        counters_.commands.add();
        if (submit(axis, *step.command, std::move(asked), now)) owner.lanes[axis].begun();
    }
    if (!step.set_point) return;
    SetPoint p = *step.set_point;
    p.axis = axis;
    p.good_for = owner.good_for;
    p.at = now;
    p.origin = owner.origin;
    (port_.set_point(p) ? counters_.set_points_refused : counters_.set_points).add();
}

void AxisValues::lose(std::uint32_t output, LossCause cause) {
    const auto it = owners_.find(output);
    if (it == owners_.end()) return;
    for (auto& [axis, lane] : it->second.lanes)
        lane.reset();
    if (it->second.window) it->second.window->reset();
    port_.client_lost(AuthorityClient::of(it->second.origin), cause);
}

void AxisValues::idle(std::uint32_t output, const cip::Peer&, Instant) { lose(output, LossCause::enip_idle); }

void AxisValues::ended(std::uint32_t output, const cip::Peer& who, cip::End why, Instant) {
    lose(output, why == cip::End::timed_out ? LossCause::enip_timed_out : LossCause::enip_closed);
    owners_.erase(output);
    Event e;
    e.severity = why == cip::End::closed ? Severity::info : Severity::warning;
    e.kind = "ethernet_ip";
    e.door = std::string(name_of(Door::ethernet_ip));
    e.who = text_of(who.from);
    e.text =
        fmt::format("connection {}: {} ({})",
                    why == cip::End::closed      ? "closed"
                    : why == cip::End::timed_out ? "lost: its originator was silent for its time-out"
                                                 : "closed by the gateway: the site was changed, and with it the layout of its assemblies",
                    layout_.name_of(output), output);
    port_.note(std::move(e), no_axis);
}

General AxisValues::ask(std::uint32_t instance, cip::Token token, const cip::Peer& who, Instant now) {
    const auto place = layout_.place_of(instance);
    if (!place.axis || token == 0 || questions_ >= most_asked) return General::resource_unavailable;
    Asked asked;
    asked.token = token;
    asked.instance = instance;
    asked.read = true;
    asked.origin = origin_for(place.axis->id, who);
    if (!submit(place.axis->id, ReadParameter{place.point}, std::move(asked), now)) return General::resource_unavailable;
    ++questions_;
    counters_.parameters.add();
    return General::success;
}

General AxisValues::set(std::uint32_t instance, cip::View value, cip::Token token, const cip::Peer& who, Instant now) {
    const auto place = layout_.place_of(instance);
    if (!place.axis || token == 0 || questions_ >= most_asked) return General::resource_unavailable;
    const auto read = from_bytes(value, layout_.parameter(instance)->type);
    if (!read) return General::invalid_attribute_value;
    const auto checked = place.axis->catalogue->check_write(place.point, *read);
    if (!checked.fault.empty()) return General::invalid_attribute_value;
    Asked asked;
    asked.token = token;
    asked.instance = instance;
    asked.origin = origin_for(place.axis->id, who);
    if (!submit(place.axis->id, WriteParameter{place.point, checked.value}, std::move(asked), now)) return General::resource_unavailable;
    ++questions_;
    counters_.parameters.add();
    return General::success;
}

void AxisValues::refused(const Asked& asked, const Result& result, Instant now) {
    registers::RequestNote note;
    note.write = true;
    note.unit = 1;
    note.address = reg::controlword;
    note.count = 1;
    note.values[0] = asked.data.controlword.value_or(0);
    writer_.refused(*asked.origin.who,
                    {asked.axis,
                     result.reason == Reason::none ? Reason::internal : result.reason,
                     result.text.empty() ? std::string("the output was refused") : result.text,
                     {},
                     {}},
                    note, {}, now);
}

void AxisValues::on_result(const Result& result) {
    const auto it = asked_.find(result.ticket);
    if (it == asked_.end()) return writer_.on_result(result);
    const Asked asked = std::move(it->second);
    asked_.erase(it);
    const Instant now = port_.now();
    if (asked.token == 0) {
        if (!good(result)) refused(asked, result, now);
        const auto owner = owners_.find(asked.output);
        if (owner == owners_.end()) return;
        const auto lane = owner->second.lanes.find(asked.axis);
        if (lane != owner->second.lanes.end()) carry_out(asked.output, owner->second, asked.axis, lane->second.done(), now);
        return;
    }
    --questions_;
    if (!good(result)) return answered_(asked.token, general_of(result.reason == Reason::none ? Reason::internal : result.reason), {});
    if (!asked.read) return answered_(asked.token, General::success, {});
    const auto* const info = layout_.parameter(asked.instance);
    const auto bytes = info && known(result.value) ? to_bytes(result.value, info->type) : std::nullopt;
    answered_(asked.token, bytes ? General::success : General::no_stored_data, bytes ? cip::View(*bytes) : cip::View());
}

void AxisValues::sweep(Instant now) {
    writer_.sweep(now);
    std::vector<Ticket> late;
    for (const auto& [ticket, asked] : asked_) {
        if (asked.until <= now) late.push_back(ticket);
    }
    for (const Ticket ticket : late) {
        Result r;
        r.ticket = ticket;
        r.axis = asked_.at(ticket).axis;
        r.outcome = Outcome::failed;
        r.reason = Reason::no_answer;
        on_result(r);
    }
    if (now - renewed_ < lease_renewal) return;
    renewed_ = now;
    // Who holds an axis and goes on renewing its outputs has not let it go, though nothing changes in them.
    for (auto& [output, owner] : owners_) {
        const auto me = AuthorityClient::of(owner.origin);
        for (const AxisId axis : owner.axes) {
            const AxisPicture& p = port_.image().picture(axis);
            if (p.authority_until <= now || p.authority != Door::ethernet_ip || me.name != p.authority_holder.data()) continue;
            Command c;
            c.ticket = make_ticket(number_, own_tickets + ++tickets_);
            c.axis = axis;
            c.body = HoldAxis{HoldAxis::Kind::take, lease_s_, false, {}};
            c.origin = owner.origin;
            port_.submit(std::move(c));
        }
    }
}

}  // namespace axisgate::enip
