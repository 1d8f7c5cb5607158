// Request note: what a request PDU asks for, in the words of the register room, for the sentence that tells of its refusal.
// In: a request PDU, which may be too short. Out: a RequestNote. Never checks anything: what cannot be read stays 0.
#pragma once

#include <cstdint>
#include <span>

#include "gateway/registers/refusals.hpp"

namespace axisgate::modbus {

using registers::Refused;
using registers::RequestNote;

/// The write of a request, or its range; `count` 0 where the request is too short to say.
[[nodiscard]] RequestNote note_of(std::uint8_t unit, std::span<const std::uint8_t> pdu) noexcept;

}  // namespace axisgate::modbus
