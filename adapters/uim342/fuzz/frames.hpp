// Frames for the fuzz targets of the UIM342: near enough to the protocol to get past the first check.
// In: the fuzzer's bytes. Out: CAN frames and UIMessages with good CRC, from drives or to them.
#pragma once

#include "adapters/uim342/wire_uimessage.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace axisgate::uim342::fuzz_frames {

inline std::uint8_t any_function(FuzzedDataProvider& in) {
    static constexpr std::uint8_t known[]{cw::PP, cw::IC, cw::IE, cw::ML, cw::SN, cw::ER, cw::MT, cw::MS, cw::MO, cw::BG,
                                          cw::ST, cw::MF, cw::AC, cw::DC, cw::SS, cw::SD, cw::JV, cw::SP, cw::PR, cw::PA,
                                          cw::OG, cw::BL, cw::DV, cw::IL, cw::TG, cw::DI, cw::QE, cw::RT, cw::SY};
    if (in.ConsumeIntegralInRange<int>(0, 7) == 0) return in.ConsumeIntegral<std::uint8_t>() & 0x7F;
    return known[in.ConsumeIntegralInRange<std::size_t>(0, std::size(known) - 1)];
}

inline Message any_message(FuzzedDataProvider& in, std::uint8_t id, bool to_drive) {
    Message m;
    m.id = id;
    m.cw = any_function(in);
    if (in.ConsumeIntegralInRange<int>(0, 7) == 0 ? !to_drive : to_drive) m.cw |= ack_bit;
    m.dl = in.ConsumeIntegralInRange<std::uint8_t>(0, 8);
    for (std::size_t i = 0; i < m.dl; ++i)
        m.d[i] = in.ConsumeBool() ? in.ConsumeIntegralInRange<std::uint8_t>(0, 15) : in.ConsumeIntegral<std::uint8_t>();
    return m;
}

/// On the wire. Bytes may be several messages in one run, or end in the middle of one.
inline Frame on_wire(FuzzedDataProvider& in, LineKind kind, const Message& m, std::uint8_t producer) {
    if (kind == LineKind::can) return to_can(m, producer);
    static constexpr CrcMode modes[]{CrcMode::twelve, CrcMode::twelve, CrcMode::thirteen, CrcMode::none};
    const auto bytes = to_uimessage(m, modes[in.ConsumeIntegralInRange<std::size_t>(0, 3)]);
    std::size_t n = bytes.size();
    if (in.ConsumeIntegralInRange<int>(0, 15) == 0) n = in.ConsumeIntegralInRange<std::size_t>(1, bytes.size());
    return Frame::run({bytes.data(), n});
}

inline std::uint8_t any_id(FuzzedDataProvider& in, const std::vector<std::string>& addresses) {
    if (in.ConsumeIntegralInRange<int>(0, 7) == 0) return in.ConsumeIntegralInRange<std::uint8_t>(0, 127);
    return static_cast<std::uint8_t>(std::stoi(addresses[in.ConsumeIntegralInRange<std::size_t>(0, addresses.size() - 1)]));
}

}  // namespace axisgate::uim342::fuzz_frames
