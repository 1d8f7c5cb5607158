// Fuzz: the UIM342 twin: any memory, frames, times and hand.
// In: the fuzzer's bytes. Out: nothing; laws: deadlines move on, the mechanics stay numbers, what it sends is the protocol and from itself,
// its memory survives power-off, and its revision tells of every change of it.
#include "adapters/uim342/fuzz/frames.hpp"
#include "gateway/core/specimen.hpp"
#include "tests/fuzz/twin_laws.hpp"

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
    if (in.ConsumeBool()) setup.freedoms = specimen_values(*entry.catalogue, std::to_string(in.ConsumeIntegral<std::uint16_t>()));
    const std::vector<std::string> addresses{"5", "5", "0", "6"};
    fuzz::TwinRun twin(entry.family->make_twin(*entry.catalogue, setup), 1, [&](const Frame& f) {
        if (setup.kind == LineKind::can) {
            const auto m = uim342::from_can(f);
            require(m.has_value(), "a twin sends SimpleCAN");
            require(m->producer >= uim342::first_node && m->producer <= uim342::last_node, "a twin sends as a node");
            require(!m->message.wants_ack(), "a twin asks nobody for an acknowledgement");
        } else {
            require(f.kind == Frame::Kind::bytes && f.size == uim342::uimessage_size, "a twin sends whole UIMessages");
            require(f.storage[15] == 0xCC && (f.storage[0] == 0xAA || f.storage[0] == 0xAD), "a twin sends UIMessages");
        }
    });

    NonVolatile first;
    const auto parameters = entry.catalogue->parameters();
    for (int n = in.ConsumeIntegralInRange<int>(0, 12); n > 0; --n) {
        const auto& p = parameters[in.ConsumeIntegralInRange<std::size_t>(0, parameters.size() - 1)];
        first[in.ConsumeIntegralInRange<int>(0, 7) ? p.id : in.ConsumeRandomLengthString(12)] = fuzz::any_value(in);
    }
    twin.power_on(first);

    for (int step = 0; step < 600 && in.remaining_bytes() > 0; ++step) {
        switch (in.ConsumeIntegralInRange<int>(0, 9)) {
            case 0:
                twin.frame(fuzz::any_frame(in));
                break;
            case 1:
                twin.pass(fuzz::any_step(in));
                break;
            case 2:
                twin.to_deadline();
                break;
            case 3:
                twin.hand(in);
                break;
            case 4:
                if (in.ConsumeIntegralInRange<int>(0, 7) == 0) twin.restart();
                break;
            default: {
                const auto id = uim342::fuzz_frames::any_id(in, addresses);
                const auto m = uim342::fuzz_frames::any_message(in, id, true);
                twin.frame(uim342::fuzz_frames::on_wire(in, setup.kind, m, uim342::host_id));
            }
        }
    }
    return 0;
}
