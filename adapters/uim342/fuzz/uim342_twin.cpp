// Fuzz: the UIM342 twin: any memory, frames, times and hand.
// In: the fuzzer's bytes. Out: nothing; laws: deadlines move on, the mechanics stay numbers, what it sends is the protocol and from itself,
// its memory survives power-off, and its revision tells of every change of it.
#include <cmath>

#include "adapters/uim342/fuzz/frames.hpp"
#include "gateway/core/twin.hpp"

using namespace axisgate;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("uim342");
    TwinSetup setup;
    setup.address = "5";
    setup.kind = in.ConsumeBool() ? LineKind::can : LineKind::bytes;
    if (in.ConsumeBool()) setup.options["crc"] = in.ConsumeBool() ? "13" : "auto";
    if (in.ConsumeBool()) setup.options["boot_ms"] = std::to_string(in.ConsumeIntegral<std::uint16_t>());
    const auto twin = entry.family->make_twin(*entry.catalogue, setup);
    Instant now = at_ns(1'000'000'000);
    const std::vector<std::string> addresses{"5", "5", "0", "6"};

    const auto drain = [&](Out& out) {
        require(out.results.empty() && out.feedback.empty() && out.samples.empty(), "a twin gives frames alone");
        require(out.frames.size() <= 1024, "one call gives a bounded amount");
        for (const auto& tx : out.frames) {
            if (setup.kind == LineKind::can) {
                const auto m = uim342::from_can(tx.frame);
                require(m.has_value(), "a twin sends SimpleCAN");
                require(m->producer >= uim342::first_node && m->producer <= uim342::last_node, "a twin sends as a node");
                require(!m->message.wants_ack(), "a twin asks nobody for an acknowledgement");
            } else {
                require(tx.frame.kind == Frame::Kind::bytes && tx.frame.size == uim342::uimessage_size, "a twin sends whole UIMessages");
                require(tx.frame.storage[15] == 0xCC && (tx.frame.storage[0] == 0xAA || tx.frame.storage[0] == 0xAD),
                        "a twin sends UIMessages");
            }
        }
        out.clear();
    };
    Out out;
    std::uint64_t revision = 0;
    NonVolatile memory;
    const auto look = [&] {
        const auto m = twin->mechanics(1, now);
        require(std::isfinite(m.position) && std::isfinite(m.velocity), "the mechanics stay numbers");
        require(std::fabs(m.velocity) < 1e12, "the mechanics stay within reason");
        require(m.powered || m.velocity == 0 || std::fabs(m.velocity) < 1e12, "the mechanics stay within reason");
        if (twin->non_volatile_revision() == revision) {
            require(twin->non_volatile() == memory, "a changed memory has another revision");
        } else {
            require(twin->non_volatile_revision() > revision, "a revision grows");
            revision = twin->non_volatile_revision();
            memory = twin->non_volatile();
        }
    };
    const auto pass = [&](Duration step) {
        const Instant end = now + step;
        int met = 0, standing = 0;
        while (twin->deadline() <= end && met < 2000) {
            const Instant due = std::max(now, twin->deadline());
            standing = due == now ? standing + 1 : 0;
            require(standing < 1000, "a deadline moves on");
            now = due;
            twin->on_deadline(now, out);
            drain(out);
            ++met;
        }
        now = end;
    };

    NonVolatile first;
    const auto parameters = entry.catalogue->parameters();
    for (int n = in.ConsumeIntegralInRange<int>(0, 12); n > 0; --n) {
        const auto& p = parameters[in.ConsumeIntegralInRange<std::size_t>(0, parameters.size() - 1)];
        first[in.ConsumeIntegralInRange<int>(0, 7) ? p.id : in.ConsumeRandomLengthString(12)] = fuzz::any_value(in);
    }
    twin->power_on(first, now, out);
    drain(out);
    revision = twin->non_volatile_revision();
    memory = twin->non_volatile();

    for (int step = 0; step < 600 && in.remaining_bytes() > 0; ++step) {
        switch (in.ConsumeIntegralInRange<int>(0, 9)) {
            case 0:
                twin->on_frame(fuzz::any_frame(in), now, out);
                break;
            case 1:
                pass(fuzz::any_step(in));
                break;
            case 2:
                if (twin->deadline() != never) pass(std::max(Duration{0}, twin->deadline() - now));
                break;
            case 3: {
                const auto items = twin->hand();
                require(!items.empty(), "there is a hand");
                const auto& item = items[in.ConsumeIntegralInRange<std::size_t>(0, items.size() - 1)];
                const std::string name = in.ConsumeIntegralInRange<int>(0, 15) ? item.name : in.ConsumeRandomLengthString(12);
                const Value value = fuzz::any_value(in);
                const std::string fault = twin->set_hand(name, value, now, out);
                require(item.writable || name != item.name || !fault.empty(), "what is not writable is refused");
                break;
            }
            case 4:
                if (in.ConsumeIntegralInRange<int>(0, 7) == 0) {
                    twin->power_on(memory, now, out);
                    drain(out);
                    require(twin->non_volatile() == memory, "a memory is kept over power-off as it is");
                    revision = twin->non_volatile_revision();
                }
                break;
            default: {
                const auto id = uim342::fuzz_frames::any_id(in, addresses);
                const auto m = uim342::fuzz_frames::any_message(in, id, true);
                twin->on_frame(uim342::fuzz_frames::on_wire(in, setup.kind, m, uim342::host_id), now, out);
            }
        }
        drain(out);
        look();
    }
    return 0;
}
