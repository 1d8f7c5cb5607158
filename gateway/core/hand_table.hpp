// The conditions that a twin's hand can set, as rows: name, present value, and the effect of a write. The list of a twin's conditions and
// the setting of one use the same rows, so that neither has a name that the other lacks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/core/value.hpp"

namespace axisgate {

/// A write of one condition, with the usual conversions of its value: `then` gets the converted value and returns the fault, if there is
/// one.
struct HandWish {
    const std::string& name;
    const Value& value;
    Instant now;
    Out* out = nullptr;

    /// "temperature: 900 is not -50..200 deg C".
    [[nodiscard]] std::string is_not(std::string_view right) const {
        return name + ": " + to_text(value) + " is not " + std::string(right);
    }
    template <class Then>
    [[nodiscard]] std::string flag(Then&& then) const {
        const auto on = as_flag(value);
        return on ? said(then, *on) : is_not("true or false");
    }
    template <class Then>
    [[nodiscard]] std::string whole(std::int64_t low, std::int64_t high, std::string_view right, Then&& then) const {
        const auto n = as_integer(value);
        return n && *n >= low && *n <= high ? said(then, *n) : is_not(right);
    }
    template <class Then>
    [[nodiscard]] std::string number(double low, double high, std::string_view right, Then&& then) const {
        const auto x = as_number(value);
        return x && *x >= low && *x <= high ? said(then, *x) : is_not(right);
    }

private:
    template <class Then, class T>
    static std::string said(Then& then, T x) {
        if constexpr (std::is_void_v<std::invoke_result_t<Then&, T>>) {
            then(x);
            return {};
        } else {
            return then(x);
        }
    }
};

/// `Model` provides the present value, `Hand` accepts a write. Without `write` the condition is read only; without `fitted` it always
/// exists.
template <class Model, class Hand = Model>
struct HandRow {
    std::string_view name;
    bool writable;
    std::string_view description;
    Value (*read)(const Model&, Instant now);
    std::string (*write)(Hand&, const HandWish&) = nullptr;
    bool (*fitted)(const Model&) = nullptr;
};

/// Each condition with its present value, in the order of the rows.
template <class Model, class Hand, std::size_t N>
[[nodiscard]] std::vector<HandItem> hand_items(const HandRow<Model, Hand> (&rows)[N], const Model& model, Instant now) {
    std::vector<HandItem> items;
    for (const auto& row : rows) {
        if (!row.fitted || row.fitted(model))
            items.push_back({std::string(row.name), row.read(model, now), row.writable, std::string(row.description)});
    }
    return items;
}

/// Sets one condition: an empty text, or the fault; no value if no row has this name.
template <class Model, class Hand, std::size_t N>
[[nodiscard]] std::optional<std::string> set_hand_row(const HandRow<Model, Hand> (&rows)[N], const Model& model, Hand& hand,
                                                      const HandWish& wish) {
    const auto* row = std::ranges::find(rows, std::string_view(wish.name), &HandRow<Model, Hand>::name);
    if (row == std::end(rows) || !row->write || (row->fitted && !row->fitted(model))) return std::nullopt;
    return row->write(hand, wish);
}

}  // namespace axisgate
