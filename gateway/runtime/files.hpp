// Reads and writes whole small files, with errors as sentences. Writing uses a temporary file, so no incomplete file is left.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

/// The whole file ("-": standard input), at most `limit` bytes; on failure `fault` has the reason.
[[nodiscard]] std::optional<std::string> read_file(const std::string& path, std::string& fault, std::size_t limit = 64u << 20);
/// Empty if written, otherwise the reason why not.
[[nodiscard]] std::string write_file(const std::string& path, std::string_view text);
/// The same for keys and other secrets: readable only by this user from the first moment.
[[nodiscard]] std::string write_secret(const std::string& path, std::string_view text);

}  // namespace axisgate
