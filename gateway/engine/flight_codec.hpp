// Encodes the values of a recording: one function per type describes both directions. Recorded bytes may have any origin, so reading never
// throws, never reads beyond the end, and never allocates the size that a damaged field claims. Only for flight_*.cpp.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstring>
#include <string>
#include <type_traits>
#include <variant>

#include "gateway/engine/flight_record.hpp"

namespace axisgate::flight {

inline void put_number(std::string& out, std::uint64_t v) {
    while (v >= 0x80) {
        out.push_back(static_cast<char>(v | 0x80));
        v >>= 7;
    }
    out.push_back(static_cast<char>(v));
}
[[nodiscard]] constexpr std::uint64_t zigzag(std::int64_t v) noexcept {
    return (static_cast<std::uint64_t>(v) << 1) ^ static_cast<std::uint64_t>(v >> 63);
}
constexpr std::int64_t unzigzag(std::uint64_t v) noexcept { return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1); }
inline bool take_number(std::span<const char>& in, std::uint64_t& v) {
    v = 0;
    for (unsigned shift = 0; shift < 64 && !in.empty(); shift += 7) {
        const auto byte = static_cast<std::uint8_t>(in.front());
        in = in.subspan(1);
        v |= static_cast<std::uint64_t>(byte & 0x7Fu) << shift;
        if ((byte & 0x80u) == 0) return true;
    }
    return false;
}

/// Encodes; Unpacker has the same functions.
struct Packer {
    std::string& out;
    static constexpr bool reading = false;
    [[nodiscard]] bool ok() const { return true; }
    void bytes(const void* data, std::size_t n) { out.append(static_cast<const char*>(data), n); }
    template <class T>
    void number(const T& v) {
        if constexpr (std::is_enum_v<T>)
            put_number(out, static_cast<std::uint64_t>(v));
        else if constexpr (std::is_signed_v<T>)
            put_number(out, zigzag(v));
        else
            put_number(out, v);
    }
    void text(const std::string& s) {
        put_number(out, s.size());
        out += s;
    }
};
struct Unpacker {
    std::span<const char> in;
    bool good = true;
    static constexpr bool reading = true;
    [[nodiscard]] bool ok() const { return good; }
    void bytes(void* data, std::size_t n) {
        if (!good || in.size() < n) return void(good = false);
        if (n > 0) std::memcpy(data, in.data(), n);
        in = in.subspan(n);
    }
    template <class T>
    void number(T& v) {
        std::uint64_t raw = 0;
        good = good && take_number(in, raw);
        if (!good) return;
        if constexpr (!std::is_enum_v<T> && std::is_signed_v<T>) {
            const auto s = unzigzag(raw);
            v = static_cast<T>(s);
            good = static_cast<std::int64_t>(v) == s;
        } else {
            v = static_cast<T>(raw);
            good = static_cast<std::uint64_t>(v) == raw;
        }
    }
    void text(std::string& s) {
        std::uint64_t n = 0;
        good = good && take_number(in, n) && n <= in.size();
        if (!good) return;
        s.assign(in.data(), static_cast<std::size_t>(n));
        in = in.subspan(static_cast<std::size_t>(n));
    }
};

/// A reference when decoding, a const reference when encoding.
template <class A, class T>
using Of = std::conditional_t<A::reading, T&, const T&>;

