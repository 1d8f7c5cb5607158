// Files as one archive in the POSIX ustar format, without folders, links and owners: unpacked files belong to the user who unpacks them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

inline constexpr std::size_t tar_block = 512;

/// The header of a file of `bytes` (below 8 GiB). `name` has up to 100 bytes, with / between folders. `at_unix_s` is its time.
[[nodiscard]] std::string tar_header(std::string_view name, std::uint64_t bytes, std::int64_t at_unix_s);
/// Number of zeros from the end of a file of `bytes` to the next block.
[[nodiscard]] inline std::size_t tar_padding(std::uint64_t bytes) noexcept {
    return static_cast<std::size_t>((tar_block - bytes % tar_block) % tar_block);
}

struct TarEntry {
    std::string name;
    std::uint64_t bytes = 0;
    std::int64_t at_unix_s = 0;
};
/// Reads a header exactly as tar_header makes it; empty for any other.
[[nodiscard]] std::optional<TarEntry> read_tar_header(std::string_view block);

class Tar {
public:
    /// As for tar_header; `at_unix_s` is the time of every file.
    void add(std::string_view name, std::string_view content, std::int64_t at_unix_s);
    /// With the two empty blocks at its end; nothing can be added afterwards.
    [[nodiscard]] std::string finish() &&;

private:
    std::string bytes_;
};

}  // namespace axisgate
