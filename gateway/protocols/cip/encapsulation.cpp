// Encapsulation: headers and items are read in place; only a packet that the stream has split is copied.
// Every length is compared with the available bytes before it is used.
#include "gateway/protocols/cip/encapsulation.hpp"

#include <algorithm>

namespace axisgate::cip {

Header read_header(View bytes) noexcept {
    Reader r(bytes);
    Header h;
    h.command = r.u16();
    h.length = r.u16();
    h.session = r.u32();
    h.status = r.u32();
    std::ranges::copy(r.take(h.context.size()), h.context.begin());
    h.options = r.u32();
    return h;
}

void begin_packet(Bytes& to) {
    to.clear();
    to.resize(header_size);
}

void end_packet(Bytes& to, const Header& h) {
    std::uint8_t* const p = to.data();
    set16(p, h.command);
    set16(p + 2, static_cast<std::uint16_t>(to.size() - header_size));
    set32(p + 4, h.session);
    set32(p + 8, h.status);
    std::ranges::copy(h.context, p + 12);
    set32(p + 20, 0);
}

Bytes packet(const Header& h, View data) {
    Bytes out;
    out.reserve(header_size + data.size());
    begin_packet(out);
    put_bytes(out, data);
    end_packet(out, h);
    return out;
}

Framer::Next Framer::next() {
    if (done_ > 0 && (done_ == buffer_.size() || done_ > most_packet_data)) {
        buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(done_));
        done_ = 0;
    }
    const View bytes = View(buffer_).subspan(done_);
    if (bytes.size() < header_size) return {};
    Next n;
    n.header = read_header(bytes);
    if (n.header.length > most_packet_data) {
        n.verdict = Verdict::too_long;
        return n;
    }
    if (bytes.size() < header_size + n.header.length) return {};
    n.verdict = Verdict::whole;
    n.data = bytes.subspan(header_size, n.header.length);
    done_ += header_size + n.header.length;
    return n;
}

const Item* Items::find(std::uint16_t type) const noexcept {
    const auto end = list.begin() + static_cast<std::ptrdiff_t>(count);
    const auto it = std::find_if(list.begin(), end, [&](const Item& i) { return i.type == type; });
    return it == end ? nullptr : &*it;
}

std::optional<Items> read_items(View bytes) noexcept {
    Reader r(bytes);
    Items items;
    items.count = r.u16();
    if (r.bad() || items.count > Items::most) return std::nullopt;
    for (std::size_t i = 0; i < items.count; ++i) {
        items.list[i].type = r.u16();
        items.list[i].data = r.take(r.u16());
    }
    if (r.bad()) return std::nullopt;
    return items;
}

void put_item(Bytes& to, std::uint16_t type, View data) {
    put16(to, type);
    put16(to, static_cast<std::uint16_t>(data.size()));
    put_bytes(to, data);
}

std::optional<Endpoint> endpoint_of(const Item& item) noexcept {
    if (item.data.size() != 16 || item.data[0] != 0 || item.data[1] != 2) return std::nullopt;
    Endpoint e;
    e.port = static_cast<std::uint16_t>((item.data[2] << 8) | item.data[3]);
    for (std::size_t i = 4; i < 8; ++i)
        e.address = (e.address << 8) | item.data[i];
    return e;
}

std::optional<Implicit> read_implicit(View datagram) noexcept {
    const auto items = read_items(datagram);
    if (!items || items->count < 2 || items->list[0].type != item::sequenced_address || items->list[0].data.size() != 8 ||
        items->list[1].type != item::connected_data)
        return std::nullopt;
    Reader r(items->list[0].data);
    Implicit i;
    i.connection = r.u32();
    i.sequence = r.u32();
    i.data = items->list[1].data;
    return i;
}

void write_implicit(Bytes& to, std::uint32_t connection, std::uint32_t sequence, std::optional<std::uint16_t> count, View data) {
    to.clear();
    put16(to, 2);
    put16(to, item::sequenced_address);
    put16(to, 8);
    put32(to, connection);
    put32(to, sequence);
    put16(to, item::connected_data);
    put16(to, static_cast<std::uint16_t>(data.size() + (count ? 2 : 0)));
    if (count) put16(to, *count);
    put_bytes(to, data);
}

}  // namespace axisgate::cip
