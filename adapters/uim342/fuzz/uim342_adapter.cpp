// Fuzz: the UIM342 adapter, through core/adapter.hpp: any commands, frames, times, losses and site changes, with twins behind the wire.
// In: the fuzzer's bytes. Out: nothing; laws: tests/fuzz/adapter_laws.hpp, and that every frame sent is an instruction to a node that the
// site names, to a group, or to all.
#include <algorithm>

#include "adapters/uim342/fuzz/frames.hpp"
#include "tests/fuzz/adapter_laws.hpp"

using namespace axisgate;

namespace {
std::string wrong_frame(const Frame& f, LineKind kind, const std::vector<std::string>&) {
    if (kind == LineKind::can) {
        const auto c = uim342::from_can(f);
        if (!c) return "not SimpleCAN";
        if (c->producer != uim342::host_id) return "not from the host";
        if (c->consumer != uim342::global_id && (c->consumer < uim342::first_node || c->consumer > uim342::last_node)) return "to nobody";
        return {};
    }
    if (f.kind != Frame::Kind::bytes || f.size != uim342::uimessage_size) return "not one UIMessage";
    uim342::UiBytes b;
    std::copy_n(f.storage.begin(), b.size(), b.begin());
    const auto check = uim342::check_uimessage(b, uim342::CrcMode::automatic);
    if (!check.good && !uim342::check_uimessage(b, uim342::CrcMode::none).good) return "not a UIMessage";
    return {};
}

Frame plausible(FuzzedDataProvider& in, LineKind kind, const std::vector<std::string>& addresses) {
    const auto id = uim342::fuzz_frames::any_id(in, addresses);
    auto m = uim342::fuzz_frames::any_message(in, kind == LineKind::can ? uim342::host_id : id, false);
    return uim342::fuzz_frames::on_wire(in, kind, m, id);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    static const FamilyEntry entry = fuzz::families().find("uim342");
    static const fuzz::FamilyFrames frames{plausible, wrong_frame};
    fuzz::run_adapter(entry, frames, in, {"5", "6", "126"});
    return 0;
}
