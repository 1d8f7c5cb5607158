// Names become identifiers of IEC 61131-3. Booleans and texts become words, because BOOL and STRING would move the following members. No
// comment or name can end the construct that contains it.
#include "gateway/registers/register_lists.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "gateway/axis/points.hpp"
#include "gateway/core/text.hpp"

namespace axisgate {
namespace {
bool is_bits(MapTable t) { return t == MapTable::coils || t == MapTable::discrete_inputs; }

std::string html(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

/// An identifier of IEC 61131-3: letters, digits and single underscores, not beginning with a digit.
std::string st_name(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            out += c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    while (!out.empty() && out.back() == '_')
        out.pop_back();
    if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) != 0) out.insert(0, "v_");
    return out;
}
/// The type of a member that is exactly as long as the mapping's registers. A BOOL is a byte or a bit, and a STRING has an end mark that
/// the registers do not have: both would move the following members.
std::string st_type(const Mapping& m) {
    if (is_bits(m.table)) return "BOOL";
    switch (m.type) {
        case MapType::boolean:
            return "WORD";
        case MapType::u16:
            return "UINT";
        case MapType::i16:
            return "INT";
        case MapType::u32:
            return "UDINT";
        case MapType::i32:
            return "DINT";
        case MapType::f32:
            return "REAL";
        case MapType::u64:
            return "ULINT";
        case MapType::i64:
            return "LINT";
        case MapType::f64:
            return "LREAL";
        case MapType::string:
            return fmt::format("ARRAY[0..{}] OF WORD", m.length - 1);
    }
    return "WORD";
}
std::string st_note(const Mapping& m) {
    if (is_bits(m.table)) return "bool";
    if (m.type == MapType::boolean) return "bool: 0 or 1";
    if (m.type == MapType::string) return fmt::format("text of {} characters, two in a register, the first in its high byte", 2 * m.length);
    return fmt::format("{}, {}", name_of(m.type), name_of(m.word_order));
}
/// Removes the end of a comment from a text inside a comment.
std::string st_comment(std::string_view text) {
    std::string out;
    for (const char c : text)
        out += c == '*' || c == '(' || c == ')' || static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return out;
}

}  // namespace

std::string unit_of(AxisPoint point, std::string_view axis_unit) {
    const auto* row = row_of(point);
    return row ? text_of(row->unit, axis_unit) : std::string();
}

std::string register_number(MapTable table, std::uint32_t address) {
    constexpr std::array<char, 4> digits{'0', '1', '4', '3'};  // in the order of MapTable
    constexpr std::uint32_t most_in_five = 9999;
    const char digit = digits[static_cast<std::size_t>(table)];
    return address < most_in_five ? fmt::format("{}{:04}", digit, address + 1) : fmt::format("{}{:05}", digit, address + 1);
}

std::string list_csv(const std::vector<ListedMapping>& list, const std::string& revision) {
    std::string s =
        "unit,table,address,registers,type,word_order,axis,point,scale,offset,access,comment,mapping_revision,register_number,engineering_"
        "unit\r\n";
    for (const auto& [m, unit] : list) {
        s += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", m.unit, name_of(m.table), m.address, m.size(), name_of(m.type),
                         name_of(m.word_order), csv_cell(m.axis), csv_cell(m.point), m.scale, m.offset, name_of(m.access),
                         csv_cell(m.comment), revision, register_number(m.table, m.address), csv_cell(unit));
    }
    return s;
}

std::string list_html(const std::vector<ListedMapping>& list, const std::string& revision) {
    std::string s = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Register list {0}</title></head>\n<body><h1>Register "
        "list</h1>\n"
        "<p>Mapping revision {0} (registers 18 and 19). Addresses count from 0, numbers from 1.</p>\n<table border=\"1\">\n<thead><tr>",
        revision);
    for (const auto* head : {"Unit", "Table", "Address", "Number", "Registers", "Type", "Word order", "Axis", "Point", "Measured in",
                             "Scale", "Offset", "Access", "Comment"})
        s += fmt::format("<th>{}</th>", head);
    s += "</tr></thead>\n<tbody>\n";
    for (const auto& [m, unit] : list) {
        s += "<tr>";
        for (const auto& cell :
             {std::to_string(m.unit), std::string(name_of(m.table)), std::to_string(m.address), register_number(m.table, m.address),
              std::to_string(m.size()), std::string(name_of(m.type)), std::string(name_of(m.word_order)), html(m.axis), html(m.point),
              html(unit), fmt::format("{}", m.scale), fmt::format("{}", m.offset), std::string(name_of(m.access)), html(m.comment)})
            s += fmt::format("<td>{}</td>", cell);
        s += "</tr>\n";
    }
    return s + "</tbody></table></body></html>\n";
}

std::string list_st(const std::vector<ListedMapping>& list, const std::string& revision) {
    std::string s = fmt::format(
        "(* Register list, mapping revision 16#{} (registers 18 and 19).\n"
        "   One structure for each run of addresses without a gap: what can be read at once. Each member is as long as its registers, in "
        "words\n"
        "   from the first address: no system may put bytes between them. CODESYS, TwinCAT: the attribute pack_mode at each structure says "
        "so.\n"
        "   Siemens: a block without optimized access. Rockwell, others without packing: an array of words, and copy from the offsets "
        "(+n).\n"
        "   Values of several registers have the word order that stands behind them; swap words where the system has the other one. *)\n",
        revision);
    if (list.empty()) return s + "(* no mappings *)\n";
    std::vector<std::string> used;
    for (std::size_t i = 0; i < list.size();) {
        const Mapping& first = list[i].mapping;
        std::size_t next = i;
        std::uint32_t end = first.address;
        for (; next < list.size(); ++next) {
            const Mapping& m = list[next].mapping;
            if (m.unit != first.unit || m.table != first.table || m.address != end) break;
            end = m.end();
        }
        const bool bits = is_bits(first.table);
        s += fmt::format("\n(* unit {}, {} {}..{} ({}): {} {} *)\n", first.unit, name_of(first.table), first.address, end - 1,
                         register_number(first.table, first.address), end - first.address, bits ? "bits, one member each" : "registers");
        s += fmt::format("{{attribute 'pack_mode' := '1'}}\nTYPE\n  Unit{}_{}_{} : STRUCT\n", first.unit, name_of(first.table),
                         first.address);
        used.clear();
        for (; i < next; ++i) {
            const Mapping& m = list[i].mapping;
            const std::string base = st_name(m.axis + "_" + m.point);
            std::string name = base;
            for (int n = 2; std::ranges::find(used, lower(name)) != used.end(); ++n)
                name = fmt::format("{}_{}", base, n);
            used.push_back(lower(name));
            s += fmt::format("    {} : {}; (* +{} {} {}, {}, scale {}, offset {}{}{} *)\n", name, st_type(m), m.address - first.address,
                             name_of(m.table), m.address, st_note(m), m.scale, m.offset,
                             list[i].unit.empty() ? std::string() : ", " + st_comment(list[i].unit),
                             m.comment.empty() ? std::string() : ": " + st_comment(m.comment));
        }
        s += "  END_STRUCT;\nEND_TYPE\n";
    }
    return s;
}

}  // namespace axisgate
