// SDO abort codes (CiA 301, 7.2.4.3.17): the reason with which either side ends a transfer, and its meaning in words.
// Unknown codes are accepted and shown as numbers, because manufacturers use codes of their own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace axisgate::canopen {

enum class Abort : std::uint32_t {
    none = 0,
    toggle = 0x05030000,
    timeout = 0x05040000,
    command = 0x05040001,
    block_size = 0x05040002,
    sequence = 0x05040003,
    crc = 0x05040004,
    memory = 0x05040005,
    access = 0x06010000,
    write_only = 0x06010001,
    read_only = 0x06010002,
    no_object = 0x06020000,
    not_mappable = 0x06040041,
    pdo_length = 0x06040042,
    parameter_incompatible = 0x06040043,
    device_incompatible = 0x06040047,
    hardware = 0x06060000,
    length = 0x06070010,
    too_long = 0x06070012,
    too_short = 0x06070013,
    no_subindex = 0x06090011,
    value = 0x06090030,
    too_high = 0x06090031,
    too_low = 0x06090032,
    max_below_min = 0x06090036,
    resource = 0x060A0023,
    general = 0x08000000,
    transfer = 0x08000020,
    local_control = 0x08000021,
    device_state = 0x08000022,
    no_dictionary = 0x08000023,
    no_data = 0x08000024
};
/// All codes of the standard, without `none`.
[[nodiscard]] std::span<const Abort> all_aborts() noexcept;
/// The standard's meaning in our words; empty for other codes.
[[nodiscard]] std::string_view words_of(Abort code) noexcept;
/// "the object does not exist (06020000h)", "abort code 12345678h, which CiA 301 does not have".
[[nodiscard]] std::string to_text(Abort code);

}  // namespace axisgate::canopen
