// Fuzz: the PA-CONTROL twin: any memory, bytes, frames, times and hand.
// In: the fuzzer's bytes. Out: nothing; laws: deadlines move on, the mechanics stay numbers, what it sends is one whole acknowledgement
// with the right check, its memory survives power-off, and its revision tells of every change of it.
#include "adapters/pacontrol/twin/twin.hpp"
#include "gateway/core/family.hpp"
#include "tests/fuzz/twin_laws.hpp"

using namespace axisgate;
using fuzz::require;

namespace {

/// SOH STX six fields ETX check EOT, and nothing else.
bool acknowledgement(std::span<const std::uint8_t> b) {
    if (b.size() < 8 || b[0] != 1 || b[1] != 2 || b.back() != 4) return false;
    std::size_t i = 2;
    int semicolons = 0;
    int x = 3;
    for (; i < b.size() && b[i] != 3; ++i) {
        if (b[i] < 0x20 || b[i] > 0x7F) return false;
        semicolons += b[i] == ';';
        x ^= b[i];
    }
    std::string check;
    for (++i; i + 1 < b.size(); ++i)
        check.push_back(static_cast<char>(b[i]));
    return semicolons == 5 && check == std::to_string(x);
}

std::vector<std::uint8_t> request(FuzzedDataProvider& in) {
    constexpr std::array<const char*, 30> codes{"0600", "0602", "0603", "0700", "0800", "1800", "1900", "0903", "0905", "0906",
                                                "0907", "0909", "190C", "1921", "0A41", "0A81", "0A83", "0A84", "0A85", "0A86",
                                                "0A87", "0A89", "0A8D", "0A90", "0A92", "0A93", "0A94", "0A98", "0AA0", "0AA3"};
    const bool real = in.ConsumeBool();
    std::string text =
        std::string(in.PickValueInArray(codes)) + ";" + std::to_string(in.ConsumeIntegralInRange<int>(0, 1030)) + (real ? ";1;" : ";0;");
    text +=
        real ? std::to_string(in.ConsumeFloatingPointInRange<double>(-20'000, 20'000)) : std::to_string(in.ConsumeIntegral<std::int32_t>());
    std::vector<std::uint8_t> b{1, 2};
    b.insert(b.end(), text.begin(), text.end());
    b.insert(b.end(), {3, '0', 4});
    return b;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("pacontrol");
    TwinSetup setup;
    setup.address = "com1";
    setup.axes = in.ConsumeIntegralInRange<int>(1, 4);
    if (in.ConsumeBool()) setup.options["absolute"] = "off";
    if (in.ConsumeBool()) setup.options["switch_on_mode"] = std::to_string(in.ConsumeIntegralInRange<int>(0, 4));
    if (in.ConsumeBool()) setup.options["motion_start_ms"] = std::to_string(in.ConsumeIntegral<std::uint8_t>());
    if (in.ConsumeBool()) setup.options["axis_modules"] = "on";
    if (in.ConsumeBool()) setup.options["programs"] = in.ConsumeRandomLengthString(40);
    for (const char* text : {"limits", "travel", "rotary"})
        if (in.ConsumeBool()) setup.options[text] = in.ConsumeRandomLengthString(20);
    fuzz::TwinRun twin(entry.family->make_twin(*entry.catalogue, setup), setup.axes, [](const Frame& f) {
        require(f.kind == Frame::Kind::bytes && acknowledgement(f.data()), "a twin sends whole acknowledgements");
    });

    constexpr std::array<const char*, 8> names{"N5",          "R7",     "M1024", "system.3", "axis1.parameter.6", "axis1.position",
                                               "axis2.shaft", "program"};
    NonVolatile first;
    for (int n = in.ConsumeIntegralInRange<int>(0, 8); n > 0; --n)
        first[in.ConsumeBool() ? in.PickValueInArray(names) : in.ConsumeRandomLengthString(12)] = fuzz::any_value(in);
    twin.power_on(first);

    for (int step = 0; step < 400 && in.remaining_bytes() > 0; ++step) {
        switch (in.ConsumeIntegralInRange<int>(0, 7)) {
            case 0: {
                const auto bytes = in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(1, 60));
                twin.frame(Frame::run(bytes));
                break;
            }
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
            case 6:
                if (in.ConsumeIntegralInRange<int>(0, 7) == 0) twin.restart();
                break;
            default: {
                const std::array<std::uint8_t, 1> eot{4};
                twin.frame(Frame::run(eot));
                break;
            }
        }
    }
    return 0;
}
