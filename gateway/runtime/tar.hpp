// Tar: files as one archive in the POSIX ustar format, which every tar reads.
// In: names and contents. Out: the archive's bytes. Never a folder, a link or an owner: what is unpacked belongs to who unpacks it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

inline constexpr std::size_t tar_block = 512;

/// What stands before a file of `bytes` (below 8 GiB). `name`: up to 100 bytes, with / between folders. `at_unix_s`: its time.
[[nodiscard]] std::string tar_header(std::string_view name, std::uint64_t bytes, std::int64_t at_unix_s);
/// Zeros from the end of a file of `bytes` to the next block.
[[nodiscard]] inline std::size_t tar_padding(std::uint64_t bytes) noexcept {
    return static_cast<std::size_t>((tar_block - bytes % tar_block) % tar_block);
}

struct TarEntry {
    std::string name;
    std::uint64_t bytes = 0;
    std::int64_t at_unix_s = 0;
};
/// A header as tar_header makes them, to the bit; nothing for any other.
[[nodiscard]] std::optional<TarEntry> read_tar_header(std::string_view block);

class Tar {
public:
    /// As tar_header has it; `at_unix_s`: the time that every file gets.
    void add(std::string_view name, std::string_view content, std::int64_t at_unix_s);
    /// With the two empty blocks at its end; nothing can be added then.
    [[nodiscard]] std::string finish() &&;

private:
    std::string bytes_;
};

}  // namespace axisgate
