// A short text that identifies one state of a stored object (a recipe, a user), so that a change can name the state to which it refers. It
// need not be hard to forge. The site has its revision instead.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace axisgate {

/// With quotes, as HTTP writes it. Other parts, or the same text divided otherwise, give another tag; the parts cannot be derived from it.
[[nodiscard]] std::string tag_over(std::initializer_list<std::string_view> parts);

/// The states to which a client refers, in the words of its door.
struct MeantState {
    using Lists = bool (*)(std::string_view text, std::string_view tag, bool weak) noexcept;
    std::string text{};     ///< the state must be one of these; empty: any
    std::string absent{};   ///< it must be none of these; empty: any
    Lists lists = nullptr;  ///< true if the door's text contains a tag
    [[nodiscard]] bool another(std::string_view tag) const { return !text.empty() && !lists(text, tag, false); }
    [[nodiscard]] bool excluded(std::string_view tag) const { return !absent.empty() && lists(absent, tag, true); }
};

}  // namespace axisgate
