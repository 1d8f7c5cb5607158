// Fuzzes the adapter of the remote family through core/adapter.hpp, with any commands, bytes, times, losses and site changes, and twins on
// the line. The invariants are in tests/fuzz/adapter_laws.hpp; in addition, everything sent must be requests to axes of the line.
#include "gateway/protocols/mirror/telegram.hpp"
#include "tests/fuzz/adapter_laws.hpp"

using namespace axisgate;

namespace {
std::string wrong_frame(const Frame& f, LineKind, const std::vector<std::string>& configured) {
    std::size_t telegrams = 0;
    std::string wrong;
    mirror::Framer framer;
    framer.push({reinterpret_cast<const char*>(f.data().data()), f.size}, [&](std::string_view line) {
        if (line.empty()) return;
        const auto t = mirror::telegram_of(line);
        ++telegrams;
        const bool good = t && t->kind == mirror::Telegram::Kind::request && mirror::order_of(t->body) &&
                          std::ranges::find(configured, t->address) != configured.end();
        if (!good) wrong = line;
    });
    return telegrams == 1 ? wrong : "not one telegram";
}

Frame plausible(FuzzedDataProvider& in, LineKind, const std::vector<std::string>& addresses) {
    using Kind = mirror::Telegram::Kind;
    mirror::Telegram t;
    t.kind = in.PickValueInArray({Kind::answer, Kind::state, Kind::state, Kind::gone});
    t.number = in.ConsumeBool() ? 0 : 3'600'000 + in.ConsumeIntegralInRange<std::uint64_t>(0, 40);
    t.address = addresses[in.ConsumeIntegralInRange<std::size_t>(0, addresses.size() - 1)];
    if (t.kind == Kind::answer) {
        t.body = body_of(mirror::Answer{static_cast<Outcome>(in.ConsumeIntegralInRange<int>(0, 3)),
                                        static_cast<Reason>(in.ConsumeIntegralInRange<int>(0, 13)), 7, "7"});
    } else if (t.kind == Kind::state) {
        mirror::State s;
        s.statusword = in.PickValueInArray<std::uint16_t>({0x0240, 0x0227, 0x0627, 0x0207, 0x0208, 0x1627});
        s.mode = in.PickValueInArray<std::int16_t>({1, 3, 6});
        s.moving = in.ConsumeBool();
        s.target_reached = in.ConsumeBool();
        s.fault = s.statusword == 0x0208;
        s.stale = in.ConsumeBool();
        s.position = s.demand = in.ConsumeIntegral<std::int32_t>();
        s.demand_source = DemandSource::drive;
        s.age_ms = in.ConsumeIntegralInRange<std::int64_t>(0, 5000);
        t.body = body_of(s);
    } else {
        t.body = "the gateway is gone";
    }
    const std::string text = mirror::text_of(t);
    return Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("remote");
    static const fuzz::FamilyFrames frames{plausible, wrong_frame};
    fuzz::run_adapter(entry, frames, in, {"hall-2/a", "hall-2/b", "hall-3/a"});
    return 0;
}
