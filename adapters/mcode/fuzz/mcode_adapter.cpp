// Fuzz: the MCode adapter, through core/adapter.hpp: any commands, bytes, times, losses and site changes, with twins behind the wire.
// In: the fuzzer's bytes. Out: nothing; laws: tests/fuzz/adapter_laws.hpp, and that nothing but characters of the language, its line
// ends and its escape characters is sent (a checksum has bit 7 set).
#include <algorithm>

#include "tests/fuzz/adapter_laws.hpp"

using namespace axisgate;

namespace {
std::string wrong_frame(const Frame& f, LineKind, const std::vector<std::string>&) {
    if (f.kind != Frame::Kind::bytes) return "not bytes";
    if (f.size == 0) return "an empty run";
    for (const std::uint8_t c : f.data()) {
        const bool control = c == 0x03 || c == 0x0A || c == 0x0D || c == 0x1B;
        if (c < 0x20 && !control) return "a control character that the language does not have";
        if (c == 0x7F) return "DEL";
    }
    return {};
}

/// What a drive might say: an acknowledgement, a prompt, an answer with some mark, output of a program.
Frame plausible(FuzzedDataProvider& in, LineKind, const std::vector<std::string>&) {
    std::string s;
    switch (in.ConsumeIntegralInRange<int>(0, 4)) {
        case 0:
            s = in.ConsumeBool() ? "\x06" : "\x15";
            break;
        case 1:
            s = in.ConsumeBool() ? "\r\n>" : "\r\n?";
            break;
        case 2:
            s = "\x06#" + std::string(1, static_cast<char>('a' + in.ConsumeIntegralInRange<int>(0, 25))) + in.ConsumeRandomLengthString(24);
            s += static_cast<char>(in.ConsumeIntegral<std::uint8_t>() | 0x80);
            s += "\r\n";
            break;
        case 3:
            s = in.ConsumeRandomLengthString(32) + "\r\n";
            break;
        default:
            s = in.ConsumeRandomLengthString(48);
            break;
    }
    s.resize(std::min<std::size_t>(s.size(), Frame::capacity));
    return Frame::run({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()});
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("mcode");
    static const fuzz::FamilyFrames frames{plausible, wrong_frame};
    fuzz::run_adapter(entry, frames, in, {"a", "b", "Z"});
    return 0;
}
