// The device's values and the originator, compiled once for all tests of the room.
#include "tests/unit/cip/bench.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace axisgate::cip::bench {

TestValues::TestValues() {
    device_.vendor = 0xFFFF;
    device_.device_type = 0x0C;
    device_.product_code = 1;
    device_.major = 3;
    device_.minor = 7;
    device_.serial = 0x01020304;
    device_.name = "axisgate";
    device_.host_name = "press";
    device_.address = 0xC0A80064;
    device_.mask = 0xFFFFFF00;
    parameters_ = {{"run_current", "%", "Current while moving", DataType::usint, true, true, {1}, {100}, {25}, {}},
                   {"motor_direction", "", "Turns it round", DataType::usint, true, true, {0}, {1}, {0}, {{0, "normal"}, {1, "reversed"}}},
                   {"version", "", "", DataType::short_string, true, false, {}, {}, {}, {}},
                   {"a_name_longer_than_16", "increments", "", DataType::dint, true, false, Bytes(4), Bytes(4), Bytes(4), {}}};
}

std::optional<AssemblyInfo> TestValues::assembly(std::uint32_t instance) const {
    using Role = AssemblyInfo::Role;
    switch (instance) {
        case 100:
            return AssemblyInfo{Role::input, 64};
        case 101:
        case 102:
            return AssemblyInfo{Role::input, 32};
        case 150:
            return AssemblyInfo{Role::output, 64};
        case 151:
        case 152:
            return AssemblyInfo{Role::output, 32};
        case 103:
            return AssemblyInfo{Role::input, 0};
        case 153:
            return AssemblyInfo{Role::output, 0};
        case 197:
            return AssemblyInfo{Role::listen_only, 0};
        case 198:
            return AssemblyInfo{Role::input_only, 0};
        case 199:
            return AssemblyInfo{Role::configuration, 0};
        default:
            return std::nullopt;
    }
}
void TestValues::read(std::uint32_t instance, Instant, Bytes& to) { to.insert(to.end(), assembly(instance)->size, shown); }
General TestValues::write(std::uint32_t instance, View data, Token token, const Peer&, Instant, bool& later) {
    reported.push_back(fmt::format("write {} {:02x}", instance, fmt::join(data, "")));
    if (writes_later) asked.push_back(token);
    later = writes_later;
    return General::success;
}
void TestValues::messages_ended(const Peer& way) { reported.push_back(way.connection == 0 ? "session ended" : "messages ended"); }
void TestValues::opened(std::uint32_t output, const Peer&, Duration, Instant) { reported.push_back(fmt::format("opened {}", output)); }
void TestValues::consumed(std::uint32_t output, View data, const Peer&, Instant) {
    reported.push_back(fmt::format("consumed {} {:02x}", output, fmt::join(data.first(4), "")));
}
void TestValues::idle(std::uint32_t output, const Peer&, Instant) { reported.push_back(fmt::format("idle {}", output)); }
void TestValues::ended(std::uint32_t output, const Peer&, End why, Instant) {
    reported.push_back(fmt::format("ended {} {}", output,
                                   why == End::closed      ? "closed"
                                   : why == End::timed_out ? "timed out"
                                                           : "by gateway"));
}
General TestValues::ask(std::uint32_t, Token token, const Peer&, Instant) {
    if (token == 0) return General::resource_unavailable;
    asked.push_back(token);
    return General::success;
}
General TestValues::set(std::uint32_t, View value, Token token, const Peer&, Instant) {
    set_to.assign(value.begin(), value.end());
    asked.push_back(token);
    return General::success;
}

void TestOutput::implicit(Endpoint to, View d, std::uint8_t dscp) {
    witness.of_device(Witness::Port::implicit, 0, to, d);
    implicits.push_back({to, Bytes(d.begin(), d.end()), dscp});
}
void TestOutput::stream(SessionKey session, View bytes) {
    witness.of_device(Witness::Port::stream, session, Bench::plc, bytes);
    put_bytes(streams[session], bytes);
}
void TestOutput::datagram(Endpoint to, View d) {
    witness.of_device(Witness::Port::datagram, 0, to, d);
    datagrams.push_back({to, Bytes(d.begin(), d.end()), 0});
}

