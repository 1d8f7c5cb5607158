// The answers to functions 17 (report server id) and 43/14 (read device identification). A value is never split: an object that does not
// fit is in the next answer (more follows).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

/// One object of 43/14. 0..2 are basic, 3..0x7F regular, 0x80..0xFF extended (Modbus Application Protocol 1.1b3, 6.21).
struct IdentityObject {
    static constexpr std::size_t max_value = 244;  ///< so that one object always fits: 253 - 7 (head) - 2 (id, length)
    std::uint8_t id = 0;
    std::string value;  ///< ASCII, at most max_value bytes; the rest is not sent
};

struct Identity {
    std::string server_name = "axisgate";
    std::string version;
    std::vector<IdentityObject> objects;  ///< ascending ids; 0, 1 and 2 are present

    /// The gateway's own: vendor, product code, revision, product name, model name; 0x80 mapping revision (8 hex digits, as register 18),
    /// 0x81 word order. There is no vendor URL.
    [[nodiscard]] static Identity gateway(std::string version, WordOrder order);
    void set_mapping_revision(std::uint32_t revision);
};

/// Function 17: byte count, server id (one byte, as client libraries expect: the requested unit), run indicator 0xFF, then the text
/// "axisgate 1.2.3". Returns the size of the PDU in `out` (max_pdu bytes).
[[nodiscard]] std::size_t report_server_id(const Identity& identity, std::uint8_t unit, std::uint8_t* out) noexcept;

/// Function 43/14 for read code 1..4 and an object id. Stream access (1..3) starts again at object 0 if the id is not in the requested
/// category, as the standard says; individual access (4) to an unknown object is an illegal address; other codes are illegal values.
struct IdentityAnswer {
    Exception exception = Exception::none;
    std::size_t size = 0;
};
[[nodiscard]] IdentityAnswer read_device_identification(const Identity& identity, std::uint8_t code, std::uint8_t object,
                                                        std::uint8_t* out) noexcept;

}  // namespace axisgate::modbus
