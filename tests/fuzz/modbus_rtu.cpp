// Fuzz target: a serial line with one gateway on which anything is sent at any time, while results come and answers are echoed. The program
// is aborted when a frame without a correct checksum is accepted, another slave's request, a broadcast or an echo is answered, or a request
// gets two answers.
#include <cstdint>
#include <utility>
#include <vector>

#include "gateway/doors/modbus/rtu_receiver.hpp"
#include "gateway/doors/modbus/rtu_session.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace {
using namespace axisgate;
using namespace axisgate::modbus;
using fuzz::require;

struct RtuWorld final : RtuSink {
    explicit RtuWorld(std::uint8_t address) : own(address) {
        for (std::uint16_t n = 1; n <= 2; ++n)
            (void)port.add_axis(n, &test::catalogue());
    }
    void send(std::span<const std::uint8_t> adu, bool repeats) override {
        require(adu.size() >= rtu_min_frame && adu.size() <= rtu_max_frame, "an answer is a frame");
        require(rtu_crc(adu.first(adu.size() - 2)) == (adu[adu.size() - 2] | adu[adu.size() - 1] << 8), "its checksum is right");
        require(asked && adu[0] == asked_address && adu[0] == own, "only a request to this address is answered, and once");
        asked = false;
        receiver.sent(adu, repeats, port.time);
        if (echoes) pending.assign(adu.begin(), adu.end());
    }
    void answered() override { session.finish(port.time); }
    void take(const std::optional<RtuFrame>& frame, bool overtaken = false) {
        if (!frame) return;
        require(frame->size >= 1 && frame->size <= max_pdu, "a PDU has 1 to 253 bytes");
        asked = frame->address == own && !overtaken;
        asked_address = frame->address;
        session.on_frame(*frame, port.time, overtaken);
    }
    void receive(std::span<const std::uint8_t> bytes) {
        if (bytes.empty()) return;
        collided = collided || !pending.empty();
        take(receiver.feed(bytes, port.time), true);
        if (receiver.busy()) session.give_up();
        require(receiver.busy() == (receiver.deadline() != never), "what is being received has an end");
    }
    void echo() {
        const auto back = std::exchange(pending, {});
        if (back.empty()) return;
        collided = collided || receiver.busy();  // two nodes have sent at once: received bytes say nothing about echoes then
        if (collided) return;
        receive(back);
        require(!receiver.busy(), "an echo is no request");
    }
    void pass(Duration d) {
        echo();
        const Instant until = port.time + d;
        while (receiver.deadline() <= until) {
            port.time = std::max(port.time, receiver.deadline());
            take(receiver.on_silence(port.time));
            require(!receiver.busy(), "a silence ends what was there");
            echo();
        }
        port.time = std::max(port.time, until);
    }

    std::uint8_t own;
    test::FakePort port;
    test::ResponderDoor door{port};
    RtuReceiver receiver{RtuTiming::of(19200, 11)};
    RtuSession session{door.responder, door.image, *this, own, std::make_shared<const std::string>("/dev/ttyS9")};
    bool asked = false, echoes = false, collided = false;
    std::uint8_t asked_address = 0;
    std::vector<std::uint8_t> pending;
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider in(data, size);
    RtuWorld w(in.ConsumeIntegralInRange<std::uint8_t>(1, 247));
    w.echoes = in.ConsumeBool();
    for (int i = 0; i < 200 && in.remaining_bytes() > 0; ++i) {
        switch (in.ConsumeIntegralInRange<int>(0, 5)) {
            case 0:
                w.receive(in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(0, 300)));
                break;
            case 1:
            case 2: {  // a whole frame, so that the fuzzer gets past the checksum
                std::vector<std::uint8_t> b{in.ConsumeBool() ? w.own : in.ConsumeIntegral<std::uint8_t>()};
                const auto pdu = in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(1, 253));
                b.insert(b.end(), pdu.begin(), pdu.end());
                const auto crc = rtu_crc(b);
                b.push_back(static_cast<std::uint8_t>(crc & 0xFF));
                b.push_back(static_cast<std::uint8_t>(crc >> 8));
                w.receive(b);
                break;
            }
            case 3:
                (void)w.port.answer(Outcome::done, Reason::none, 0, Value{in.ConsumeIntegral<std::int32_t>()});
                break;
            case 4:
                w.port.refuse(static_cast<Reason>(in.ConsumeIntegralInRange<int>(1, 13)));
                break;
            default:
                w.pass(fuzz::any_step(in));
                w.door.responder.writer().sweep(w.port.time);
        }
    }
    while (w.port.answer()) {
    }
    return 0;
}
