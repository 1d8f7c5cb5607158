// Control words, and values in and out of a telegram's data bytes, least significant byte first [L532].
// In: values, telegrams. Out: the same.
// Never has state.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "adapters/uim342/twin/wire.hpp"

namespace axisgate::uim342::twin {

/// Function codes by the manual's mnemonics [L258-287]. RT (5A) only ever comes from a drive.
enum Cw : std::uint8_t {
    PP = 0x01,
    IC = 0x06,
    IE = 0x07,
    ML = 0x0B,
    SN = 0x0C,
    ER = 0x0F,
    MT = 0x10,
    MS = 0x11,
    MO = 0x15,
    BG = 0x16,
    ST = 0x17,
    MF = 0x18,
    AC = 0x19,
    DC = 0x1A,
    SS = 0x1B,
    SD = 0x1C,
    JV = 0x1D,
    SP = 0x1E,
    PR = 0x1F,
    PA = 0x20,
    OG = 0x21,
    BL = 0x2D,
    DV = 0x2E,
    IL = 0x34,
    TG = 0x35,
    DI = 0x37,
    QE = 0x3D,
    SY = 0x7E
};

inline void put(Telegram& t, std::size_t at, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        t.d[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// An answer of `count` bytes that begins with the sub-index.
inline void put_indexed(Telegram& t, std::uint8_t index, std::uint32_t value, int bytes) {
    t.d[0] = index;
    put(t, 1, value, bytes);
    t.dl = static_cast<std::uint8_t>(1 + bytes);
}

inline void put_value(Telegram& t, std::uint32_t value, int bytes) {
    put(t, 0, value, bytes);
    t.dl = static_cast<std::uint8_t>(bytes);
}

/// JV, SP, PR and PA acknowledge a SET as DV[index] [L1429, L1452, L1475, L1497].
inline void put_desired(Telegram& t, std::uint8_t index, std::int32_t value) {
    t.cw = DV;
    put_indexed(t, index, static_cast<std::uint32_t>(value), 4);
}

/// DI: what the inputs had last, and the output.
inline void put_ports(Telegram& t, std::uint8_t inputs, bool output) {
    t.d = {inputs, output ? std::uint8_t{1} : std::uint8_t{0}, 0, 0, 0, 0, 0, 0};
    t.dl = 4;
}

inline std::uint32_t value_of(const Telegram& t) {
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(t.dl, 4); ++i)
        v |= std::uint32_t{t.d[i]} << (8 * i);
    return v;
}

inline std::int32_t whole(double v) { return static_cast<std::int32_t>(std::clamp(std::round(v), -2147483648.0, 2147483647.0)); }

}  // namespace axisgate::uim342::twin
