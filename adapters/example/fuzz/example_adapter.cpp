// Fuzzes the adapter of the example drive through core/adapter.hpp, with any commands, bytes, times, losses and site changes, and twins on
// the line. The invariants are in tests/fuzz/adapter_laws.hpp; in addition, everything sent must be one request to a drive of the line.
#include "adapters/example/wire.hpp"
#include "tests/fuzz/adapter_laws.hpp"

using namespace axisgate;

namespace {
std::string wrong_frame(const Frame& f, LineKind, const std::vector<std::string>& configured) {
    bool request = false;
    std::size_t telegrams = 0;
    std::string wrong;
    drive::TextLines lines = example::lines();
    lines.push(drive::text_of(f), [&](std::string_view line) {
        const auto t = example::telegram_of(line, request);
        ++telegrams;
        if (!t || !request || std::ranges::find(configured, std::to_string(t->address)) == configured.end()) wrong = line;
    });
    return telegrams == 1 ? wrong : "not one telegram";
}

Frame plausible(FuzzedDataProvider& in, LineKind, const std::vector<std::string>& addresses) {
    example::Telegram t;
    t.address = std::stoi(addresses[in.ConsumeIntegralInRange<std::size_t>(0, addresses.size() - 1)]);
    t.axis = in.ConsumeIntegralInRange<int>(1, 4);
    t.item = in.PickValueInArray({"S00", "S00", "R01", "R06", "R20", "R21", "R22", "R23", "R24"});
    t.kind = in.ConsumeIntegralInRange<int>(0, 7) == 0 ? example::Telegram::Kind::refused : example::Telegram::Kind::value;
    t.text = t.item == "S00" ? std::to_string(in.ConsumeIntegralInRange<int>(0, 15)) + ",7,8,9," + std::to_string(in.ConsumeBool() ? 3 : 0)
                             : std::to_string(in.ConsumeIntegral<std::int32_t>());
    const std::string text = example::text_of(t, false);
    return Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("example");
    static const fuzz::FamilyFrames frames{plausible, wrong_frame};
    fuzz::run_adapter(entry, frames, in, {"5", "6", "77"});
    return 0;
}
