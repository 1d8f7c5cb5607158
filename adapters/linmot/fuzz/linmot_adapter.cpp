// Fuzzes the LinMot adapter through core/adapter.hpp, with any commands, bytes, times, losses and site changes, and a twin on the line. The
// invariants are in tests/fuzz/adapter_laws.hpp; in addition, everything sent must be one complete telegram for an ID of the setup.
#include <algorithm>

#include "adapters/linmot/wire.hpp"
#include "tests/fuzz/adapter_laws.hpp"

using namespace axisgate;

namespace {
std::string wrong_frame(const Frame& f, LineKind, const std::vector<std::string>& configured) {
    if (f.kind != Frame::Kind::bytes || f.size == 0) return "not bytes";
    std::size_t telegrams = 0, junk = 0;
    unsigned id = 256;
    linmot::Framer framer;
    framer.push(
        f.data(), [&](const linmot::Telegram& t, std::span<const std::uint8_t>) { ++telegrams, id = t.id; },
        [&](std::span<const std::uint8_t> b, std::string_view) { junk += b.size(); });
    if (telegrams != 1 || junk != 0 || framer.pending()) return "not one whole telegram";
    return std::ranges::find(configured, std::to_string(id)) != configured.end() ? std::string() : "an ID that nobody named";
}

Frame plausible(FuzzedDataProvider& in, LineKind, const std::vector<std::string>& configured) {
    linmot::Telegram t;
    t.id =
        static_cast<std::uint8_t>(configured.empty() || in.ConsumeBool() ? in.ConsumeIntegral<std::uint8_t>() : std::stoul(configured[0]));
    constexpr std::array<std::uint8_t, 12> subs{0, 0, 0, 0, 0x40, 0x50, 0x51, 0x53, 0x60, 0x71, 0x80, 0x86};
    t.sub = in.PickValueInArray(subs);
    constexpr std::array<std::size_t, 5> sizes{9, 13, 7, 1, 35};
    const std::size_t size = in.PickValueInArray(sizes);
    constexpr std::array<std::uint8_t, 12> states{0, 1, 2, 3, 4, 5, 6, 8, 8, 9, 12, 14};
    for (std::size_t i = 0; i < size; ++i)
        t.add(i == 4 && size != 7 ? in.PickValueInArray(states) : i == 0 ? std::uint8_t{0} : in.ConsumeIntegral<std::uint8_t>());
    return Frame::run(linmot::pack(t, {}));
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("linmot");
    static const fuzz::FamilyFrames frames{plausible, wrong_frame};
    fuzz::run_adapter(entry, frames, in, {"17", "18", "0"});
    return 0;
}
