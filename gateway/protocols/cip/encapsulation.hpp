// Encapsulation: the 24 byte header of all messages except implicit datagrams, and the common packet format (CIP volume 2, 2-3 to 2-6).
// Bytes of a stream or a datagram give packets and items, or the reason why they are invalid. At most one incomplete packet is kept.
#pragma once

#include <array>
#include <optional>

#include "gateway/protocols/cip/bytes.hpp"

namespace axisgate::cip {

inline constexpr std::uint16_t default_port = 44818;    ///< TCP and UDP, explicit
inline constexpr std::uint16_t default_io_port = 2222;  ///< UDP, implicit
inline constexpr std::uint16_t protocol_version = 1;
inline constexpr std::size_t header_size = 24;
inline constexpr std::size_t most_packet_data = 8192;  ///< largest accepted size of the data behind the header; the standard allows 65511

enum class Order : std::uint16_t {
    nop = 0x00,
    list_services = 0x04,
    list_identity = 0x63,
    list_interfaces = 0x64,
    register_session = 0x65,
    unregister_session = 0x66,
    send_rr_data = 0x6F,
    send_unit_data = 0x70
};
enum class PacketStatus : std::uint32_t {
    success = 0x00,
    invalid_command = 0x01,
    insufficient_memory = 0x02,
    incorrect_data = 0x03,
    invalid_session = 0x64,
    invalid_length = 0x65,
    unsupported_revision = 0x69
};

struct Header {
    std::uint16_t command = 0;
    std::uint16_t length = 0;
    std::uint32_t session = 0;
    std::uint32_t status = 0;
    std::array<std::uint8_t, 8> context{};  ///< echoed
    std::uint32_t options = 0;              ///< must be 0
};
/// Reads header_size bytes.
[[nodiscard]] Header read_header(View bytes) noexcept;
/// Begins a packet that is written in place: empties `to`, keeping its capacity, and reserves the header; the data and the header follow.
void begin_packet(Bytes& to);
void end_packet(Bytes& to, const Header& header);
/// A complete packet; its length is that of `data`.
[[nodiscard]] Bytes packet(const Header& header, View data);
[[nodiscard]] inline Bytes packet(Header header, PacketStatus status, View data = {}) {
    header.status = static_cast<std::uint32_t>(status);
    return packet(header, data);
}

/// Splits a stream into packets.
class Framer {
public:
    enum class Verdict : std::uint8_t { need_more, whole, too_long };
    struct Next {
        Verdict verdict = Verdict::need_more;
        Header header;
        View data;  ///< valid until the next call; empty after too_long
    };
    /// At most room() bytes.
    void add(View bytes) { put_bytes(buffer_, bytes); }
    [[nodiscard]] std::size_t room() const noexcept { return header_size + most_packet_data - (buffer_.size() - done_); }
    [[nodiscard]] Next next();
    [[nodiscard]] bool holds_part() const noexcept { return buffer_.size() > done_; }

private:
    Bytes buffer_;
    std::size_t done_ = 0;
};

/// Item types of the common packet format.
namespace item {
inline constexpr std::uint16_t null_address = 0x0000, identity = 0x000C, connected_address = 0x00A1, connected_data = 0x00B1,
                               unconnected_data = 0x00B2, services = 0x0100, sockaddr_ot = 0x8000, sockaddr_to = 0x8001,
                               sequenced_address = 0x8002;
}
struct Item {
    std::uint16_t type = 0;
    View data;
};
/// The items of one packet: an address, data, and up to two endpoints.
struct Items {
    static constexpr std::size_t most = 4;
    std::array<Item, most> list;
    std::size_t count = 0;
    [[nodiscard]] const Item* find(std::uint16_t type) const noexcept;
};
/// Nothing if the bytes are truncated or there are too many items. Bytes behind the last item are ignored.
[[nodiscard]] std::optional<Items> read_items(View bytes) noexcept;
void put_item(Bytes& to, std::uint16_t type, View data);
/// The address in a sockaddr item; nothing if its size or family is wrong.
[[nodiscard]] std::optional<Endpoint> endpoint_of(const Item& item) noexcept;

/// An implicit datagram: a sequenced address and data.
struct Implicit {
    std::uint32_t connection = 0;
    std::uint32_t sequence = 0;
    View data;  ///< includes the sequence count of class 1
};
[[nodiscard]] std::optional<Implicit> read_implicit(View datagram) noexcept;
/// `to` is emptied first and keeps its capacity.
void write_implicit(Bytes& to, std::uint32_t connection, std::uint32_t sequence, std::optional<std::uint16_t> count, View data);

}  // namespace axisgate::cip
