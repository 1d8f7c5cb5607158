// A rendered block is valid as long as its axis' cell has the same revision; age and heartbeat are inserted at each read. The result of a
// parameter exchange is not used for an axis that has been replaced.
#include "gateway/registers/standard_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>

namespace axisgate::registers {
namespace {
constexpr std::uint32_t index_at(std::uint32_t address) noexcept { return address / registers_per_axis; }
constexpr std::uint16_t offset_at(std::uint32_t address) noexcept { return static_cast<std::uint16_t>(address % registers_per_axis); }
bool is_bits(Table table) noexcept { return table == Table::coils || table == Table::discrete_inputs; }
}  // namespace

std::uint8_t* StandardMap::block(std::uint32_t index) {
    const Image& image = port_.image();
    const AxisId id = axis_at(index);
    if (id == no_axis) {
        if (index < rows_.size() && rows_[index].id != no_axis) rows_[index].belong_to(no_axis);
        return nullptr;
    }
    if (index >= rows_.size()) {
        rows_.resize(index + 1);
        blocks_.resize(rows_.size() * block_size);
    }
    if (mapping_revision_ != image.mapping_revision) {
        mapping_revision_ = image.mapping_revision;
        for (auto& row : rows_)
            row.revision = 0;
    }
    Row& row = rows_[index];
    std::uint8_t* const bytes = blocks_.data() + index * block_size;
    // Cells start at revision 0 and count from 1, so 0 also means "not rendered".
    const std::uint64_t revision = image.cell(id).revision();
    if (row.id != id) {
        row.belong_to(id);
        std::memset(bytes, 0, block_size);
    } else if (row.revision == revision && revision != 0) {
        return bytes;
    }
    render(image.picture(id), mapping_revision_, order_, bytes);
    put_refusals(row, bytes);
    row.revision = revision;
    ++renders_;
    return bytes;
}

void StandardMap::put_refusals(const Row& row, std::uint8_t* block) noexcept {
    put16(block + 2 * std::size_t{reg::refusal_reason}, static_cast<std::uint16_t>(row.refused));
    put16(block + 2 * std::size_t{reg::refusals}, row.refusals);
}

void StandardMap::note_refusal(AxisId axis, Reason reason) {
    const std::uint16_t number = port_.image().picture(axis).number;
    std::uint8_t* const bytes = number == 0 ? nullptr : block(number - 1u);
    if (!bytes) return;
    Row& row = rows_[number - 1u];
    row.refused = reason;
    ++row.refusals;
    put_refusals(row, bytes);
}

Verdict StandardMap::no_such_axis(std::uint32_t index) {
    return refuse(Verdict::no_path, no_axis, Reason::line_down,
                  fmt::format("no axis has the number {}, to which addresses {}..{} belong", index + 1, index * registers_per_axis,
                              (index + 1) * registers_per_axis - 1));
}

Verdict StandardMap::check_read(Table, std::uint16_t address, std::uint16_t count) {
    const std::uint32_t last = index_at(std::uint32_t{address} + count - 1);
    for (std::uint32_t i = index_at(address); i <= last; ++i) {
        if (axis_at(i) == no_axis) return no_such_axis(i);
    }
    return Verdict::good;
}

Verdict StandardMap::read_registers(Table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) {
    const std::uint32_t begin = address;
    const std::uint32_t end = begin + count;
    const std::uint32_t first = index_at(begin);
    const std::uint32_t last = index_at(end - 1);
    for (std::uint32_t i = first; i <= last; ++i) {
        if (!block(i)) return no_such_axis(i);
    }
    std::memcpy(out, blocks_.data() + 2 * std::size_t{begin}, 2 * std::size_t{count});
    for (std::uint32_t i = first; i <= last; ++i) {
        const std::uint32_t base = i * registers_per_axis;
        // Age and heartbeat belong to the instant of the request. A read may begin or end in the middle of the age.
        if (base + reg::heartbeat < begin || base + reg::age >= end) continue;
        std::uint8_t words[6];
        put32(words, age_ms(port_.image().picture(rows_[i].id), now), order_);
        put16(words + 4, heartbeat(now));
        const std::uint32_t from = std::max(begin, base + reg::age);
        const std::uint32_t to = std::min(end, base + reg::heartbeat + 1u);
        std::memcpy(out + 2 * std::size_t(from - begin), words + 2 * std::size_t(from - base - reg::age), 2 * std::size_t(to - from));
    }
    return Verdict::good;
}

Verdict StandardMap::read_bits(Table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) {
    std::memset(out, 0, (count + 7u) / 8u);
    const std::uint32_t begin = address;
    const std::uint32_t end = begin + count;
    for (std::uint32_t at = begin; at < end;) {
        const AxisId id = axis_at(index_at(at));
        if (id == no_axis) return no_such_axis(index_at(at));
        const std::uint16_t skip = offset_at(at);
        const std::uint32_t n = std::min<std::uint32_t>(registers_per_axis - skip, end - at);
        std::uint64_t bits = bits_of(port_.image().picture(id)) >> skip;
        if (n < 64) bits &= (std::uint64_t{1} << n) - 1;
        for (std::uint32_t to = at - begin; bits != 0;) {  // to: the bit of `out` for the lowest of `bits`
            const std::uint32_t shift = to % 8;
            out[to / 8] = static_cast<std::uint8_t>(out[to / 8] | (bits << shift));
            bits >>= 8 - shift;
            to += 8 - shift;
        }
        at += n;
    }
    return Verdict::good;
}

Verdict StandardMap::check_write(Table table, std::uint16_t address, std::uint16_t count) {
    // Coils show the state; orders are written as a control word. No writable range spans two axes.
    const AxisId axis = axis_at(index_at(address));
    if (is_bits(table) || table == Table::input_registers)
        return refuse(Verdict::no_address, axis, Reason::not_writable,
                      "coils and inputs only show what is: write the control word, register 32 of the axis");
    const std::uint16_t offset = offset_at(address);
    switch (const auto e = check_write_offsets(offset, count)) {
        case Verdict::good:
            break;
        case Verdict::bad_value:
            return refuse(e, axis, Reason::out_of_range, "half of a 32-bit value: write both of its registers in one request");
        default: {
            std::uint32_t wrong = offset;
            while (wrong < offset + count && wrong < registers_per_axis && is_writable(static_cast<std::uint16_t>(wrong)))
                ++wrong;
            const auto name = wrong < registers_per_axis ? name_at(static_cast<std::uint16_t>(wrong)) : std::string_view();
            return refuse(e, axis, name.empty() ? Reason::unknown_point : Reason::not_writable,
                          name.empty() ? fmt::format("register {} of the axis' 64 cannot be written: 32..45, 48..50, 52 and 53 can", wrong)
                                       : fmt::format("register {} of the axis' 64 ({}) can only be read", wrong, name));
        }
    }
    return axis == no_axis ? no_such_axis(index_at(address)) : Verdict::good;
}

Verdict StandardMap::write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) {
    if (const auto e = check_write(table, address, count); e != Verdict::good) return e;
    const std::uint32_t index = index_at(address);
    const std::uint16_t offset = offset_at(address);
    if (offset >= reg::channel_selector) return write_channel(index, offset, count, data, plan);
    plan.commands.push_back({axis_at(index), process_data(offset, count, data, order_), false, 0});
    return Verdict::good;
}

