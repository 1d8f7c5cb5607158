// A read is answered at once; a write leaves a LateAnswer and one ticket per command. Faults of address and state are reported before
// "busy", so that a fault always has the same answer. A write is never carried out in part.
#include "gateway/doors/modbus/pdu.hpp"
#include "gateway/doors/modbus/words.hpp"

#include <fmt/core.h>

#include <cstring>
#include <utility>

namespace axisgate::modbus {
namespace {
constexpr bool overflows(std::uint16_t address, std::uint16_t count) noexcept { return std::uint32_t{address} + count > 0x1'0000u; }
constexpr bool outside(std::uint16_t count, std::uint16_t most) noexcept { return count == 0 || count > most; }
/// The text of an exception without a more specific reason.
Refused in_words(Exception e) {
    switch (e) {
        case Exception::illegal_function:
            return {no_axis, Reason::not_supported, "this function is not served", {}, {}};
        case Exception::illegal_address:
            return {no_axis, Reason::unknown_point, "the request reaches beyond address 65535", {}, {}};
        case Exception::illegal_value:
            return {no_axis,
                    Reason::out_of_range,
                    "the request's count, length and data do not fit each other, or go beyond what one request may carry",
                    {},
                    {}};
        case Exception::busy:
            return {no_axis, Reason::busy, "too many writes wait for their drives: wait for their answers", {}, {}};
        case Exception::no_answer:
            return {no_axis, Reason::no_answer, "the drive did not answer in time", {}, {}};
        default:
            return {no_axis, Reason::internal, "the write failed", {}, {}};
    }
}
constexpr std::uint16_t coil_on = 0xFF00, coil_off = 0x0000;
}  // namespace

struct Responder::Request {
    const Client& client;
    std::uint8_t slot;
    UnitMap& map;
    std::span<const std::uint8_t> pdu;
    Instant now;
    std::uint8_t* out;
    LateAnswer& late;

