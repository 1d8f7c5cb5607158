// Tar: one header of 512 bytes per file, contents filled up to whole blocks. (POSIX.1-1988, ustar)
// In: names and contents. Out: bytes. Never compresses.
#include "gateway/runtime/tar.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace axisgate {
namespace {
constexpr std::size_t block = 512;
}

void Tar::add(std::string_view name, std::string_view content, std::int64_t at_unix_s) {
    std::array<char, block> head{};
    const auto put = [&head](std::size_t at, std::string_view text) { std::memcpy(head.data() + at, text.data(), text.size()); };
    put(0, name.substr(0, 100));
    put(100, "0000600");
    put(108, "0000000");
    put(116, "0000000");
    put(124, fmt::format("{:011o}", content.size()));
    put(136, fmt::format("{:011o}", std::max<std::int64_t>(0, at_unix_s)));
    put(148, "        ");  // the checksum counts itself as blanks
    put(156, "0");
    put(257, std::string_view("ustar\00000", 8));
    unsigned sum = 0;
    for (const char c : head)
        sum += static_cast<unsigned char>(c);
    put(148, std::string_view(fmt::format("{:06o}", sum)));
    head[154] = '\0';
    head[155] = ' ';
    bytes_.append(head.data(), head.size());
    bytes_.append(content);
    bytes_.append((block - content.size() % block) % block, '\0');
}

std::string Tar::finish() && {
    bytes_.append(2 * block, '\0');
    return std::move(bytes_);
}

}  // namespace axisgate
