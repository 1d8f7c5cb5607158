// Ini: the text form of EDS and DCF files (CiA 306-1, 4): sections of keys, each with its line.
// In: text of any origin and size. Out: sections and keys as they stand, names in lower case for comparing; faults with their line.
// Bounded: 4 MiB, 20,000 sections, 500,000 keys; what is larger is refused as a whole. Never knows what a key means.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace axisgate::canopen {

/// What is wrong in a file, and where. Line 0: the file as a whole.
struct FileFault {
    std::size_t line = 0;
    std::string text;
};

struct IniKey {
    std::string name;   ///< in lower case
    std::string value;  ///< without blanks around it; valid UTF-8 (other bytes are taken as Latin-1), control characters as blanks
    std::size_t line = 0;
};
struct IniSection {
    std::string name;  ///< in lower case
    std::size_t line = 0;
    std::vector<IniKey> keys;
    /// nullptr: it is not there. `name` in lower case.
    [[nodiscard]] const IniKey* find(std::string_view name) const noexcept;
};

class Ini {
public:
    static constexpr std::size_t most_bytes = 4u * 1024 * 1024, most_sections = 20'000, most_keys = 500'000;

    /// Nothing if there is a fault. A line that is neither a section, a key, empty nor a comment (`;`, `#`) is one; so is a section or a
    /// key that stands twice: which of them counts would be a guess.
    [[nodiscard]] static std::optional<Ini> read(std::string_view text, std::vector<FileFault>& faults);
    [[nodiscard]] const std::vector<IniSection>& sections() const noexcept { return sections_; }
    [[nodiscard]] const IniSection* find(std::string_view name) const;  ///< in lower case

private:
    std::vector<IniSection> sections_;
    std::unordered_map<std::string, std::size_t> places_;
};

/// The beginning of somebody's text, for a message.
[[nodiscard]] std::string shown_text(std::string_view text);

/// Most faults that a reader of a file tells; the last one says that there are more.
inline constexpr std::size_t most_file_faults = 50;
/// Adds a fault as long as there is room. False: there is none, and reading on tells nothing new.
bool add_fault(std::vector<FileFault>& faults, std::size_t line, std::string text);

}  // namespace axisgate::canopen
