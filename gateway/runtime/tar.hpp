// Tar: files as one archive in the POSIX ustar format, which every tar reads.
// In: names and contents. Out: the archive's bytes. Never a folder, a link or an owner: what is unpacked belongs to who unpacks it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate {

class Tar {
public:
    /// `name`: up to 100 bytes, with / between folders. `at_unix_s`: the time that every file gets.
    void add(std::string_view name, std::string_view content, std::int64_t at_unix_s);
    /// With the two empty blocks at its end; nothing can be added then.
    [[nodiscard]] std::string finish() &&;

private:
    std::string bytes_;
};

}  // namespace axisgate
