// Ini: the text form of EDS and DCF files (CiA 306-1, 4): sections with keys, each with its line number.
// Text of any origin and size is read; names are converted to lower case for comparison, and rows that cannot be used are noted with their
// line. A file above 4 MiB, 20,000 sections or 500,000 keys is refused as a whole. The meaning of the keys is not known here.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace axisgate::canopen {

/// A fault of a file and its line. Line 0: the file as a whole.
struct FileFault {
    std::size_t line = 0;
    std::string text;
};

/// All texts are valid UTF-8: a line that is not is read as Latin-1, and control characters are read as blanks.
struct IniKey {
    std::string name;   ///< in lower case
    std::string value;  ///< without blanks around it
    std::size_t line = 0;
};
struct IniSection {
    std::string name;  ///< in lower case
    std::size_t line = 0;
    std::vector<IniKey> keys;
    /// Returns nullptr if the key is missing. `name` is in lower case.
    [[nodiscard]] const IniKey* find(std::string_view name) const noexcept;
};

class Ini {
public:
    static constexpr std::size_t most_bytes = 4u * 1024 * 1024, most_sections = 20'000, most_keys = 500'000;

    /// Nothing if the file exceeds a bound. A line that is no section, key, blank line or comment (`;`, `#`) is left out with a note; of a
    /// section or a key that occurs twice, the first one counts. Lines end with LF, CR LF or CR.
    [[nodiscard]] static std::optional<Ini> read(std::string_view text, std::vector<FileFault>& faults, std::vector<FileFault>& notes);
    [[nodiscard]] const std::vector<IniSection>& sections() const noexcept { return sections_; }
    [[nodiscard]] const IniSection* find(std::string_view name) const;  ///< in lower case

private:
    std::vector<IniSection> sections_;
    std::unordered_map<std::string, std::size_t> places_;
};

/// The beginning of a text of the file, for a message.
[[nodiscard]] std::string shown_text(std::string_view text);

/// The largest number of faults that a reader reports; the last one says that there are more.
inline constexpr std::size_t most_file_faults = 50;
/// Adds a fault while there is room. Returns false if the list is full and reading on would report nothing new.
bool add_fault(std::vector<FileFault>& faults, std::size_t line, std::string text);
/// The same for notes, of which there are as many at most.
void add_note(std::vector<FileFault>& notes, std::size_t line, std::string text);

}  // namespace axisgate::canopen
