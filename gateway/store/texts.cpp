// Limits texts without allocating more than the bound and the mark.
#include "gateway/store/texts.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/store/records.hpp"

namespace axisgate {

std::string cut(std::string_view text, std::size_t most) {
    constexpr std::string_view mark = " [...]";
    if (text.size() <= most) return std::string(text);
    std::size_t n = most > mark.size() ? most - mark.size() : 0;
    // Goes back to the beginning of a character, but not further than the length of one, because the text may not be UTF-8.
    for (int i = 0; i < 3 && n > 0 && (static_cast<unsigned char>(text[n]) & 0xC0u) == 0x80u; ++i)
        --n;
    return std::string(text.substr(0, n)) + std::string(mark);
}

StoreResult<> check_name(std::string_view what, std::string_view name) {
    if (name.empty()) return fail(StoreError::Kind::invalid, fmt::format("the name of the {} is empty", what));
    if (name.size() > max_name_bytes) {
        return fail(StoreError::Kind::invalid,
                    fmt::format("the name of the {} has {} bytes; at most {} can be stored", what, name.size(), max_name_bytes));
    }
    if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; })) {
        return fail(StoreError::Kind::invalid, fmt::format("the name of the {} has control characters", what));
    }
    return {};
}

}  // namespace axisgate
