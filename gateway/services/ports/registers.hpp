// Register port: the register image as a client of a register door would read it now.
// In: unit, table, address, count. Out: bytes or a refusal, by a callback on the service thread.
// Never writes a register.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "gateway/registers/unit_map.hpp"

namespace axisgate {

class RegisterPort {
public:
    virtual ~RegisterPort() = default;
    /// `then`: nothing if too much is asked at once.
    virtual void read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                                std::function<void(std::optional<registers::RegisterRead>)> then) = 0;
};

}  // namespace axisgate
