// The rules by which a simulated node accepts the set-up of its PDOs: those of CiA 301, and those by which drives differ.
#pragma once

#include "adapters/cia402/twin/freedoms.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/dictionary.hpp"

namespace axisgate::cia402_drive::twin {

inline constexpr std::uint16_t pdos = 4;  ///< of each direction

/// The name of an object in the node's memory: "1A00:01".
[[nodiscard]] std::string memory_key(canopen::Address address);

struct SetupState {
    const Freedoms& freedoms;
    const canopen::Dictionary& dictionary;
    bool pre_operational = false;
};
/// Whether PDOs and COB-IDs may be written in this state and order; `none` for other objects.
[[nodiscard]] canopen::Abort fault_of_setup(const SetupState& state, canopen::Address address, std::int64_t value);
/// Whether a mapping object may have this value (CiA 301, 7.5.2.36 and 7.5.2.38); `none` for other objects.
[[nodiscard]] canopen::Abort fault_of_mapping(const Freedoms& freedoms, const canopen::Dictionary& dictionary, canopen::Address address,
                                              std::int64_t value);
/// The PDOs that the drive has by itself, where its memory does not say otherwise: none of them contains an object that the drive lacks,
/// and the extra ones are on.
void shape_pdos(const Freedoms& freedoms, const NonVolatile& memory, canopen::Dictionary& dictionary);

}  // namespace axisgate::cia402_drive::twin