template <class A>
void io(A& a, Of<A, std::string> v) {
    a.text(v);
}
template <class A, class T>
requires(std::is_integral_v<T> || std::is_enum_v<T>) void io(A& a, T& v) {
    if constexpr (std::is_same_v<std::remove_const_t<T>, bool>) {
        std::uint8_t byte = v ? 1 : 0;
        a.number(byte);
        if constexpr (A::reading) v = byte == 1, a.good = a.good && byte <= 1;
    } else {
        a.number(v);
    }
}
template <class A>
void io(A& a, Of<A, double> v) {
    a.bytes(&v, sizeof v);
}
template <class A>
void io(A& a, Of<A, Duration> v) {
    std::int64_t ns = v.count();
    a.number(ns);
    if constexpr (A::reading) v = Duration(ns);
}
template <class A>
void io(A& a, Of<A, Instant> v) {
    std::int64_t ns = ns_of(v);
    a.number(ns);
    if constexpr (A::reading) v = at_ns(ns);
}
template <class A, class T>
void io_optional(A& a, T& v) {
    bool there = v.has_value();
    io(a, there);
    if constexpr (A::reading) {
        if (there)
            v.emplace();
        else
            v.reset();
    }
    if (there) io(a, *v);
}
template <class A, class T, class F>
void io_list(A& a, T& list, F&& each) {
    std::uint64_t n = list.size();
    a.number(n);
    if constexpr (A::reading) {
        if (!a.good || n > a.in.size()) return void(a.good = false);  // each element takes at least one byte
        list.resize(static_cast<std::size_t>(n));
    }
    for (auto& x : list) {
        if (!a.ok()) return;
        each(x);
    }
}
/// A variant: its index, then its value.
template <std::size_t I = 0, class V, class F>
void with_alternative(V& v, std::size_t n, F&& f, bool& good) {
    if constexpr (I < std::variant_size_v<V>) {
        if (n == I)
            f(v.template emplace<I>());
        else
            with_alternative<I + 1>(v, n, f, good);
    } else {
        good = false;
    }
}
template <class A, class V, class F>
void io_variant(A& a, V& v, F&& each) {
    std::uint64_t n = v.index();
    a.number(n);
    if constexpr (A::reading) {
        if (a.good) with_alternative(v, static_cast<std::size_t>(n), each, a.good);
    } else {
        std::visit(each, v);
    }
}
template <class A>
void io(A& a, Of<A, Value> v) {
    io_variant(a, v, [&](auto& x) {
        if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(x)>, std::monostate>) io(a, x);
    });
}
template <class A>
void io_shared_text(A& a, Of<A, std::shared_ptr<const std::string>> v) {
    std::optional<std::string> text;
    if constexpr (!A::reading) {
        if (v) text = *v;
    }
    io_optional(a, text);
    if constexpr (A::reading) v = text ? std::make_shared<const std::string>(std::move(*text)) : nullptr;
}
template <class A>
void io(A& a, Of<A, Origin> v) {
    io(a, v.door);
    io_shared_text(a, v.who);
    io_shared_text(a, v.client);
}
template <class A>
void io(A& a, Of<A, Point> v) {
    io(a, v.parameter);
    io(a, v.element);
}
template <class A, class... T>
void io_all(A& a, T&... v) {
    (io(a, v), ...);
}
template <class A, class... T>
void io_optionals(A& a, T&... v) {
    (io_optional(a, v), ...);
}
template <class A, class B>
void io_body(A& a, B& b) {
    using T = std::remove_const_t<B>;
    const auto byte_list = [&](auto& list) { io_list(a, list, [&](auto& x) { io(a, x); }); };
    if constexpr (std::is_same_v<T, Home>) {
        io(a, b.method);
    } else if constexpr (std::is_same_v<T, SetPosition>) {
        io(a, b.position);
    } else if constexpr (std::is_same_v<T, Move>) {
        io_all(a, b.kind, b.target, b.prepare_only, b.renew_only);
        io_optionals(a, b.velocity, b.acceleration, b.deceleration, b.hold_ms);
    } else if constexpr (std::is_same_v<T, StartTogether>) {
        byte_list(b.axes);
    } else if constexpr (std::is_same_v<T, ReadParameter>) {
        io(a, b.point);
    } else if constexpr (std::is_same_v<T, WriteParameter>) {
        io(a, b.point);
        io(a, b.value);
    } else if constexpr (std::is_same_v<T, Native>) {
        byte_list(b.send);
        io(a, b.is_text);
    } else if constexpr (std::is_same_v<T, Action>) {
        io_all(a, b.name, b.argument);
        byte_list(b.values);
    } else if constexpr (std::is_same_v<T, Hand>) {
        io(a, b.name);
        io(a, b.value);
    } else if constexpr (std::is_same_v<T, ProcessData>) {
        io_optionals(a, b.controlword, b.mode, b.target_position, b.profile_velocity, b.profile_acceleration, b.profile_deceleration,
                     b.target_velocity, b.homing_method);
    } else if constexpr (std::is_same_v<T, HoldAxis>) {
        io_all(a, b.kind, b.lease_s, b.take_over, b.to);
    } else {
        static_assert(std::is_empty_v<T>, "a command whose members are not recorded");
    }
}

