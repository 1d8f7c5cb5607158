// Blocks of draft-ietf-opsawg-pcapng. Only the enhanced packet block is read, because the older forms have no direction and current
// programs do not write them.
#include "gateway/wire/frame_import.hpp"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "gateway/wire/frame_export.hpp"

namespace axisgate {
namespace {

constexpr std::uint32_t interface_block = 1, packet_block = 6;
constexpr std::uint32_t order_mark = 0x1A2B3C4D, order_mark_swapped = 0x4D3C2B1A;
constexpr std::uint16_t option_name = 2, option_resolution = 9, option_flags = 2;
constexpr std::size_t least_block = 12, most_block = 1u << 20;

/// A view that is read in the byte order of its section.
struct Bytes {
    std::string_view data;
    bool big = false;

    [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t width) const noexcept {
        std::uint32_t v = 0;
        for (std::size_t i = 0; i < width; ++i) {
            const auto b = static_cast<std::uint8_t>(data[at + i]);
            v = big ? v << 8 | b : v | static_cast<std::uint32_t>(b) << (8 * i);
        }
        return v;
    }
    [[nodiscard]] std::uint16_t u16(std::size_t at) const noexcept { return static_cast<std::uint16_t>(number(at, 2)); }
    [[nodiscard]] std::uint32_t u32(std::size_t at) const noexcept { return number(at, 4); }
};

/// Calls `f(code, value)` for each option behind `at`; an option that is cut ends the list.
template <class F>
void each_option(const Bytes& b, std::size_t at, F&& f) {
    while (at + 4 <= b.data.size()) {
        const std::uint16_t code = b.u16(at), size = b.u16(at + 2);
        if (code == 0 || at + 4 + size > b.data.size()) return;
        f(code, Bytes{b.data.substr(at + 4, size), b.big});
        at += 4u + (size + 3u) / 4u * 4u;
    }
}

struct Interface {
    std::string name;
    std::uint16_t linktype = 0;
    double ns_per_unit = 1000;  ///< microseconds, unless if_tsresol says otherwise
};

class Reader {
public:
    explicit Reader(const CaptureEvents& events) : events_(events) {}

    void read(std::string_view bytes) {
        if (!is_pcapng(bytes)) return events_.fault(0, "this is not a pcapng capture");
        while (!bytes.empty()) {
            if (bytes.size() < least_block) return cut();
            if (is_pcapng(bytes)) {
                const std::uint32_t mark = Bytes{bytes, false}.u32(8);
                if (mark != order_mark && mark != order_mark_swapped) return damaged();
                big_ = mark == order_mark_swapped;
                interfaces_.clear();
            }
            const Bytes block{bytes, big_};
            const std::uint32_t length = block.u32(4);
            if (length < least_block || length % 4 != 0 || length > most_block) return damaged();
            if (length > bytes.size()) return cut();
            if (block.u32(length - 4) != length) return damaged();
            take(block.u32(0), Bytes{bytes.substr(8, length - least_block), big_});
            bytes.remove_prefix(length);
        }
    }

private:
    void cut() { events_.fault(0, fmt::format("the capture is cut off behind its packet {}", packets_)); }
    void damaged() { events_.fault(0, fmt::format("the capture is damaged behind its packet {}", packets_)); }

    void take(std::uint32_t type, const Bytes& body) {
        if (type == interface_block && body.data.size() >= 8) take_interface(body);
        if (type == packet_block) {
            ++packets_;
            if (const std::string wrong = take_packet(body); !wrong.empty()) events_.fault(packets_, wrong);
        }
    }

