// Ini: splits text into sections and keys, within its bounds.
#include "gateway/protocols/canopen/ini.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "gateway/core/text.hpp"

namespace axisgate::canopen {
namespace {
bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }
std::string as_utf8(std::string_view text) {
    const bool whole = is_utf8(text);
    std::string out;
    for (const char c : text) {
        const auto b = static_cast<unsigned char>(c);
        if (whole || b < 0x80) {
            out += is_control(c) ? ' ' : c;
        } else {
            out += static_cast<char>(0xC0 | b >> 6);
            out += static_cast<char>(0x80 | (b & 0x3F));
        }
    }
    return out;
}
}  // namespace

std::string shown_text(std::string_view text) {
    constexpr std::size_t most = 40;
    if (text.size() <= most) return as_utf8(text);
    std::size_t end = most;
    while (end > most - 4 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
        --end;
    return as_utf8(text.substr(0, end)) + "...";
}

void add_note(std::vector<FileFault>& notes, std::size_t line, std::string text) {
    if (notes.size() > most_file_faults) return;
    if (notes.size() == most_file_faults) text = "there are more notes";
    notes.push_back({line, std::move(text)});
}

bool add_fault(std::vector<FileFault>& faults, std::size_t line, std::string text) {
    if (faults.size() > most_file_faults) return false;
    if (faults.size() == most_file_faults) {
        faults.push_back({line, "there are more faults: mend these first"});
        return false;
    }
    faults.push_back({line, std::move(text)});
    return true;
}

const IniKey* IniSection::find(std::string_view wanted) const noexcept {
    const auto it = std::ranges::find(keys, wanted, &IniKey::name);
    return it == keys.end() ? nullptr : &*it;
}
const IniSection* Ini::find(std::string_view name) const {
    const auto it = places_.find(std::string(name));
    return it == places_.end() ? nullptr : &sections_[it->second];
}

namespace {
/// Takes the next line off the text, as UTF-8. LF, CR LF or CR alone end it.
std::string next_row(std::string_view& text) {
    const auto end = std::min(text.find_first_of("\r\n"), text.size());
    std::string row = as_utf8(trimmed(text.substr(0, end)));
    text.remove_prefix(std::min(text.size(), end + (text.substr(end).starts_with("\r\n") ? 2 : 1)));
    return row;
}
}  // namespace

std::optional<Ini> Ini::read(std::string_view text, std::vector<FileFault>& faults, std::vector<FileFault>& notes) {
    const std::size_t before = faults.size();
    if (text.size() > most_bytes) {
        add_fault(faults, 0, fmt::format("the file has {} bytes, and {} are the most", text.size(), most_bytes));
        return std::nullopt;
    }
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    Ini ini;
    std::unordered_set<std::string> names;  // names of the keys of the present section
    std::size_t line = 0, keys = 0;
    bool again = false;  // the present section stands twice: its keys are left out
    while (!text.empty() && faults.size() == before) {
        ++line;
        const std::string utf8 = next_row(text);
        const std::string_view row = trimmed(utf8);
        if (row.empty() || row[0] == ';' || row[0] == '#') continue;
        if (row[0] == '[') {
            const auto close = row.find(']');
            const std::string name = lower(trimmed(row.substr(1, std::min(close, row.find(';')) - 1)));
            if (close == std::string_view::npos)
                add_note(notes, line, fmt::format("\"{}\" begins a section and has no ]: read as [{}]", shown_text(row), shown_text(name)));
            if (ini.sections_.size() == most_sections) {
                add_fault(faults, line, fmt::format("more than {} sections: this is no description of a drive", most_sections));
                break;
            }
            const auto [place, fresh] = ini.places_.emplace(name, ini.sections_.size());
            again = !fresh;
            if (again) {
                add_note(notes, line,
                         fmt::format("the section [{}] stands twice, first in line {}: the second one is left out", shown_text(name),
                                     ini.sections_[place->second].line));
            } else {
                ini.sections_.push_back({name, line, {}});
                names.clear();
            }
            continue;
        }
        const auto equals = row.find('=');
        const std::string name = lower(trimmed(row.substr(0, equals)));
        if (equals == std::string_view::npos || name.empty()) {
            add_note(notes, line, fmt::format("\"{}\" is neither a section nor a key with a value: left out", shown_text(row)));
        } else if (ini.sections_.empty()) {
            add_note(notes, line, fmt::format("the key {} stands before the first section: left out", shown_text(name)));
        } else if (again) {
            continue;
        } else if (!names.insert(name).second) {
            add_note(notes, line,
                     fmt::format("the key {} stands twice in [{}]: the first one counts", shown_text(name),
                                 shown_text(ini.sections_.back().name)));
        } else if (++keys > most_keys) {
            add_fault(faults, line, fmt::format("more than {} keys: this is no description of a drive", most_keys));
        } else {
            ini.sections_.back().keys.push_back({name, std::string(trimmed(row.substr(equals + 1))), line});
        }
    }
    if (faults.size() != before) return std::nullopt;
    return ini;
}

}  // namespace axisgate::canopen
