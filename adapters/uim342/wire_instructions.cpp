// Instructions of the UIM342: the table, and the rules of matching.
// In: control words and their data. Out: rows, verdicts. Figures from the register of control words [L258-287] and chapter 5 [L1046-1700].
// Never guesses: a control word that is not here is unknown.
#include "adapters/uim342/wire_instructions.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "gateway/core/text.hpp"

namespace axisgate::uim342 {
namespace {
constexpr std::array<std::uint8_t, 3> pp_indices{5, 7, 8};
constexpr std::array<std::uint8_t, 8> ic_indices{0, 1, 2, 3, 4, 5, 6, 7};
constexpr std::array<std::uint8_t, 4> ie_indices{0, 1, 2, 8};
constexpr std::array<std::uint8_t, 11> er_indices{0, 6, 10, 11, 12, 13, 14, 15, 16, 17, 18};
constexpr std::array<std::uint8_t, 5> five{0, 1, 2, 3, 4};
constexpr std::array<std::uint8_t, 4> four{0, 1, 2, 3};
constexpr std::array<std::uint8_t, 3> three{0, 1, 2};
constexpr std::array<std::uint8_t, 2> two{0, 1};
constexpr std::array<std::uint8_t, 2> sy_indices{1, 2};

constexpr Instruction row(std::uint8_t cw, std::string_view name, std::string_view title, bool indexed, int get_dl, int set_dl, Data data,
                          SetAnswer answer, Storage storage, std::span<const std::uint8_t> indices = {}) {
    Instruction i{cw, name, title, indexed, static_cast<std::int8_t>(get_dl), static_cast<std::int8_t>(set_dl), data, answer, storage};
    i.repeatable = cw != cw::BG && cw != cw::SY;
    i.grouped = cw == cw::AC || cw == cw::DC || cw == cw::SP || cw == cw::PR || cw == cw::PA;
    i.takes_mf = i.grouped || cw == cw::SS || cw == cw::SD || cw == cw::JV || cw == cw::BL;
    i.indices = indices;
    return i;
}

using enum Data;
using A = SetAnswer;
using S = Storage;
constexpr std::array table{
    row(cw::PP, "PP", "protocol parameter", true, 1, 2, u8, A::echo, S::flash, pp_indices),
    row(cw::IC, "IC", "initial configuration", true, 1, 3, u16, A::echo, S::eeprom, ic_indices),
    row(cw::IE, "IE", "notification enable", true, 1, 3, u16, A::echo, S::eeprom_off, ie_indices),
    row(cw::ML, "ML", "model", false, 0, -1, raw, A::none, S::none),
    row(cw::SN, "SN", "serial number", false, 0, -1, raw, A::none, S::none),
    row(cw::ER, "ER", "error report", true, 1, 2, u8, A::report, S::none, er_indices),
    row(cw::MT, "MT", "motor driver", true, 1, 3, u16, A::echo, S::eeprom_off, four),
    row(cw::MS, "MS", "motion status", true, 1, 2, u8, A::status, S::none, two),
    row(cw::MO, "MO", "motor driver on/off", false, 0, 1, u8, A::echo, S::ram),
    row(cw::BG, "BG", "begin motion", false, -1, 0, none, A::done, S::none),
    row(cw::ST, "ST", "stop motion", false, -1, 0, none, A::done, S::none),
    row(cw::MF, "MF", "motion parameter group", false, 0, 1, u8, A::echo, S::ram),
    row(cw::AC, "AC", "acceleration", false, 0, 4, u32, A::echo, S::eeprom_off),
    row(cw::DC, "DC", "deceleration", false, 0, 4, u32, A::echo, S::eeprom_off),
    row(cw::SS, "SS", "cut-in speed", false, 0, 4, u32, A::echo, S::eeprom_off),
    row(cw::SD, "SD", "stop deceleration", false, 0, 4, u32, A::echo, S::eeprom_off),
    row(cw::JV, "JV", "jog velocity", false, 0, 4, i32, A::desired, S::ram),
    row(cw::SP, "SP", "PTP speed", false, 0, 4, i32, A::desired, S::ram),
    row(cw::PR, "PR", "relative position", false, 0, 4, i32, A::desired, S::ram),
    row(cw::PA, "PA", "absolute position", false, 0, 4, i32, A::desired, S::ram),
    row(cw::OG, "OG", "set origin", false, -1, 0, none, A::done, S::none),
    row(cw::BL, "BL", "backlash compensation", false, 0, 4, u32, A::echo, S::eeprom_off),
    row(cw::DV, "DV", "desired value", true, 1, -1, i32, A::none, S::none, five),
    row(cw::IL, "IL", "input logic", true, 1, 3, u16, A::echo, S::eeprom_off, four),
    row(cw::TG, "TG", "trigger mode", true, 1, 3, u16, A::echo, S::eeprom_off, three),
    row(cw::DI, "DI", "digital inputs and output", false, 0, 4, u32, A::image, S::ram),
    row(cw::QE, "QE", "encoder", true, 1, 3, u16, A::echo, S::eeprom_off, five),
    row(cw::RT, "RT", "notification", false, -1, -1, raw, A::none, S::none),
    row(cw::SY, "SY", "system operation", true, -1, 1, none, A::silent, S::none, sy_indices),
};

constexpr std::array<std::int8_t, 128> make_by_cw() {
    std::array<std::int8_t, 128> by{};
    by.fill(-1);
    for (std::size_t i = 0; i < table.size(); ++i)
        by[table[i].cw] = static_cast<std::int8_t>(i);
    return by;
}
constexpr auto by_cw = make_by_cw();

/// DV[i] that answers a SET of these four [L1429, L1452, L1475, L1497].
std::uint8_t desired_index(std::uint8_t function) noexcept { return function == cw::PR ? 3 : function == cw::PA ? 4 : 2; }
}  // namespace

std::span<const Instruction> all_instructions() noexcept { return table; }

const Instruction* instruction(std::uint8_t cw) noexcept {
    const auto i = by_cw[cw & 0x7F];
    return i < 0 ? nullptr : &table[static_cast<std::size_t>(i)];
}

const Instruction* instruction_named(std::string_view name) noexcept {
    for (const auto& i : table) {
        if (std::ranges::equal(i.name, name, [](char a, char b) { return a == upper(b); })) return &i;
    }
    return nullptr;
}

std::uint8_t width_of(Data data) noexcept { return data == u8 ? 1 : data == u16 ? 2 : data == u32 || data == i32 ? 4 : 0; }

Range range_of(Data data) noexcept {
    if (data == i32) return {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()};
    return {0, (std::int64_t{1} << 8 * width_of(data)) - 1};
}

Form form_of(const Message& m) noexcept {
    const Instruction* i = instruction(m.cw);
    if (!i) return Form::unknown;
    if (m.dl == i->get_dl) return Form::get;
    if (m.dl == i->set_dl) return Form::set;
    if (!i->indexed && i->set_dl == 4 && i->cw != cw::DI && m.dl >= 1 && m.dl < 4) return Form::set;
    if (i->cw == cw::ER && m.dl == 3) return Form::set;
    return Form::unknown;
}

Message make_get(std::uint8_t node, const Instruction& i, std::uint8_t index) noexcept {
    Message m;
    m.id = node;
    m.cw = i.cw | ack_bit;
    m.dl = static_cast<std::uint8_t>(i.get_dl < 0 ? 0 : i.get_dl);
    if (i.indexed) m.d[0] = index;
    return m;
}

Message make_set(std::uint8_t node, const Instruction& i, std::uint8_t index, std::int64_t value) noexcept {
    Message m;
    m.id = node;
    m.cw = i.cw | ack_bit;
    m.dl = static_cast<std::uint8_t>(i.set_dl < 0 ? 0 : i.set_dl);
    std::uint8_t* p = m.d.data();
    if (i.indexed) *p++ = index;
    if (i.cw == cw::DI) {
        m.d[0] = value != 0;
        m.d[1] = 1;  // d1 = 1: the output is to be written [L1677]
        return m;
    }
    put_uint(p, width_of(i.data), static_cast<std::uint64_t>(value));
    return m;
}

Message get(std::uint8_t node, std::uint8_t cw, std::uint8_t index) noexcept { return make_get(node, *instruction(cw), index); }
Message set(std::uint8_t node, std::uint8_t cw, std::int64_t value, std::uint8_t index) noexcept {
    return make_set(node, *instruction(cw), index, value);
}
Message act(std::uint8_t node, std::uint8_t cw) noexcept { return make_set(node, *instruction(cw), 0, 0); }

std::optional<std::int64_t> value_of(const Message& request, const Message& answer) noexcept {
    const Instruction* i = instruction(request.cw);
    if (!i || answer.function() == cw::ER || i->cw == cw::MS) return std::nullopt;
    const unsigned at = answer.function() == cw::DV || i->indexed ? 1 : 0, width = width_of(i->data);
    if (width == 0 || answer.dl < at + width) return std::nullopt;
    const std::uint8_t* p = answer.d.data() + at;
    return i->data == i32 ? get_i32(p) : static_cast<std::int64_t>(get_uint(p, width));
}

std::optional<ErrorReport> error_report_of(const Message& m) noexcept {
    if (m.cw != cw::ER || m.dl < 4) return std::nullopt;
    return ErrorReport{m.d[0], m.d[1], m.d[2], m.d[3]};
}

Match match(const Message& request, const Message& arrived) noexcept {
    const Instruction* i = instruction(request.cw);
    if ((arrived.cw & ack_bit) || arrived.cw == cw::RT) return Match::no;
    if (!i) {  // a control word of a newer drive, sent by hand
        if (const auto report = error_report_of(arrived)) return (report->cw & 0x7F) == request.function() ? Match::error : Match::no;
        return arrived.cw == request.function() ? Match::answer : Match::no;
    }
    if (arrived.cw == cw::ER) {
        const auto report = error_report_of(arrived);
        if (!report) return i->cw == cw::ER ? Match::torn : Match::no;
        if (i->cw == cw::ER) {
            // ER[0] and a report about something else look alike: its own slot number decides.
            if (report->slot == request.d[0]) return Match::answer;
            return (report->cw & 0x7F) == cw::ER && report->slot == 0 ? Match::error : Match::no;
        }
        if ((report->cw & 0x7F) != i->cw) return Match::no;
        // A report about another index of the same instruction belongs to an older request.
        if (i->indexed && report->index != 0 && request.dl > 0 && report->index != request.d[0]) return Match::no;
        return Match::error;
    }
    const Form form = form_of(request);
    if (form == Form::set && i->answer == SetAnswer::desired) {
        if (arrived.cw != cw::DV) return Match::no;
        if (arrived.dl < 5) return arrived.dl == 0 || arrived.d[0] == desired_index(i->cw) ? Match::torn : Match::no;
        return arrived.d[0] == desired_index(i->cw) ? Match::answer : Match::no;
    }
    if (arrived.cw != i->cw) return Match::no;
    if (i->indexed && request.dl > 0) {
        if (arrived.dl == 0) return Match::torn;
        if (arrived.d[0] != request.d[0]) return Match::no;
    }
    std::size_t need = (i->indexed ? 1u : 0u) + width_of(i->data);
    if (i->cw == cw::ML) need = 3;
    if (i->cw == cw::SN) need = 4;
    if (i->cw == cw::MS) need = 8;
    return arrived.dl >= need ? Match::answer : Match::torn;
}

bool echoes(const Message& request, const Message& answer) noexcept {
    const Instruction* i = instruction(request.cw);
    if (!i || form_of(request) != Form::set) return true;
    if (i->answer == SetAnswer::echo) {
        return std::equal(request.d.begin(), request.d.begin() + request.dl, answer.d.begin()) &&
               std::all_of(answer.d.begin() + request.dl, answer.d.begin() + std::max(request.dl, answer.dl),
                           [](auto b) { return b == 0; });
    }
    if (i->answer == SetAnswer::desired) {
        std::array<std::uint8_t, 4> wanted{};  // short forms are zero-extended
        std::copy_n(request.d.begin(), std::min<std::size_t>(request.dl, 4), wanted.begin());
        return std::equal(wanted.begin(), wanted.end(), answer.d.begin() + 1);
    }
    return true;
}

std::uint16_t mark_of(const Message& request) noexcept {
    const Instruction* i = instruction(request.cw);
    if (i && form_of(request) == Form::set && i->answer == SetAnswer::desired) {
        return static_cast<std::uint16_t>(cw::DV << 8 | desired_index(i->cw));
    }
    const bool indexed = i && i->indexed && request.dl > 0;
    return static_cast<std::uint16_t>(request.function() << 8 | (indexed ? request.d[0] : 0xFF));
}

}  // namespace axisgate::uim342
