// The content of a request PDU in the terms of the register room, for the text of its refusal. Nothing is checked; missing parts stay 0.
#pragma once

#include <cstdint>
#include <span>

#include "gateway/registers/refusals.hpp"

namespace axisgate::modbus {

using registers::Refused;
using registers::RequestNote;

/// The write of a request, or its range; `count` is 0 if the request is too short.
[[nodiscard]] RequestNote note_of(std::uint8_t unit, std::span<const std::uint8_t> pdu) noexcept;

}  // namespace axisgate::modbus