template <class A>
void io(A& a, Of<A, CommandRecord> v) {
    auto& c = v.command;
    io_all(a, c.ticket, c.axis, c.until_done, c.origin);
    io_variant(a, c.body, [&](auto& b) { io_body(a, b); });
}
template <class A>
void io(A& a, Of<A, SetPointRecord> v) {
    auto& p = v.set_point;
    io_all(a, p.axis, p.mode, p.value, p.good_for, p.at, p.origin);
    io_optionals(a, p.velocity, p.acceleration, p.deceleration);
}
template <class A>
void io(A& a, Of<A, LossRecord> v) {
    io_all(a, v.who.door, v.who.name, v.cause);
    if constexpr (A::reading) a.good = a.good && static_cast<std::size_t>(v.cause) < most_loss_causes;
}
template <class A>
void io(A& a, Of<A, StoredRecord> v) {
    io_all(a, v.order, v.fault);
}
template <class A>
void io(A& a, Of<A, HandRecord> v) {
    io_list(a, v.items, [&](auto& x) { io_all(a, x.first, x.second); });
    io(a, v.origin);
}
template <class A>
void io(A& a, Of<A, LineStateRecord> v) {
    io_all(a, v.up, v.why);
}
template <class A>
void io(A& a, Of<A, ScanWish> v) {
    io_all(a, v.kind, v.family, v.from, v.to, v.limit);
    io_list(a, v.known, [&](auto& x) { io(a, x); });
}
template <class A>
void io(A& a, Of<A, LookRecord> v) {
    io_list(a, v.axes, [&](auto& x) { io(a, x); });
    io_all(a, v.period, v.until);
}
template <class A>
void io(A& a, Of<A, PictureRecord> v) {
    io_all(a, v.position, v.demand, v.velocity, v.native_status, v.error_code, v.statusword, v.flags, v.fail_safe_cause, v.mode_display,
           v.demand_source, v.presence, v.current, v.age);
}
template <class A>
void io(A& a, Of<A, FrameRecord> v) {
    auto& f = v.frame;
    std::uint8_t flags = static_cast<std::uint8_t>((v.to_drive ? 1 : 0) | (f.extended ? 2 : 0) | (f.remote ? 4 : 0) | (v.cause ? 8 : 0) |
                                                   static_cast<unsigned>(f.kind) << 4);
    a.number(flags);
    if constexpr (A::reading) {
        v.to_drive = (flags & 1) != 0;
        f.extended = (flags & 2) != 0;
        f.remote = (flags & 4) != 0;
        f.kind = static_cast<Frame::Kind>(flags >> 4);
        a.good = a.good && f.kind <= Frame::Kind::bytes;
    }
    if (flags & 8) io(a, v.cause);
    if (f.kind != Frame::Kind::bytes) io(a, f.id);
    io(a, f.size);
    if constexpr (A::reading) {
        if (f.size > Frame::capacity) f.size = 0, a.good = false;
        if (f.remote) return f.storage.fill(0);
    }
    if (!f.remote) a.bytes(f.storage.data(), f.size);
}
template <class A>
void io(A& a, Of<A, Result> v) {
    io_all(a, v.ticket, v.axis, v.outcome, v.reason, v.code, v.text, v.value);
    io_list(a, v.bytes, [&](auto& x) { io(a, x); });
}
template <class A>
void io(A& a, Of<A, Event> v) {
    io_all(a, v.severity, v.kind, v.axis, v.drive, v.line, v.code, v.text, v.who, v.door, v.parameter, v.old_value, v.new_value);
}
template <class A>
void io(A& a, Of<A, Sample> v) {
    io_all(a, v.axis, v.point, v.value, v.quality, v.at, v.source);
}

template <class T>
void pack(std::string& out, const T& v) {
    out.clear();
    Packer p{out};
    io(p, v);
}

}  // namespace axisgate::flight
