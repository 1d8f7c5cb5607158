// State tag: a short text that names one state of something that is kept (a recipe, a user), so that a change can say which state it means.
// In: what makes a state; what a client has named. Out: tags; whether another state was meant. Nothing depends on a tag's being hard to
// forge. The site has its revision.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace axisgate {

/// With quotes, as HTTP writes it: other parts, or parts divided otherwise, are another tag. Gives no part away.
[[nodiscard]] std::string tag_over(std::initializer_list<std::string_view> parts);

/// The states that a client means, in the words of its door.
struct MeantState {
    using Lists = bool (*)(std::string_view text, std::string_view tag, bool weak) noexcept;
    std::string text{};     ///< the state must be one of these; empty: it may be any
    std::string absent{};   ///< it must be none of these; empty: it may be any
    Lists lists = nullptr;  ///< whether the door's text names a tag
    [[nodiscard]] bool another(std::string_view tag) const { return !text.empty() && !lists(text, tag, false); }
    [[nodiscard]] bool excluded(std::string_view tag) const { return !absent.empty() && lists(absent, tag, true); }
};

}  // namespace axisgate
