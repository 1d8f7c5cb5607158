// Fuzz: the PA-CONTROL adapter, through core/adapter.hpp: any commands, bytes, times, losses and site changes, with a twin behind the line.
// In: the fuzzer's bytes. Out: nothing; laws: tests/fuzz/adapter_laws.hpp, and that everything sent is one whole command frame or the
// poll, with one of the three legal checks.
#include <algorithm>

#include "adapters/pacontrol/wire_commands.hpp"
#include "tests/fuzz/adapter_laws.hpp"

using namespace axisgate;

namespace {
std::string wrong_frame(const Frame& f, LineKind, const std::vector<std::string>& configured) {
    if (f.kind != Frame::Kind::bytes || f.size == 0) return "not bytes";
    if (configured.empty()) return "nobody is on the line";
    std::size_t frames = 0, polls = 0;
    std::string wrong;
    pacontrol::Framer framer;
    framer.push(f.data(),
                {[&](std::string_view text, std::string_view digits) {
                     ++frames;
                     std::string fault;
                     if (!pacontrol::request_of(text, fault)) wrong = fault;
                     if (digits.empty()) wrong = "no check";
                 },
                 [&] { ++polls; }, [&](pacontrol::FrameFault fault, std::span<const std::uint8_t>) { wrong = pacontrol::name_of(fault); }});
    if (!wrong.empty()) return wrong;
    return frames + polls == 1 && framer.pending().empty() ? std::string() : "not one frame or one poll";
}

Frame plausible(FuzzedDataProvider& in, LineKind, const std::vector<std::string>&) {
    pacontrol::Reply r;
    constexpr std::array<std::uint16_t, 12> quits{0, 0, 0, 0, 16, 17, 18, 19, 20, 32, 35, 43};
    constexpr std::array<std::uint8_t, 16> statuses{31, 31, 31, 1, 1, 0, 2, 9, 11, 15, 19, 30, 32, 35, 37, 39};
    r.quit = in.PickValueInArray(quits);
    r.end = in.ConsumeIntegralInRange<int>(0, 7) != 0;
    r.status = in.ConsumeBool() ? in.PickValueInArray(statuses) : std::uint8_t{31};
    r.error = in.ConsumeIntegralInRange<int>(0, 15) == 0 ? in.ConsumeIntegralInRange<std::uint16_t>(0, 999) : std::uint16_t{0};
    r.real = in.ConsumeBool();
    r.data = std::to_string(in.ConsumeIntegral<std::int32_t>());
    if (r.real) r.data.insert(r.data.size() - std::min<std::size_t>(r.data.size() - 1, 3), ".");
    if (r.data.ends_with('.')) r.data += '0';
    if (r.data.starts_with("-.")) r.data.insert(1, "0");
    const auto form = in.PickValueInArray(
        {pacontrol::CheckForm::with_etx, pacontrol::CheckForm::with_etx, pacontrol::CheckForm::text, pacontrol::CheckForm::zero});
    return Frame::run(pacontrol::framed(pacontrol::text_of(r), form));
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("pacontrol");
    static const fuzz::FamilyFrames frames{plausible, wrong_frame};
    fuzz::run_adapter(entry, frames, in, {"com1"});
    return 0;
}