Verdict StandardMap::write_channel(std::uint32_t index, std::uint16_t offset, std::uint16_t count, const std::uint8_t* data,
                                   WritePlan& plan) {
    std::uint8_t* const bytes = block(index);
    if (!bytes) return Verdict::no_path;
    Row& row = rows_[index];
    if (!row.channel) row.channel = std::make_unique<ParameterChannel>();

    ParameterChannel::Write write;
    const auto has = [&](std::uint16_t r) { return r >= offset && r < offset + count; };
    const auto at = [&](std::uint16_t r) { return data + 2 * std::size_t(r - offset); };
    if (has(reg::channel_selector)) write.selector = get32(at(reg::channel_selector), order_);
    if (has(reg::channel_request)) write.request = get16(at(reg::channel_request));
    if (has(reg::channel_value)) write.value = get32(at(reg::channel_value), order_);

    auto outcome = row.channel->write(write, port_.catalogue(row.id));
    const ParameterChannel& channel = *row.channel;
    if (outcome.verdict != Verdict::good)
        return refuse(outcome.verdict, row.id, outcome.verdict == Verdict::busy ? Reason::busy : Reason::out_of_range, channel.why());
    if (write.request && channel.state() == ParameterChannel::State::refused)
        refused_ = {row.id, channel.reason(), channel.why(), channel.parameter(), channel.wanted()};
    if (outcome.command) {
        ++row.exchange;
        plan.commands.push_back({row.id, std::move(*outcome.command), true, (std::uint32_t{row.exchange} << 16) | index});
    }
    row.channel->render(order_, bytes);
    return Verdict::good;
}

void StandardMap::on_own_result(std::uint32_t note, const Result& result) {
    const std::uint32_t index = note & 0xFFFFu;
    if (index >= rows_.size()) return;
    Row& row = rows_[index];
    // The axis may have been removed or replaced since, together with its channel.
    if (!row.channel || row.exchange != (note >> 16)) return;
    row.channel->finish(result, port_.catalogue(row.id));
    if (const auto& c = *row.channel; c.state() == ParameterChannel::State::refused)
        refused_ = {row.id, c.reason(), c.why(), c.parameter(), c.wanted()};
    row.channel->render(order_, blocks_.data() + index * block_size);
}

}  // namespace axisgate::registers
