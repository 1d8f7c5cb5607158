// The table of SDO abort codes and their meanings.
#include "gateway/protocols/canopen/abort.hpp"

#include <fmt/core.h>

#include <array>

namespace axisgate::canopen {
namespace {
constexpr std::array codes{Abort::toggle,
                           Abort::timeout,
                           Abort::command,
                           Abort::block_size,
                           Abort::sequence,
                           Abort::crc,
                           Abort::memory,
                           Abort::access,
                           Abort::write_only,
                           Abort::read_only,
                           Abort::no_object,
                           Abort::not_mappable,
                           Abort::pdo_length,
                           Abort::parameter_incompatible,
                           Abort::device_incompatible,
                           Abort::hardware,
                           Abort::length,
                           Abort::too_long,
                           Abort::too_short,
                           Abort::no_subindex,
                           Abort::value,
                           Abort::too_high,
                           Abort::too_low,
                           Abort::max_below_min,
                           Abort::resource,
                           Abort::general,
                           Abort::transfer,
                           Abort::local_control,
                           Abort::device_state,
                           Abort::no_dictionary,
                           Abort::no_data};
}

std::span<const Abort> all_aborts() noexcept { return codes; }

std::string_view words_of(Abort code) noexcept {
    switch (code) {
        case Abort::none:
            return "";
        case Abort::toggle:
            return "the toggle bit did not alternate";
        case Abort::timeout:
            return "the other side did not go on in time";
        case Abort::command:
            return "the command is not known or does not fit here";
        case Abort::block_size:
            return "the block size is not allowed";
        case Abort::sequence:
            return "the sequence number is not allowed";
        case Abort::crc:
            return "the checksum of the block is wrong";
        case Abort::memory:
            return "there is not enough memory";
        case Abort::access:
            return "this access is not supported";
        case Abort::write_only:
            return "the object can only be written";
        case Abort::read_only:
            return "the object can only be read";
        case Abort::no_object:
            return "the object does not exist";
        case Abort::not_mappable:
            return "the object cannot be mapped to a PDO";
        case Abort::pdo_length:
            return "the mapped objects are longer than a PDO";
        case Abort::parameter_incompatible:
            return "the parameter does not fit others";
        case Abort::device_incompatible:
            return "the device is in itself not compatible";
        case Abort::hardware:
            return "the hardware failed";
        case Abort::length:
            return "the length does not fit the type";
        case Abort::too_long:
            return "the value is too long for the type";
        case Abort::too_short:
            return "the value is too short for the type";
        case Abort::no_subindex:
            return "the subindex does not exist";
        case Abort::value:
            return "the value is not allowed";
        case Abort::too_high:
            return "the value is too high";
        case Abort::too_low:
            return "the value is too low";
        case Abort::max_below_min:
            return "the maximum is below the minimum";
        case Abort::resource:
            return "the resource is not available";
        case Abort::general:
            return "general error";
        case Abort::transfer:
            return "the data cannot be transferred or stored";
        case Abort::local_control:
            return "the data cannot be transferred or stored because of local control";
        case Abort::device_state:
            return "the data cannot be transferred or stored in the present state of the device";
        case Abort::no_dictionary:
            return "there is no object dictionary, or it could not be made";
        case Abort::no_data:
            return "there is no data";
    }
    return "";
}

std::string to_text(Abort code) {
    const auto words = words_of(code);
    const auto number = static_cast<std::uint32_t>(code);
    if (words.empty()) return fmt::format("abort code {:08X}h, which CiA 301 does not have", number);
    return fmt::format("{} ({:08X}h)", words, number);
}

}  // namespace axisgate::canopen
