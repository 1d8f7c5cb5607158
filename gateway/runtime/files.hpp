// Files: reading and writing whole small files, with errors as sentences.
// In: paths. Out: text, or why not. Never leaves a half-written file: writing goes through a temporary one.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

/// The whole file ("-": standard input), at most `limit` bytes; on failure `fault` says why.
[[nodiscard]] std::optional<std::string> read_file(const std::string& path, std::string& fault, std::size_t limit = 64u << 20);
/// Empty: written. Else why not.
[[nodiscard]] std::string write_file(const std::string& path, std::string_view text);
/// The same for keys and the like: from its first moment it is readable by this user alone.
[[nodiscard]] std::string write_secret(const std::string& path, std::string_view text);

}  // namespace axisgate
