// Writes candump logs, pcapng captures, and lines for people. Times are those of the entries; no clock is read.
#include "gateway/wire/frame_export.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>

namespace axisgate {
namespace {

// Flags that SocketCAN keeps in the upper bits of an identifier.
constexpr std::uint32_t extended_flag = 0x80000000u, remote_flag = 0x40000000u, error_flag = 0x20000000u;

std::uint32_t socketcan_id(const Frame& f) noexcept {
    if (f.kind == Frame::Kind::can_error) return f.id | error_flag;
    return f.id | (f.extended ? extended_flag : 0) | (f.remote ? remote_flag : 0);
}

void put_time(std::string& s, std::int64_t unix_ns) {
    const std::int64_t us = unix_ns > 0 ? unix_ns / 1000 : 0;
    fmt::format_to(std::back_inserter(s), "({:010}.{:06})", us / 1'000'000, us % 1'000'000);
}

void put_hex(std::string& s, std::span<const std::uint8_t> data) {
    for (const auto b : data)
        fmt::format_to(std::back_inserter(s), "{:02X}", b);
}

class Blocks {
public:
    explicit Blocks(std::string& into) : bytes(into) {}
    std::string& bytes;

    void u16(std::uint16_t v) { put(v, 2); }
    void u32(std::uint32_t v) { put(v, 4); }
    void u32_big(std::uint32_t v) {
        for (int shift = 24; shift >= 0; shift -= 8)
            bytes += static_cast<char>(v >> shift);
    }
    void pad() { bytes.append((4 - bytes.size() % 4) % 4, '\0'); }
    void option(std::uint16_t code, std::string_view value) {
        u16(code);
        u16(static_cast<std::uint16_t>(value.size()));
        bytes += value;
        pad();
    }
    void end_of_options() { u32(0); }

    /// Writes a block: its length precedes and follows the content of `fill`. Blocks are multiples of four bytes, so pad() may count from
    /// the beginning of the file.
    template <class F>
    void block(std::uint32_t type, F&& fill) {
        const std::size_t begin = bytes.size();
        u32(type);
        u32(0);
        fill();
        const auto length = static_cast<std::uint32_t>(bytes.size() - begin + 4);
        u32(length);
        for (std::size_t i = 0; i < 4; ++i)
            bytes[begin + 4 + i] = static_cast<char>(length >> (8 * i));
    }

private:
    void put(std::uint32_t v, int width) {
        for (int i = 0; i < width; ++i)
            bytes += static_cast<char>(v >> (8 * i));
    }
};

constexpr std::uint32_t section_header = 0x0A0D0D0A, interface_description = 1, enhanced_packet = 6;
constexpr std::uint16_t option_if_name = 2, option_if_tsresol = 9, option_user_application = 4, option_packet_flags = 2;

void put_interface(Blocks& b, std::uint16_t linktype, const std::string& name) {
    b.block(interface_description, [&] {
        b.u16(linktype);
        b.u16(0);
        b.u32(0);  // no limit on the length of packets
        b.option(option_if_name, name);
        b.option(option_if_tsresol, std::string_view("\x09", 1));  // 10^-9 s
        b.end_of_options();
    });
}

void put_packet(Blocks& b, const TraceEntry& e, std::uint32_t interface) {
    const Frame& f = e.frame;
    const bool can = f.kind != Frame::Kind::bytes;
    const std::uint32_t data = f.remote ? 0u : f.size;
    const std::uint32_t length = data + (can ? 8u : 0u);
    const auto at = static_cast<std::uint64_t>(e.at_unix_ns);
    b.block(enhanced_packet, [&] {
        b.u32(interface);
        b.u32(static_cast<std::uint32_t>(at >> 32));
        b.u32(static_cast<std::uint32_t>(at));
        b.u32(length);
        b.u32(length);
        if (can) {
            b.u32_big(socketcan_id(f));
            b.bytes += static_cast<char>(f.size);
            b.bytes.append(3, '\0');
        }
        for (std::uint32_t i = 0; i < data; ++i)
            b.bytes += static_cast<char>(f.storage[i]);
        b.pad();
        b.u16(option_packet_flags);
        b.u16(4);
        b.u32(e.to_drive ? 2 : 1);  // outbound : inbound
        b.end_of_options();
    });
}

}  // namespace

std::string candump_text(std::span<const TraceEntry> entries, std::string_view line) {
    std::string s;
    for (const TraceEntry& e : entries) {
        const Frame& f = e.frame;
        if (f.kind == Frame::Kind::bytes) continue;
        put_time(s, e.at_unix_ns);
        const bool wide = f.extended || f.kind == Frame::Kind::can_error;
        const std::uint32_t id = f.kind == Frame::Kind::can_error ? f.id | error_flag : f.id;
        fmt::format_to(std::back_inserter(s), wide ? fmt::runtime(" {} {:08X}#") : fmt::runtime(" {} {:03X}#"), line, id);
        if (f.remote) {
            s += 'R';
            if (f.size > 0) s += static_cast<char>('0' + f.size % 10);
        } else {
            put_hex(s, f.data());
        }
        s += '\n';
    }
    return s;
}

std::string trace_text(std::span<const TraceEntry> entries, std::string_view line) {
    std::string s;
    for (const TraceEntry& e : entries) {
        put_time(s, e.at_unix_ns);
        fmt::format_to(std::back_inserter(s), " {} {} {} {}\n", line, e.simulated ? "twin" : "device", e.to_drive ? '>' : '<',
                       to_text(e.frame));
    }
    return s;
}

Pcapng::Pcapng(std::string_view line) : line_(line) {
    Blocks b(bytes_);
    b.block(section_header, [&] {
        b.u32(0x1A2B3C4D);
        b.u16(1);
        b.u16(0);
        b.u32(0xFFFFFFFF);  // length of the section: not stated
        b.u32(0xFFFFFFFF);
        b.option(option_user_application, "axisgate");
        b.end_of_options();
    });
}

void Pcapng::add(std::span<const TraceEntry> entries) {
    Blocks b(bytes_);
    for (const TraceEntry& e : entries) {
        const bool can = e.frame.kind != Frame::Kind::bytes;
        std::uint32_t& interface = interfaces_[(can ? 2u : 0u) + (e.simulated ? 1u : 0u)];
        if (interface == unused) {
            interface = count_++;
            put_interface(b, can ? linktype_can_socketcan : linktype_user0, line_ + (e.simulated ? " (twin)" : ""));
        }
        put_packet(b, e, interface);
    }
}

}  // namespace axisgate
