// The register image, as a client of a register door would read it now. The answer comes by a callback on the service thread. No register
// is written.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "gateway/registers/unit_map.hpp"

namespace axisgate {

class RegisterPort {
public:
    virtual ~RegisterPort() = default;
    /// `then` gets an empty value if too much is requested at once.
    virtual void read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                                std::function<void(std::optional<registers::RegisterRead>)> then) = 0;
};

}  // namespace axisgate
