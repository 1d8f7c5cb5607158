// One lane per axis and owner; one ticket per command, by which its result finds the sender. Drives are never waited for.
#include "gateway/doors/enip/axis_values.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/enip/words.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/registers/words.hpp"

namespace axisgate::enip {
namespace {
namespace reg = registers::reg;
using cip::Bytes;
using cip::General;

constexpr std::uint16_t input_registers = bytes_per_axis / 2;
/// Beyond those of the register writer, which share the door's number: place and generation, below 2^48.
constexpr std::uint64_t own_tickets = std::uint64_t{1} << 48;

std::string text_of_parameter(const Layout& layout, std::uint32_t instance) {
    const auto info = layout.parameter(instance);
    return fmt::format("write of parameter object {}, {}", instance, info ? info->name : "gone");
}

/// A word that stops or switches off is accepted even if many commands wait for the drives.
bool only_stops(const CommandBody& body) {
    const auto* d = std::get_if<ProcessData>(&body);
    return d && d->controlword && (*d->controlword & 0x010F) != 0x000F;
}

/// Converts registers of the standard map (big-endian, words in the configured order) to little-endian data.
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

Origin origin_of(std::uint32_t output, const cip::Peer& who) {
    Origin o;
    o.door = clients;
    o.who = std::make_shared<const std::string>(text_of(who.from));
    // Each output is a client of its own, so that the end of one is no loss for the axes of another.
    o.client = std::make_shared<const std::string>(fmt::format("{} assembly {}", address_text(who.from.address), output));
    return o;
}

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
      writer_(port, image, {.door = clients, .answer = [](registers::Verdict) { return std::string(); }}),
      leases_(port, lease_s),
      lost_(port, [this](const AuthorityClient& who) {
          return clients_.knows(who) ||
                 std::ranges::any_of(owners_, [&](const auto& o) { return o.second.runs && AuthorityClient::of(o.second.origin) == who; });
      }) {}

void AxisValues::use(Layout layout) {
    layout_ = std::move(layout);
    shown_.clear();
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
    layout_.each_axis(instance, [&](std::uint16_t, AxisId id) {
        std::uint8_t block[bytes_per_axis] = {};
        const std::uint16_t number = id == no_axis ? std::uint16_t{0} : port_.image().picture(id).number;
        if (number != 0) {
            const auto address = static_cast<std::uint16_t>((number - 1) * registers::registers_per_axis + from);
            const auto verdict =
                image_.standard().read_registers(registers::Table::holding_registers, address, input_registers, now, block);
            if (verdict != registers::Verdict::good) std::ranges::fill(block, std::uint8_t{0});
        }
        if (input) return put_little_endian(block, image_.word_order(), to);
        // The layout of 32..45 in the standard map: one word, one word, five pairs, one word.
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
    layout_.each_axis(instance, [&](std::uint16_t, AxisId id) {
        if (id != no_axis) sum += port_.image().cell(id).revision();
    });
    return sum;
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
    if (asked.kind != Asked::Kind::read) lost_.begun(asked.origin);
    asked_.emplace(c.ticket, std::move(asked));
    port_.submit(std::move(c));
    return true;
}

bool AxisValues::overlap(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return true;
    if (layout_.window(a) || layout_.window(b)) {
        std::vector<AxisId> of_a;
        layout_.each_axis(a, [&](std::uint16_t, AxisId id) { of_a.push_back(id); });
        bool both = false;
        layout_.each_axis(b,
                          [&](std::uint16_t, AxisId id) { both = both || (id != no_axis && std::ranges::find(of_a, id) != of_a.end()); });
        return both;
    }
    const Layout::Range x = layout_.range_of(a), y = layout_.range_of(b);
    return x.first < y.first + y.count && y.first < x.first + x.count;
}

bool AxisValues::held_by_another(std::uint32_t output, const cip::Peer& who, Instant now) const {
    const auto me = AuthorityClient::of(origin_of(output, who));
    bool held = false;
    layout_.each_axis(output, [&](std::uint16_t, AxisId id) {
        if (id == no_axis) return;
        const AxisPicture& p = port_.image().picture(id);
        const bool somebody = p.authority_until > now && p.authority_holder[0] != 0;
        held = held || (somebody && !(p.authority == clients && me.name == p.authority_holder.data()));
    });
    return held;
}

General AxisValues::ask(std::uint32_t instance, cip::Token token, const cip::Peer& who, Instant now) {
    const auto place = layout_.place_of(instance);
    if (!place.axis || token == 0 || questions_ >= most_asked) return General::resource_unavailable;
    Asked asked;
    asked.token = token;
    asked.instance = instance;
    asked.kind = Asked::Kind::read;
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
    const auto checked = read ? place.axis->catalogue->check_write(place.point, *read) : Catalogue::Checked{};
    if (!read || !checked.fault.empty()) {
        writer_.refused(text_of(who.from), place.axis->id, text_of_parameter(layout_, instance),
                        read ? checked.fault : "the value is none of its type", now);
        return General::invalid_attribute_value;
    }
    Asked asked;
    asked.token = token;
    asked.instance = instance;
    asked.kind = Asked::Kind::write;
    asked.origin = commander_for(place.axis->id, who);
    if (!submit(place.axis->id, WriteParameter{place.point, checked.value}, std::move(asked), now)) return General::resource_unavailable;
    ++questions_;
    counters_.parameters.add();
    return General::success;
}

void AxisValues::on_result(const Result& result) {
    if (AxisLeases::is_mine(result.ticket)) return;
    const auto it = asked_.find(result.ticket);
    if (it == asked_.end()) return writer_.on_result(result);
    const Asked asked = std::move(it->second);
    asked_.erase(it);
    const Instant now = port_.now();
    if (asked.kind != Asked::Kind::read) lost_.answered(asked.origin);
    if (asked.kind == Asked::Kind::output) {
        if (!good(result)) {
            registers::RequestNote note;
            note.write = true;
            note.unit = 1;
            note.address = reg::controlword;
            note.count = 1;
            note.values[0] = asked.data.controlword.value_or(0);
            std::string text = result.text.empty() ? std::string("the output was refused") : result.text;
            writer_.refused(*asked.origin.who,
                            {asked.axis, result.reason == Reason::none ? Reason::internal : result.reason, std::move(text), {}, {}}, note,
                            {}, now);
        }
        if (const auto write = message_writes_.find(asked.token); write != message_writes_.end()) {
            if (!write->second.answered(result)) return;
            const MessageWrite all = write->second;
            message_writes_.erase(write);
            return answered_(asked.token, all.general, {}, all.extended);
        }
        if (asked.token != 0) return;
        const auto owner = owners_.find(asked.output);
        if (owner == owners_.end()) return;
        const auto lane = owner->second.lanes.find(asked.axis);
        if (lane != owner->second.lanes.end()) carry_out(asked.output, owner->second, asked.axis, lane->second.done(good(result)), now);
        return;
    }
    --questions_;
    if (!good(result) && asked.kind == Asked::Kind::write)
        writer_.refused(*asked.origin.who, asked.axis, text_of_parameter(layout_, asked.instance),
                        result.text.empty() ? name_of(result.reason) : result.text, now);
    if (!good(result)) return answered_(asked.token, general_of(result.reason == Reason::none ? Reason::internal : result.reason), {}, 0);
    if (asked.kind == Asked::Kind::write) return answered_(asked.token, General::success, {}, 0);
    const auto info = layout_.parameter(asked.instance);
    const auto bytes = info && known(result.value) ? to_bytes(result.value, info->type) : std::nullopt;
    answered_(asked.token, bytes ? General::success : General::no_stored_data, bytes ? cip::View(*bytes) : cip::View(), 0);
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
    const bool renews = now - renewed_ >= lease_renewal;
    if (renews) renewed_ = now;
    for (auto& [output, owner] : owners_) {
        if (owner.runs) leases_.hold(owner.origin, owner.held, renews, now);
    }
}

}  // namespace axisgate::enip
