// AxisObjects is the object dictionary of a node as one of its servos sees it: objects from 6000h on belong to the servo and are 800h
// higher for each axis before it. Indexes are given as CiA 402 defines them for the first axis.
#pragma once

#include <algorithm>

#include "gateway/protocols/canopen/dictionary.hpp"

namespace axisgate::cia402_drive::twin {

class AxisObjects {
public:
    /// `dictionary` must outlive this object.
    AxisObjects(canopen::Dictionary& dictionary, std::uint16_t shift) : d_(dictionary), shift_(shift) {}
    [[nodiscard]] std::uint16_t shift() const noexcept { return shift_; }
    [[nodiscard]] canopen::Address at(std::uint16_t index, std::uint8_t sub = 0) const noexcept {
        return {static_cast<std::uint16_t>(index >= 0x6000 ? index + shift_ : index), sub};
    }
    /// 0 if there is no such entry.
    [[nodiscard]] std::int64_t get(std::uint16_t index, std::uint8_t sub = 0) const { return d_.integer(at(index, sub)).value_or(0); }
    /// An object of the node, independent of the axis.
    [[nodiscard]] std::int64_t of_node(std::uint16_t index) const { return d_.integer({index, 0}).value_or(0); }
    [[nodiscard]] double rate(std::uint16_t index, std::uint8_t sub = 0) const {
        return static_cast<double>(std::max<std::int64_t>(1, get(index, sub)));
    }
    void put(std::uint16_t index, std::int64_t v, std::uint8_t sub = 0) { (void)d_.set(at(index, sub), Value{v}); }
    /// 603Fh, 1001h and 1003h: an error with its code; 1003h keeps the last four codes.
    void note_error(std::uint16_t code, std::uint8_t error_register);
    void clear_error() {
        put(0x603F, 0);
        put(0x1001, 0);
    }

private:
    canopen::Dictionary& d_;
    std::uint16_t shift_;
};

}  // namespace axisgate::cia402_drive::twin
