// Points: how each parameter of the catalogue crosses the wire: control word, sub-index, motion parameter group, part of the answer.
// In: the catalogue's `wire` keys, once. Out: bindings by point, and the points that an answer tells something about.
// Never holds a value. Keys: cw, index (arrays: the element), mf (2..7), byte, bytes, bit, bits (part of a raw answer).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "adapters/uim342/wire_instructions.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::uim342 {

/// One point on the wire.
struct Binding {
    Point point;
    const Instruction* instruction = nullptr;
    std::uint8_t index = 0;
    std::uint8_t mf = 0;     ///< 0: group 0, no MF needed
    bool part = false;       ///< a part of the answer, cut out by the keys below; cannot be written
    std::uint8_t byte = 0;   ///< first byte of the part, counted from d0
    std::uint8_t bytes = 0;  ///< 1..8
    std::uint8_t bit = 0;    ///< lowest bit within the part ...
    std::uint8_t bits = 0;   ///< ... and how many; 0: all
    ValueType type = ValueType::i32;
};

class Points {
public:
    explicit Points(const Catalogue& catalogue);

    /// nullptr: the point does not exist, or its parameter says nothing about the wire.
    [[nodiscard]] const Binding* binding(Point point) const noexcept;
    /// Calls `f(const Binding&, Value)` for every point that `answer` (from group `mf`) tells.
    template <class F>
    void each(const Message& answer, std::uint8_t mf, F&& f) const {
        for (const std::uint16_t n : by_cw_[answer.function()]) {
            const Binding& b = bindings_[n];
            if (b.mf != mf || (b.instruction->indexed && (answer.dl == 0 || answer.d[0] != b.index))) continue;
            if (auto v = value(b, answer)) f(b, std::move(*v));
        }
    }
    /// The value of a point in an answer of its control word; nothing if the answer is too short.
    [[nodiscard]] static std::optional<Value> value(const Binding& binding, const Message& answer);

private:
    std::vector<Binding> bindings_;
    std::vector<std::uint16_t> first_;  ///< by parameter: its first binding (its elements follow); none: 0xFFFF
    std::array<std::vector<std::uint16_t>, 128> by_cw_;
    const Catalogue* catalogue_;
};

}  // namespace axisgate::uim342
