// Fuzzes the LinMot twin with any memory, telegrams, times and hand. Invariants: deadlines advance, the mechanics remain finite, each
// answer is one complete telegram of its ID, the memory survives power-off, and its revision changes with each change of it.
#include "gateway/core/family.hpp"
#include "tests/fuzz/twin_laws.hpp"

using namespace axisgate;
using fuzz::require;

namespace {
bool telegram(std::span<const std::uint8_t> b) {
    return b.size() >= 7 && b[0] == 1 && b[1] == 17 && b[3] == 2 && b.back() == 4 && b.size() == std::size_t{b[2]} + 4;
}

std::vector<std::uint8_t> request(FuzzedDataProvider& in) {
    constexpr std::array<std::uint16_t, 9> words{0x00, 0x3E, 0x3F, 0x3F, 0x83F, 0x2F, 0x1F, 0x13F, 0xBE};
    constexpr std::array<std::uint8_t, 22> masters{0,    1,    1,    1,    2,    3,    4,    5,    7,    9,    0x0A,
                                                   0x0B, 0x0C, 0x0D, 0x20, 0x20, 0x21, 0x22, 0x24, 0x25, 0x26, 0x38};
    std::vector<std::uint8_t> body;
    switch (in.ConsumeIntegralInRange<int>(0, 5)) {
        case 0: {
            const std::uint16_t w = in.PickValueInArray(words);
            body = {0, 1, static_cast<std::uint8_t>(w), static_cast<std::uint8_t>(w >> 8)};
            break;
        }
        case 1:
        case 2:
        case 3:
            body = {0, 2, in.ConsumeIntegral<std::uint8_t>(), in.PickValueInArray(masters)};
            for (int i = in.ConsumeIntegralInRange<int>(0, 20); i > 0; --i)
                body.push_back(in.ConsumeIntegral<std::uint8_t>());
            break;
        default:
            body = {in.ConsumeIntegralInRange<std::uint8_t>(0, 12), in.ConsumeIntegralInRange<std::uint8_t>(0, 9)};
            for (int i = in.ConsumeIntegralInRange<int>(0, 6); i > 0; --i)
                body.push_back(in.ConsumeIntegral<std::uint8_t>());
            break;
    }
    std::vector<std::uint8_t> b{1, 17, static_cast<std::uint8_t>(body.size() + 1), 2};
    b.insert(b.end(), body.begin(), body.end());
    b.push_back(4);
    return b;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("linmot");
    TwinSetup setup;
    setup.address = "17";
    if (in.ConsumeBool()) setup.options["series"] = "b1100";
    if (in.ConsumeBool()) setup.options["keys"] = "none";
    if (in.ConsumeBool()) setup.options["force"] = std::to_string(in.ConsumeIntegral<std::uint16_t>());
    fuzz::TwinRun twin(entry.family->make_twin(*entry.catalogue, setup), 1,
                       [](const Frame& f) { require(f.kind == Frame::Kind::bytes && telegram(f.data()), "a twin sends whole telegrams"); });
    constexpr std::array<const char*, 6> names{"14BE", "170C", "146F", "table.5", "curve.data.3", "curve.info.3"};
    NonVolatile first;
    for (int n = in.ConsumeIntegralInRange<int>(0, 6); n > 0; --n)
        first[in.ConsumeBool() ? in.PickValueInArray(names) : in.ConsumeRandomLengthString(12)] = fuzz::any_value(in);
    twin.power_on(first);
    for (int step = 0; step < 400 && in.remaining_bytes() > 0; ++step) {
        switch (in.ConsumeIntegralInRange<int>(0, 6)) {
            case 0:
                twin.frame(Frame::run(in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(1, 60))));
                break;
            case 1:
            case 2:
            case 3:
                twin.frame(Frame::run(request(in)));
                break;
            case 4:
                twin.pass(fuzz::any_step(in));
                break;
            case 5:
                twin.hand(in);
                break;
            default:
                if (in.ConsumeIntegralInRange<int>(0, 7) == 0) twin.restart();
                break;
        }
    }
    return 0;
}