    [[nodiscard]] std::uint16_t word(std::size_t at) const noexcept { return get16(pdu.data() + at); }
};

Responder::Responder(DoorPort& port, registers::RegisterImage& image, Settings settings)
    : port_(port),
      image_(image),
      settings_(std::move(settings)),
      identity_(Identity::gateway(settings_.version, image.word_order())),
      writer_(port, image, {clients, settings_.result_timeout, settings_.max_commands, [](Verdict v) {
                                return fmt::format("exception {}", static_cast<int>(v));
                            }}) {}

bool Responder::may_overtake_waiting(std::span<const std::uint8_t> pdu) noexcept {
    switch (pdu[0]) {
        case function::write_single_coil:
        case function::write_single_register:
        case function::write_multiple_coils:
        case function::write_multiple_registers:
            return true;
        default:
            return false;
    }
}

std::size_t Responder::exception_answer(std::uint8_t fn, Exception e, std::uint8_t* out) noexcept {
    counters_.count(e);
    out[0] = static_cast<std::uint8_t>(fn | function::exception_bit);
    out[1] = static_cast<std::uint8_t>(e);
    return 2;
}

std::size_t Responder::answer(const Client& client, std::uint8_t slot, std::uint8_t unit, std::span<const std::uint8_t> pdu, Instant now,
                              std::uint8_t* out, LateAnswer& late) {
    counters_.requests.add();
    const bool write = is_write(pdu[0]);
    if (!settings_.access.serves(unit, pdu)) {
        if (write && client.who) {
            const RequestNote request = note_of(unit, pdu);
            refused(*client.who, refused_by_access(unit, request), request, Exception::illegal_function, now);
        }
        return exception_answer(pdu[0], Exception::illegal_function, out);
    }
    UnitMap* const map = image_.unit(unit);
    if (!map) {
        if (client.who) {
            refused(*client.who,
                    {no_axis,
                     Reason::line_down,
                     fmt::format("unit {} has no map: unit 1 is the standard map, others get theirs from the site's mappings", unit),
                     {},
                     {}},
                    note_of(unit, pdu), Exception::no_path, now);
        }
        return exception_answer(pdu[0], Exception::no_path, out);
    }
    late.unit = unit;
    late.function = pdu[0];
    Request r{client, slot, *map, pdu, now, out, late};
    const Answer a = dispatch(r);
    // A refused read is reported if its address is not served; a refused write always, also if only the parameter channel shows it.
    if (a.exception != Exception::none || write) {
        Refused why = map->take_refused();
        const bool reported = why.reason != Reason::none;
        if (client.who && (reported || (write && a.exception != Exception::none))) {
            const RequestNote request = note_of(unit, pdu);
            if (!reported) why = in_words(a.exception);
            if (why.axis == no_axis) why.axis = axis_of(unit, request);
            refused(*client.who, std::move(why), request, a.exception, now);
        }
    }
    return a.exception == Exception::none ? a.size : exception_answer(pdu[0], a.exception, out);
}

void Responder::refused(const std::string& who, Refused refused, const RequestNote& request, Exception e, Instant now) {
    writer_.refused(who, std::move(refused), request,
                    e == Exception::none ? std::string() : fmt::format("exception {}", static_cast<int>(e)), now);
}

AxisId Responder::axis_of(std::uint8_t unit, const RequestNote& request) const {
    return image_.is_standard(unit) && request.count > 0 ? port_.image().by_number(request.address / registers::registers_per_axis + 1u)
                                                         : no_axis;
}

Refused Responder::refused_by_access(std::uint8_t unit, const RequestNote& request) const {
    Refused r;
    r.axis = axis_of(unit, request);
    if (settings_.access.functions.any() && !settings_.access.functions.test(request.code)) {
        r.reason = Reason::not_supported;
        r.text = fmt::format("function {} is switched off by [modbus] functions", request.code);
    } else {
        r.reason = Reason::not_writable;
        r.text = "the Modbus door is read-only: it takes a quick stop or switching off by the control word alone";
    }
    return r;
}

std::size_t Responder::finish(const LateAnswer& late, Instant now, std::uint8_t* out) {
    if (late.exception != Exception::none) return exception_answer(late.function, late.exception, out);
    if (!late.reads) {
        std::memcpy(out, late.echo.data(), late.echo_size);
        return late.echo_size;
    }
    UnitMap* const map = image_.unit(late.unit);
    const Exception e = map ? exception_of(map->read_registers(Table::holding_registers, late.read_address, late.read_count, now, out + 2))
                            : Exception::no_path;
    if (e != Exception::none) {
        if (map) (void)map->take_refused();  // of a read that was possible when its write was accepted: the axis was removed meanwhile
        return exception_answer(late.function, e, out);
    }
    out[0] = late.function;
    out[1] = static_cast<std::uint8_t>(2 * late.read_count);
    return 2 + 2 * std::size_t{late.read_count};
}

Responder::Answer Responder::dispatch(Request& r) {
    switch (r.pdu[0]) {
        case function::read_holding_registers:
        case function::read_input_registers:
            return read_registers(r);
        case function::read_coils:
        case function::read_discrete_inputs:
            return read_bits(r);
        case function::write_single_coil:
        case function::write_single_register:
            return write_single(r);
        case function::write_multiple_coils:
        case function::write_multiple_registers:
            return write_multiple(r);
        case function::mask_write_register:
            return mask_write(r);
        case function::read_write_multiple_registers:
            return read_write(r);
        case function::diagnostics:
            return diagnostics(r);
        case function::report_server_id:
            if (r.pdu.size() != 1) return {Exception::illegal_value, 0};
            return {Exception::none, report_server_id(identity_, r.late.unit, r.out)};
        case function::encapsulated_interface:
            return encapsulated(r);
        default:
            return {Exception::illegal_function, 0};
    }
}

Responder::Answer Responder::read_registers(Request& r) {
    if (r.pdu.size() != 5) return {Exception::illegal_value, 0};
    const std::uint16_t address = r.word(1);
    const std::uint16_t count = r.word(3);
    if (outside(count, limit::read_registers)) return {Exception::illegal_value, 0};
    if (overflows(address, count)) return {Exception::illegal_address, 0};
    const Table table = r.pdu[0] == function::read_holding_registers ? Table::holding_registers : Table::input_registers;
    if (const auto e = r.map.read_registers(table, address, count, r.now, r.out + 2); e != Verdict::good) return {exception_of(e), 0};
    r.out[0] = r.pdu[0];
    r.out[1] = static_cast<std::uint8_t>(2 * count);
    return {Exception::none, 2 + 2 * std::size_t{count}};
}

Responder::Answer Responder::read_bits(Request& r) {
    if (r.pdu.size() != 5) return {Exception::illegal_value, 0};
    const std::uint16_t address = r.word(1);
    const std::uint16_t count = r.word(3);
    if (outside(count, limit::read_bits)) return {Exception::illegal_value, 0};
    if (overflows(address, count)) return {Exception::illegal_address, 0};
    const Table table = r.pdu[0] == function::read_coils ? Table::coils : Table::discrete_inputs;
    if (const auto e = r.map.read_bits(table, address, count, r.out + 2); e != Verdict::good) return {exception_of(e), 0};
    const std::size_t bytes = (count + 7u) / 8u;
    r.out[0] = r.pdu[0];
    r.out[1] = static_cast<std::uint8_t>(bytes);
    return {Exception::none, 2 + bytes};
}

Responder::Answer Responder::write_single(Request& r) {
    if (r.pdu.size() != 5) return {Exception::illegal_value, 0};
    if (r.pdu[0] == function::write_single_register) {
        return carry_out(r, Table::holding_registers, r.word(1), 1, r.pdu.data() + 3, 5);
    }
    const std::uint16_t value = r.word(3);
    if (value != coil_on && value != coil_off) return {Exception::illegal_value, 0};
    const std::uint8_t bit = value == coil_on ? 1 : 0;
    return carry_out(r, Table::coils, r.word(1), 1, &bit, 5);
}

Responder::Answer Responder::write_multiple(Request& r) {
    if (r.pdu.size() < 6) return {Exception::illegal_value, 0};
    const bool coils = r.pdu[0] == function::write_multiple_coils;
    const std::uint16_t address = r.word(1);
    const std::uint16_t count = r.word(3);
    const std::size_t bytes = coils ? (count + 7u) / 8u : 2u * count;
    if (outside(count, coils ? limit::write_bits : limit::write_registers)) return {Exception::illegal_value, 0};
    if (r.pdu[5] != bytes || r.pdu.size() != 6 + bytes) return {Exception::illegal_value, 0};
    if (overflows(address, count)) return {Exception::illegal_address, 0};
    return carry_out(r, coils ? Table::coils : Table::holding_registers, address, count, r.pdu.data() + 6, 5);
}

Responder::Answer Responder::mask_write(Request& r) {
    if (r.pdu.size() != 7) return {Exception::illegal_value, 0};
    const std::uint16_t address = r.word(1);
    const std::uint16_t and_mask = r.word(3);
    const std::uint16_t or_mask = r.word(5);
    if (const auto e = r.map.check_write(Table::holding_registers, address, 1); e != Verdict::good) return {exception_of(e), 0};
    if (!r.map.is_exact(address, r.now)) return {Exception::device_failure, 0};  // the rest of the value is not in the register
    std::uint8_t value[2];
    if (const auto e = r.map.read_registers(Table::holding_registers, address, 1, r.now, value); e != Verdict::good)
        return {exception_of(e), 0};
    put16(value, static_cast<std::uint16_t>((get16(value) & and_mask) | (or_mask & ~std::uint32_t{and_mask})));
    return carry_out(r, Table::holding_registers, address, 1, value, 7);
}

Responder::Answer Responder::read_write(Request& r) {
    if (r.pdu.size() < 10) return {Exception::illegal_value, 0};
    const std::uint16_t read_address = r.word(1);
    const std::uint16_t read_count = r.word(3);
    const std::uint16_t write_address = r.word(5);
    const std::uint16_t write_count = r.word(7);
    const std::size_t bytes = 2u * write_count;
    if (outside(read_count, limit::read_write_read) || outside(write_count, limit::read_write_write)) return {Exception::illegal_value, 0};
    if (r.pdu[9] != bytes || r.pdu.size() != 10 + bytes) return {Exception::illegal_value, 0};
    if (overflows(read_address, read_count) || overflows(write_address, write_count)) return {Exception::illegal_address, 0};
    // Both halves are checked before anything is written, because a request that cannot be answered must not move anything.
    if (const auto e = r.map.check_write(Table::holding_registers, write_address, write_count); e != Verdict::good)
        return {exception_of(e), 0};
    if (const auto e = r.map.check_read(Table::holding_registers, read_address, read_count); e != Verdict::good)
        return {exception_of(e), 0};
    r.late.reads = true;
    r.late.read_address = read_address;
    r.late.read_count = read_count;
    return carry_out(r, Table::holding_registers, write_address, write_count, r.pdu.data() + 10, 0);
}

Responder::Answer Responder::diagnostics(Request& r) {
    if (r.pdu.size() < 3 || r.pdu.size() % 2 == 0) return {Exception::illegal_value, 0};
    if (r.word(1) != 0) return {Exception::illegal_function, 0};  // only "return query data"
    std::memcpy(r.out, r.pdu.data(), r.pdu.size());
    return {Exception::none, r.pdu.size()};
}

Responder::Answer Responder::encapsulated(Request& r) {
    if (r.pdu.size() < 2) return {Exception::illegal_value, 0};
    if (r.pdu[1] != function::device_identification) return {Exception::illegal_function, 0};
    if (r.pdu.size() != 4) return {Exception::illegal_value, 0};
    identity_.set_mapping_revision(port_.image().mapping_revision);
    const auto a = read_device_identification(identity_, r.pdu[2], r.pdu[3], r.out);
    return {a.exception, a.size};
}

Responder::Answer Responder::carry_out(Request& r, Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data,
                                       std::size_t echo_size) {
    const auto begun = writer_.write(r.client, r.slot, r.map, table, address, count, data, note_of(r.late.unit, r.pdu), r.now);
    if (begun.verdict != Verdict::good) return {exception_of(begun.verdict), 0};
    LateAnswer& late = r.late;
    late.outstanding = begun.outstanding;
    late.echo_size = static_cast<std::uint8_t>(echo_size);
    if (echo_size > 0) std::memcpy(late.echo.data(), r.pdu.data(), echo_size);
    if (late.outstanding > 0) return {Exception::none, 0};
    return {Exception::none, finish(late, r.now, r.out)};
}

}  // namespace axisgate::modbus
