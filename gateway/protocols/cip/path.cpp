// Path: decodes one segment after the other; the length of each follows from its kind.
// A segment with missing bytes is never accepted.
#include "gateway/protocols/cip/path.hpp"

namespace axisgate::cip {
namespace {
enum class Logical : std::uint8_t { class_id = 0, instance = 1, member = 2, connection_point = 3, attribute = 4, special = 5, service = 6 };

bool read_port(Reader& r, std::uint8_t head, Path& path) {
    Port port;
    std::size_t link = 1;
    const bool long_link = (head & 0x10) != 0;
    if (long_link) link = r.u8();
    port.number = head & 0x0F;
    if (port.number == 0) return false;
    if (port.number == 15) port.number = r.u16();
    const View bytes = r.take(link);
    port.link.assign(bytes.begin(), bytes.end());
    if (long_link && link % 2 != 0) r.skip(1);
    path.ports.push_back(std::move(port));
    return path.symbols.empty() && path.places.empty() && !path.class_id;
}

bool read_key(Reader& r, Path& path) {
    if (r.u8() != 4) return false;
    ElectronicKey k;
    k.vendor = r.u16();
    k.device_type = r.u16();
    k.product_code = r.u16();
    const std::uint8_t major = r.u8();
    k.compatible = (major & 0x80) != 0;
    k.major = major & 0x7F;
    k.minor = r.u8();
    path.key = k;
    return true;
}

bool read_logical(Reader& r, std::uint8_t head, Path& path) {
    const auto type = static_cast<Logical>((head >> 2) & 7);
    const int format = head & 3;
    if (type == Logical::special) return format == 0 && read_key(r, path);
    std::uint32_t value = 0;
    if (format == 0) {
        value = r.u8();
    } else if (format == 3) {
        return false;
    } else {
        r.skip(1);
        value = format == 1 ? r.u16() : r.u32();
    }
    switch (type) {
        case Logical::class_id:
            path.class_id = value;
            return true;
        case Logical::instance:
        case Logical::connection_point:
            path.places.push_back({path.class_id.value_or(0), value, type == Logical::connection_point});
            return path.class_id.has_value();
        case Logical::member:
            path.member = value;
            return true;
        case Logical::attribute:
            path.attribute = value;
            return true;
        default:
            return false;
    }
}

bool read_network(Reader& r, std::uint8_t head, Path& path) {
    if ((head & 0x10) != 0) {  // an array of words
        r.skip(2 * std::size_t{r.u8()});
        return true;
    }
    const std::uint8_t value = r.u8();
    if ((head & 0x0F) == 3) path.inhibit_ms = value;
    return (head & 0x0F) >= 1 && (head & 0x0F) <= 4;
}

bool read_symbol(Reader& r, std::size_t length, bool padded, Path& path) {
    const View name = r.take(length);
    if (padded) r.skip(1);
    path.symbols.emplace_back(name.begin(), name.end());
    return length > 0;
}

bool read_segment(Reader& r, std::uint8_t head, Path& path) {
    switch (head >> 5) {
        case 0:
            return read_port(r, head, path);
        case 1:
            return read_logical(r, head, path);
        case 2:
            return read_network(r, head, path);
        case 3:  // symbolic: the head and its characters fill whole words
            return read_symbol(r, head & 0x1F, (head & 1) == 0, path);
        case 4:
            if (head == 0x91) {
                const std::size_t length = r.u8();
                return read_symbol(r, length, length % 2 != 0, path);
            }
            if (head == 0x80) {
                const View bytes = r.take(2 * std::size_t{r.u8()});
                if (!path.data) path.data.emplace();
                put_bytes(*path.data, bytes);
                return true;
            }
            return false;
        default:
            return false;
    }
}

void put_logical(Bytes& to, std::uint8_t head, std::uint32_t value) {
    if (value <= 0xFF) {
        put8(to, head);
        put8(to, static_cast<std::uint8_t>(value));
    } else {
        const bool wide = value > 0xFFFF;
        put8(to, static_cast<std::uint8_t>(head | (wide ? 2 : 1)));
        put8(to, 0);
        put(to, value, wide ? 4 : 2);
    }
}
}  // namespace

std::optional<Path> read_path(View bytes, std::size_t& wrong_at) {
    Path path;
    Reader r(bytes);
    while (r.left() > 0) {
        wrong_at = (bytes.size() - r.left()) / 2;
        if (!read_segment(r, r.u8(), path) || r.bad()) return std::nullopt;
    }
    return path;
}

void put_class(Bytes& to, std::uint32_t class_id) { put_logical(to, 0x20, class_id); }
void put_instance(Bytes& to, std::uint32_t instance) { put_logical(to, 0x24, instance); }
void put_attribute(Bytes& to, std::uint32_t attribute) { put_logical(to, 0x30, attribute); }

}  // namespace axisgate::cip
