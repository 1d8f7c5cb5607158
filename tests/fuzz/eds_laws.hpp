// Checks that a data sheet of any description is read back, by a reader of its own, as the description says. Forms that the standard does
// not allow are not read.
#pragma once

#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "gateway/protocols/cip/eds.hpp"

namespace axisgate::cip::laws {

using Entries = std::map<std::string, std::map<std::string, std::vector<std::string>>>;

/// Sections with their entries; false: it is not a sheet. A text keeps its quotation marks.
inline bool read_sheet(const std::string& text, Entries& into) {
    std::map<std::string, std::vector<std::string>>* section = nullptr;
    std::string key, field;
    std::vector<std::string> fields;
    bool quoted = false;
    const auto trimmed = [](const std::string& s) {
        const auto from = s.find_first_not_of(' ');
        return from == std::string::npos ? std::string() : s.substr(from, s.find_last_not_of(' ') + 1 - from);
    };
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find("\r\n", at);
        if (end == std::string::npos) return false;
        const std::string line = text.substr(at, end - at);
        at = end + 2;
        if (line.starts_with('$')) continue;
        if (line.starts_with('[')) {
            if (!key.empty() || !fields.empty() || !line.ends_with(']')) return false;
            section = &into[line.substr(1, line.size() - 2)];
            continue;
        }
        for (const char c : line) {
            if (c < 0x20 || c > 0x7E) return false;
            if (c == '"') quoted = !quoted;
            if (quoted || (c != '=' && c != ',' && c != ';')) {
                field += c;
            } else if (c == '=') {
                if (!key.empty() || !fields.empty()) return false;
                key = trimmed(std::exchange(field, {}));
            } else {
                fields.push_back(trimmed(std::exchange(field, {})));
                if (c == ',') continue;
                if (!section || key.empty() || !section->emplace(std::exchange(key, {}), std::exchange(fields, {})).second) return false;
            }
        }
        if (quoted) return false;  // a text ends in the line in which it begins
    }
    return key.empty() && fields.empty() && trimmed(field).empty();
}

/// The bytes of a number in the form of a sheet; empty: it is not of the type.
inline Bytes number_in(const std::string& text, DataType type) {
    const char *const begin = text.data(), *const end = begin + text.size();
    std::uint64_t raw = 0;
    std::from_chars_result r{};
    if (type == DataType::real) {
        float f = 0;
        r = std::from_chars(begin, end, f);
        if (!std::isfinite(f)) return {};
        raw = std::bit_cast<std::uint32_t>(f);
    } else if (type == DataType::lreal) {
        double d = 0;
        r = std::from_chars(begin, end, d);
        if (!std::isfinite(d)) return {};
        raw = std::bit_cast<std::uint64_t>(d);
    } else if (text.starts_with('-')) {
        std::int64_t n = 0;
        r = std::from_chars(begin, end, n);
        raw = static_cast<std::uint64_t>(n);
    } else {
        r = std::from_chars(begin, end, raw);
    }
    if (r.ec != std::errc() || r.ptr != end) return {};
    Bytes out;
    put(out, raw, size_of(type));
    return out;
}

/// nullptr: the sheet agrees with the description.
inline const char* broken_by(const Description& d, const EdsNames& names) {
    Entries sheet;
    if (!read_sheet(eds_text(d, names), sheet)) return "a sheet can be read";
    const auto in = [](const auto& map, const std::string& key) -> const std::vector<std::string>* {
        const auto it = map.find(key);
        return it == map.end() ? nullptr : &it->second;
    };
    auto& params = sheet["Params"];
    std::size_t entries = 0;
    for (std::uint32_t i = 1; i <= d.parameters(); ++i) {
        const ParameterInfo p = *d.parameter(i);
        const auto* fields = in(params, "Param" + std::to_string(i));
        ++entries;
        if (!fields || fields->size() != 21) return "every parameter has an entry of its 21 fields";
        if (std::stoul((*fields)[4], nullptr, 16) != static_cast<unsigned>(p.type) || (*fields)[5] != std::to_string(size_of(p.type)))
            return "an entry has the parameter's type and size";
        if (((std::stoul((*fields)[3], nullptr, 16) & 0x10) != 0) == p.writable) return "who can be written is not marked as read only";
        for (const std::size_t text : {6u, 7u, 8u}) {
            const std::string& t = (*fields)[text];
            if (t.size() < 2 || t.front() != '"' || t.back() != '"' || t.find('"', 1) != t.size() - 1 || t.find('\\') != std::string::npos)
                return "a text is one text";
        }
        if ((*fields)[6].size() > 34 || (*fields)[7].size() > 18 || (*fields)[8].size() > 66) return "a text is as long as the form allows";
        const std::pair<const Bytes*, std::size_t> numbers[] = {{&p.min, 9}, {&p.max, 10}, {&p.fallback, 11}};
        for (const auto& [bytes, at] : numbers) {
            const std::string& text = (*fields)[at];
            if (text.empty()) continue;
            if (number_in(text, p.type) != *bytes) return "a number is read as the same";
        }
        if (p.allowed.empty()) continue;
        ++entries;
        const auto* list = in(params, "Enum" + std::to_string(i));
        if (!list || list->size() != 2 * p.allowed.size()) return "every allowed value is named";
        for (std::size_t k = 0; k < p.allowed.size(); ++k) {
            if ((*list)[2 * k] != std::to_string(p.allowed[k].first)) return "an allowed value is read as the same";
        }
    }
    if (params.size() != entries) return "there is no entry of a parameter that is not there";
    for (const std::uint32_t instance : d.assemblies()) {
        const auto* fields = in(sheet["Assembly"], "Assem" + std::to_string(instance));
        if (!fields || fields->size() != 8 || (*fields)[2] != std::to_string(d.assembly(instance)->size)) return "an assembly has its size";
    }
    for (const auto& [key, fields] : sheet["Connection Manager"]) {
        if (!key.starts_with("Connection")) continue;
        for (const std::size_t at : {3u, 6u}) {
            const auto* assembly = fields.size() == 15 ? in(sheet["Assembly"], fields[at + 1]) : nullptr;
            if (!assembly || (*assembly)[2] != fields[at] || fields[at] == "") return "a connection has the sizes of its assemblies";
        }
    }
    return nullptr;
}

}  // namespace axisgate::cip::laws
