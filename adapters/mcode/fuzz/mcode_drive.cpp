// Fuzz: the MCode twin as a whole, through core/twin.hpp: any memory, lines, programs, bytes, times and hand.
// In: the fuzzer's bytes. Out: nothing; laws: tests/fuzz/twin_laws.hpp, and that what it sends is runs of bytes that are not empty.
#include <array>

#include "tests/fuzz/twin_laws.hpp"

using namespace axisgate;
using fuzz::require;

namespace {

/// A line that the drive might be sent: words, operators and numbers in an order that is often right.
std::string any_line(FuzzedDataProvider& in, char name) {
    constexpr std::array words{
        "MA ",   "MR ",  "SL ",        "HM ",   "HI ", "H ",   "PR ",    "PG ",      "PG",     "E",   "S",   "EX 1",  "EX M1",
        "LB M1", "BR 1", "BR M1,R1<5", "CL M1", "RT",  "OE 1", "VA Q1=", "R1=",      "R2=R1*", "P=",  "C1=", "VI=",   "VM=",
        "A=",    "D=",   "AS=",        "EE=",   "PY=", "EM=",  "CK=",    "DN=\"b\"", "DE=",    "ES=", "CE=", "TI 1,", "TP 1,",
        "TT 1,", "TE=",  "IS=1,",      "OS=1,", "LM=", "JE=",  "SM=",    "PM=",      "SF=",    "FD",  "IP",  "IC R1", "DC R1",
        "L",     "L 1",  "CP",         "PS",    "RS",  "PR P", "PR AL",  "ER",       "EF",     "\x1B"};
    std::string s;
    if (in.ConsumeIntegralInRange<int>(0, 3) == 0) s += in.ConsumeBool() ? name : '*';
    s += in.PickValueInArray(words);
    switch (in.ConsumeIntegralInRange<int>(0, 5)) {
        case 0:
            break;
        case 1:
            s += in.ConsumeRandomLengthString(12);
            break;
        case 2:
            s += std::to_string(in.ConsumeIntegral<std::int32_t>());
            break;
        default:
            s += std::to_string(in.ConsumeIntegralInRange<int>(-3, 300));
            break;
    }
    if (in.ConsumeIntegralInRange<int>(0, 7) == 0) s += "," + std::to_string(in.ConsumeIntegralInRange<int>(-3, 30));
    s += in.ConsumeBool() ? '\r' : '\n';
    return s;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 8 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("mcode");
    TwinSetup setup;
    setup.bit_rate = in.ConsumeBool() ? 9600 : 115200;
    setup.address = in.ConsumeBool() ? "a" : "!";
    constexpr std::array<const char*, 3> products{"LMDC", "LMDO", "LMM"};
    setup.options["product"] = in.PickValueInArray(products);
    if (in.ConsumeBool()) setup.options["ethernet"] = "on";
    fuzz::TwinRun twin(entry.family->make_twin(*entry.catalogue, setup), 1,
                       [](const Frame& f) { require(f.kind == Frame::Kind::bytes && f.size > 0, "a twin sends runs of bytes"); });

    constexpr std::array<const char*, 10> names{"DN", "PY", "EM", "CK", "VM", "AS", "C1", "F1", "PG", "R1"};
    NonVolatile first;
    for (int n = in.ConsumeIntegralInRange<int>(0, 8); n > 0; --n)
        first[in.ConsumeBool() ? in.PickValueInArray(names) : in.ConsumeRandomLengthString(6)] = fuzz::any_value(in);
    twin.power_on(first);

    for (int step = 0; step < 300 && in.remaining_bytes() > 0; ++step) {
        switch (in.ConsumeIntegralInRange<int>(0, 9)) {
            case 0: {
                const auto bytes = in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(1, 60));
                twin.frame(Frame::run(bytes));
                break;
            }
            case 1:
            case 2:
                twin.pass(fuzz::any_step(in));
                break;
            case 3:
                twin.to_deadline();
                break;
            case 4:
                twin.hand(in);
                break;
            case 5:
                if (in.ConsumeIntegralInRange<int>(0, 7) == 0) twin.restart();
                break;
            default: {
                const std::string line = any_line(in, setup.address[0]);
                twin.frame(
                    Frame::run({reinterpret_cast<const std::uint8_t*>(line.data()), std::min<std::size_t>(line.size(), Frame::capacity)}));
                break;
            }
        }
    }
    return 0;
}
