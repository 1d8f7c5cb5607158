// A Responder with a fake port and one client, asked in hex; a write is answered by the scripted results of its commands.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "gateway/doors/modbus/pdu.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/unit/modbus/fake_port.hpp"

namespace axisgate::modbus::test {
using namespace registers;

/// A family with one parameter of each kind that the parameter channel must distinguish.
inline const Catalogue& catalogue() {
    static const Catalogue c = [] {
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(R"({"family": "test", "number": 9, "commands": [], "errors": [], "parameters": [
            {"id": "A", "name": "a", "group": "g", "type": "i32", "access": "RW", "description": "d", "min": -1000, "max": 1000},
            {"id": "B", "name": "b", "group": "g", "type": "u32", "access": "RW", "description": "d"},
            {"id": "C", "name": "c", "group": "g", "type": "i16", "access": "R", "description": "d"},
            {"id": "D", "name": "d", "group": "g", "type": "u16", "access": "W", "description": "d"},
            {"id": "E", "name": "e", "group": "g", "type": "text", "access": "RW", "description": "d"},
            {"id": "F", "name": "f", "group": "g", "type": "f64", "access": "RW", "description": "d"},
            {"id": "N", "name": "n", "group": "g", "type": "i32", "access": "RW", "description": "d", "first": 3, "count": 4},
            {"id": "G", "name": "h", "group": "g", "type": "bool", "access": "RW", "description": "d"},
            {"id": "I", "name": "i", "group": "g", "type": "i64", "access": "RW", "description": "d"},
            {"id": "H", "name": "bytes", "group": "g", "type": "bytes", "access": "R", "description": "d"},
            {"id": "M", "name": "m", "group": "g", "type": "u8", "access": "RW", "description": "d", "allowed": {"1": "one", "6": "six"}}]})",
                                       faults);
        for (const auto& f : faults)
            std::fprintf(stderr, "%s\n", f.c_str());
        if (!parsed) std::abort();
        return std::move(*parsed);
    }();
    return c;
}

/// A Responder in the port's list of doors, without sockets.
struct ResponderDoor : HotDoor {
    explicit ResponderDoor(DoorPort& p, WordOrder order = WordOrder::high_first, Responder::Settings settings = {})
        : list(p), image(p, {order, MapGaps::zero}), responder(p, image, std::move(settings)) {
        responder.writer().use_number(p.attach(*this));
    }
    ~ResponderDoor() override { list.detach(*this); }
    ResponderDoor(const ResponderDoor&) = delete;
    ResponderDoor& operator=(const ResponderDoor&) = delete;
    std::span<const WayIn> ways_in() const override { return modbus::tcp_ways; }
    std::string_view name() const override { return "modbus"; }
    void on_result(const Result& r) override { responder.writer().on_result(r); }

    DoorPort& list;
    registers::RegisterImage image;
    Responder responder;
};

struct ResponderBench : registers::WriteOwner {
    explicit ResponderBench(WordOrder order = WordOrder::high_first) : door(port, order, settings()) {}
    static Responder::Settings settings() {
        Responder::Settings s;
        s.version = "1.2.3";
        return s;
    }

    /// The answer's PDU. A write is answered with `result` for each of its commands.
    std::string ask(std::string_view pdu, std::uint8_t unit = 1) {
        late = {};
        std::array<std::uint8_t, max_pdu> out{};
        const auto request = bytes(pdu);
        std::size_t size = responder.answer(client(), 7, unit, request, port.now(), out.data(), late);
        waited = size == 0;
        if (waited) {
            while (late.outstanding > 0)
                result();
            size = responder.finish(late, port.now(), out.data());
        }
        return hex(std::span(out).first(size));
    }
    Responder::Client client() { return {this, who}; }
    void on_written(std::uint8_t slot, AxisId, Verdict verdict) override {
        slots.push_back(slot);
        late.on_written(exception_of(verdict));
    }

    FakePort port;
    ResponderDoor door;
    Responder& responder = door.responder;
    registers::RegisterImage& image = door.image;
    LateAnswer late;
    bool waited = false;  ///< the last request waited for a result
    std::vector<std::uint8_t> slots;
    std::shared_ptr<const std::string> who = std::make_shared<const std::string>("192.0.2.7:51123");
    std::function<void()> result = [this] { port.answer(); };
};

}  // namespace axisgate::modbus::test
