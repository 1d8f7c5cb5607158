// One header of 512 bytes per file, contents padded to whole blocks (POSIX.1-1988, ustar), without compression.
#include "gateway/runtime/tar.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstring>

namespace axisgate {
namespace {
std::optional<std::uint64_t> octal(std::string_view digits) {
    std::uint64_t value = 0;
    const auto [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 8);
    if (ec != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    return value;
}
}  // namespace

std::string tar_header(std::string_view name, std::uint64_t bytes, std::int64_t at_unix_s) {
    std::string head(tar_block, '\0');
    const auto put = [&head](std::size_t at, std::string_view text) { std::memcpy(head.data() + at, text.data(), text.size()); };
    put(0, name.substr(0, 100));
    put(100, "0000600");
    put(108, "0000000");
    put(116, "0000000");
    put(124, fmt::format("{:011o}", bytes));
    put(136, fmt::format("{:011o}", std::max<std::int64_t>(0, at_unix_s)));
    put(148, "        ");  // the checksum counts its own field as blanks
    put(156, "0");
    put(257, std::string_view("ustar\00000", 8));
    unsigned sum = 0;
    for (const char c : head)
        sum += static_cast<unsigned char>(c);
    put(148, std::string_view(fmt::format("{:06o}", sum)));
    head[154] = '\0';
    head[155] = ' ';
    return head;
}

std::optional<TarEntry> read_tar_header(std::string_view block) {
    if (block.size() != tar_block) return std::nullopt;
    const auto bytes = octal(block.substr(124, 11)), at = octal(block.substr(136, 11));
    if (!bytes || !at) return std::nullopt;
    TarEntry e{std::string(block.substr(0, std::min<std::size_t>(block.find('\0'), 100))), *bytes, static_cast<std::int64_t>(*at)};
    if (block != tar_header(e.name, e.bytes, e.at_unix_s)) return std::nullopt;
    return e;
}

void Tar::add(std::string_view name, std::string_view content, std::int64_t at_unix_s) {
    bytes_ += tar_header(name, content.size(), at_unix_s);
    bytes_ += content;
    bytes_.append(tar_padding(content.size()), '\0');
}

std::string Tar::finish() && {
    bytes_.append(2 * tar_block, '\0');
    return std::move(bytes_);
}

}  // namespace axisgate
