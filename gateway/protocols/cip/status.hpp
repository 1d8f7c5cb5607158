// Status: CIP's general status codes, the extended codes of connections, the services and classes by number
// (CIP volume 1, appendix B, 3-5, 4-; volume 2).
#pragma once

#include <cstdint>

namespace axisgate::cip {

enum class General : std::uint8_t {
    success = 0x00,
    connection_failure = 0x01,  ///< the extended status gives the reason
    resource_unavailable = 0x02,
    invalid_parameter_value = 0x03,
    path_segment_error = 0x04,
    path_destination_unknown = 0x05,
    partial_transfer = 0x06,
    connection_lost = 0x07,
    service_not_supported = 0x08,
    invalid_attribute_value = 0x09,
    attribute_list_error = 0x0A,
    already_in_requested_state = 0x0B,
    object_state_conflict = 0x0C,
    object_already_exists = 0x0D,
    attribute_not_settable = 0x0E,
    privilege_violation = 0x0F,
    device_state_conflict = 0x10,
    reply_data_too_large = 0x11,
    fragmentation_of_primitive = 0x12,
    not_enough_data = 0x13,
    attribute_not_supported = 0x14,
    too_much_data = 0x15,
    object_does_not_exist = 0x16,
    no_fragmentation = 0x17,
    no_stored_data = 0x18,
    store_operation_failure = 0x19,
    request_too_large = 0x1A,
    response_too_large = 0x1B,
    missing_list_entry = 0x1C,
    invalid_attribute_list = 0x1D,
    embedded_service_error = 0x1E,
    vendor_specific = 0x1F,
    invalid_parameter = 0x20,
    write_once = 0x21,
    invalid_reply = 0x22,
    key_failure = 0x25,
    path_size_invalid = 0x26,
    unexpected_attribute = 0x27,
    invalid_member_id = 0x28,
    member_not_settable = 0x29,
    attribute_not_gettable = 0x2C
};

/// The extended status of General::connection_failure.
enum class Extended : std::uint16_t {
    none = 0,
    duplicate_forward_open = 0x0100,
    class_and_trigger_not_supported = 0x0103,
    ownership_conflict = 0x0106,
    connection_not_found = 0x0107,
    invalid_connection_type = 0x0108,
    invalid_connection_size = 0x0109,
    device_not_configured = 0x0110,
    rpi_not_supported = 0x0111,
    rpi_not_acceptable = 0x0112,
    out_of_connections = 0x0113,
    vendor_or_product_mismatch = 0x0114,
    device_type_mismatch = 0x0115,
    revision_mismatch = 0x0116,
    invalid_application_path = 0x0117,
    invalid_configuration_path = 0x0118,
    non_listen_only_not_opened = 0x0119,
    object_out_of_connections = 0x011A,
    rpi_below_inhibit_time = 0x011B,
    transport_class_not_supported = 0x011C,
    trigger_not_supported = 0x011D,
    direction_not_supported = 0x011E,
    invalid_ot_fixvar = 0x011F,
    invalid_to_fixvar = 0x0120,
    invalid_ot_priority = 0x0121,
    invalid_to_priority = 0x0122,
    invalid_ot_type = 0x0123,
    invalid_to_type = 0x0124,
    invalid_ot_redundant_owner = 0x0125,
    invalid_configuration_size = 0x0126,
    invalid_ot_size = 0x0127,  ///< followed by the right size
    invalid_to_size = 0x0128,  ///< followed by the right size
    invalid_configuration_application_path = 0x0129,
    invalid_consuming_path = 0x012A,
    invalid_producing_path = 0x012B,
    inconsistent_path_combination = 0x012F,
    null_forward_open_not_supported = 0x0132,
    timeout_multiplier_not_acceptable = 0x0133,
    timed_out = 0x0203,
    unconnected_parameter_error = 0x0205,
    port_not_available = 0x0311,
    link_address_not_valid = 0x0312,
    invalid_segment = 0x0315,
    close_path_mismatch = 0x0316
};

namespace service {
inline constexpr std::uint8_t get_all = 0x01, set_all = 0x02, get_list = 0x03, set_list = 0x04, reset = 0x05, multiple = 0x0A,
                              get_single = 0x0E, set_single = 0x10, get_enum_string = 0x4B, forward_close = 0x4E, unconnected_send = 0x52,
                              forward_open = 0x54, get_connection_data = 0x56, search_connection_data = 0x57, large_forward_open = 0x5B,
                              reply_bit = 0x80;
}
namespace class_id {
inline constexpr std::uint32_t identity = 0x01, message_router = 0x02, assembly = 0x04, connection_manager = 0x06, parameter = 0x0F,
                               qos = 0x48, connection_configuration = 0xF3, tcp_ip = 0xF5, ethernet_link = 0xF6;
}

}  // namespace axisgate::cip
