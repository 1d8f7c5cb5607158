// Elements: how each parameter of the catalogue crosses the wire: which code reads it, which one writes it, with which number.
// In: the catalogue's `wire` keys, once. Out: requests for points, values out of acknowledgements.
// Never holds a value. Keys: scope (axis, drive), read, write (hex codes), number (of a system or axis parameter), byte, bit (a part).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/pacontrol/wire_commands.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::pacontrol {

struct Binding {
    const CommandInfo* read = nullptr;   ///< nullptr: cannot be read over this port
    const CommandInfo* write = nullptr;  ///< nullptr: cannot be written over this port
    bool drive = false;                  ///< belongs to the control: one value, whichever axis asks
    std::optional<std::uint16_t> number;
    std::optional<std::uint8_t> byte, bit;  ///< a part of a 32-bit answer, byte 0 highest as the manual counts
    ValueType type = ValueType::i32;
    bool array = false;
};

class Elements {
public:
    explicit Elements(const Catalogue& catalogue);

    /// nullptr: there is no such point.
    [[nodiscard]] const Binding* binding(Point point) const noexcept;
    [[nodiscard]] static Request read(const Binding& binding, Point point, int channel);
    [[nodiscard]] static Request write(const Binding& binding, Point point, int channel, const Value& value);
    /// The value in an acknowledgement, in the parameter's type.
    [[nodiscard]] static Value value(const Binding& binding, const Reply& reply);

private:
    std::vector<Binding> bindings_;  ///< by parameter
};

}  // namespace axisgate::pacontrol