    void take_interface(const Bytes& body) {
        Interface& i = interfaces_.emplace_back();
        i.linktype = body.u16(0);
        i.name = fmt::format("interface {}", interfaces_.size());
        each_option(body, 8, [&](std::uint16_t code, const Bytes& value) {
            if (code == option_name && !value.data.empty()) i.name = value.data;
            if (code != option_resolution || value.data.empty()) return;
            const auto r = static_cast<std::uint8_t>(value.data[0]);
            i.ns_per_unit = 1e9 * (r & 0x80u ? std::pow(2.0, -static_cast<double>(r & 0x7Fu)) : std::pow(10.0, -static_cast<double>(r)));
        });
    }

    /// Empty, or why the packet cannot be used.
    std::string take_packet(const Bytes& body) {
        if (body.data.size() < 20) return "a packet that is too short";
        const std::uint32_t number = body.u32(0), captured = body.u32(12), length = body.u32(16);
        if (number >= interfaces_.size()) return "a packet of an interface that the capture does not describe";
        if (captured > body.data.size() - 20) return "a packet that is longer than its block";
        if (captured < length) return "a packet of which only the beginning was captured";
        const Interface& i = interfaces_[number];
        CapturedFrame f;
        f.interface = i.name;
        const double units = static_cast<double>(body.u32(4)) * 4294967296.0 + static_cast<double>(body.u32(8));
        // Nanoseconds are exact; other units are rounded to them.
        if (i.ns_per_unit == 1.0)
            f.at_unix_ns = static_cast<std::int64_t>(static_cast<std::uint64_t>(body.u32(4)) << 32 | body.u32(8));
        else if (units * i.ns_per_unit < 9.2e18)
            f.at_unix_ns = std::llround(units * i.ns_per_unit);
        if (f.at_unix_ns < 0) return "a packet whose time is after the year 2261";
        each_option(body, 20u + (captured + 3u) / 4u * 4u, [&](std::uint16_t code, const Bytes& value) {
            if (code != option_flags || value.data.size() != 4) return;
            const std::uint32_t direction = value.u32(0) & 3u;
            if (direction == 1 || direction == 2) f.to_drive = direction == 2;
        });
        const std::string_view data = body.data.substr(20, captured);
        return i.linktype == linktype_can_socketcan ? take_can(f, data)
               : i.linktype == linktype_user0       ? take_bytes(f, data)
                                                    : "a packet that is neither a CAN frame (SocketCAN) nor a run of bytes (USER0)";
    }

    std::string take_can(CapturedFrame& f, std::string_view data) {
        if (data.size() < 8) return "a CAN frame that is too short";
        const std::uint32_t id = Bytes{data, true}.u32(0);
        const auto size = static_cast<std::uint8_t>(data[4]);
        f.frame.extended = (id & 0x80000000u) != 0;
        f.frame.remote = (id & 0x40000000u) != 0;
        f.frame.kind = (id & 0x20000000u) != 0 ? Frame::Kind::can_error : Frame::Kind::can;
        f.frame.id = id & (f.frame.extended || f.frame.kind == Frame::Kind::can_error ? 0x1FFFFFFFu : 0x7FFu);
        if (size > 8) return "a CAN FD frame, which no family has";
        if (!f.frame.remote) {
            if (data.size() < 8u + size) return "a CAN frame that is shorter than its length";
            f.frame.assign({reinterpret_cast<const std::uint8_t*>(data.data()) + 8, size});
        }
        events_.frame(f);
        return {};
    }

    std::string take_bytes(CapturedFrame& f, std::string_view data) {
        for_each_run({reinterpret_cast<const std::uint8_t*>(data.data()), data.size()}, [&](const Frame& run) {
            f.frame = run;
            events_.frame(f);
        });
        return {};
    }

    const CaptureEvents& events_;
    std::vector<Interface> interfaces_;
    std::size_t packets_ = 0;
    bool big_ = false;
};
}  // namespace

bool is_pcapng(std::string_view bytes) noexcept { return bytes.starts_with("\x0A\x0D\x0D\x0A"); }

void read_pcapng(std::string_view bytes, const CaptureEvents& events) { Reader(events).read(bytes); }

}  // namespace axisgate
