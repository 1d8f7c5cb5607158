// A new door is one line here. Doors are opened in this order.
#include "gateway/runtime/doors.hpp"

#include <array>

#include "gateway/runtime/door_dds.hpp"
#include "gateway/runtime/door_enip.hpp"
#include "gateway/runtime/door_http.hpp"
#include "gateway/runtime/door_modbus.hpp"

namespace axisgate {

std::span<const DoorDescriptor* const> all_doors() {
    static constexpr std::array all{&modbus_door, &enip_door, &http_door, &dds_door};
    return all;
}

std::string bring_doors() {
    for (const DoorDescriptor* door : all_doors()) {
        if (std::string fault = door->words ? bring(*door->words) : std::string(); !fault.empty()) return fault;
    }
    return {};
}

}  // namespace axisgate