Bytes Open::message() const {
    const Bytes segments = hex(path);
    Bytes d{0x0A, 0x0E};
    put32(d, 0);
    put32(d, to_id);
    put16(d, serial);
    put16(d, vendor);
    put32(d, originator);
    put32(d, multiplier);
    const auto half = [&](std::uint32_t rpi, std::uint32_t type, std::uint32_t size, bool redundant_owner) {
        put32(d, rpi);
        const std::uint32_t upper = (redundant_owner ? 1u << 15 : 0) | type << 13 | 2u << 10 | (variable ? 1u << 9 : 0);
        if (large) {
            put32(d, upper << 16 | size);
        } else {
            put16(d, static_cast<std::uint16_t>(upper | size));
        }
    };
    half(ot_rpi, ot_type, ot_size, redundant);
    half(to_rpi, to_type, to_size, false);
    put8(d, transport);
    put8(d, path_words != 0 ? path_words : static_cast<std::uint8_t>(segments.size() / 2));
    put_bytes(d, segments);
    return request(large ? service::large_forward_open : service::forward_open, hex("20 06 24 01"), d);
}
Bytes Open::close() const {
    const Bytes segments = hex(path);
    Bytes d{0x0A, 0x0E};
    put16(d, serial);
    put16(d, vendor);
    put32(d, originator);
    put8(d, static_cast<std::uint8_t>(segments.size() / 2));
    put8(d, 0);
    put_bytes(d, segments);
    return request(service::forward_close, hex("20 06 24 01"), d);
}

Bench::Bench() : adapter(values, output, 0x0100) {
    connect(1);
    register_session(1);
}
void Bench::connect(SessionKey key, Endpoint from) { (void)adapter.on_connected(key, from, now); }
Bytes Bench::packet_of(SessionKey key, std::uint16_t command, View data, std::uint32_t options) {
    Header h;
    h.command = command;
    h.session = handles[key];
    h.context = {1, 2, 3, 4, 5, 6, 7, 8};
    Bytes bytes = packet(h, data);
    set32(bytes.data() + 20, options);
    output.streams[key].clear();
    output.witness.to_device(Witness::Port::stream, key, plc, bytes);
    adapter.on_stream(key, bytes, now);
    Bytes answer = output.streams[key];
    if (answer.size() >= header_size) status = static_cast<PacketStatus>(read_header(answer).status);
    return answer;
}
void Bench::register_session(SessionKey key) {
    const Bytes answer = packet_of(key, 0x65, hex("0100 0000"));
    handles[key] = read_header(answer).session;
}
Answer Bench::ask(View message, SessionKey key) {
    Bytes d = hex("00000000 0000 0200 0000 0000 B200");
    put16(d, static_cast<std::uint16_t>(message.size()));
    put_bytes(d, message);
    const Bytes answer = packet_of(key, 0x6F, d);
    if (answer.size() < header_size + 6) return {};
    items.assign(answer.begin() + header_size + 6, answer.end());
    const auto list = read_items(items);
    if (!list || list->count < 2) return {};
    return read_answer(list->list[1].data).value_or(Answer{});
}
std::uint32_t Bench::opened(const Open& o, SessionKey key) {
    const Answer a = open(o, key);
    return a.general == General::success ? Reader(a.data).u32() : 0;
}
void Bench::implicit(std::uint32_t id, std::uint32_t sequence, std::uint16_t count, std::string_view data, Endpoint from) {
    Bytes d;
    write_implicit(d, id, sequence, count, hex(data));
    output.witness.to_device(Witness::Port::implicit, 0, from, d);
    adapter.on_implicit(d, from, now);
}
void Bench::pass(Duration d) {
    const Instant end = now + d;
    while (adapter.deadline() <= end) {
        now = std::max(now, adapter.deadline());
        adapter.on_deadline(now);
    }
    now = end;
}

Bytes get(std::uint32_t class_id, std::uint32_t instance, std::uint32_t attribute, std::uint8_t service, View data) {
    Bytes path;
    put_class(path, class_id);
    put_instance(path, instance);
    if (attribute != 0) put_attribute(path, attribute);
    return request(service, path, data);
}

}  // namespace axisgate::cip::bench
