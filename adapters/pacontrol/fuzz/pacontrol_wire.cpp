// Fuzz: the PA-CONTROL wire: frames found in a byte stream, their texts, numbers and checks, and the decoder.
// In: the fuzzer's bytes. Out: nothing; laws: how a stream is cut changes nothing, no byte is lost or invented, what is read can be written
// and is the same, and the decoder says one line for whatever it is given.
#include <algorithm>

#include "adapters/pacontrol/decoder.hpp"
#include "adapters/pacontrol/wire_commands.hpp"
#include "adapters/pacontrol/wire_number.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;
using namespace axisgate::pacontrol;

namespace {
struct Found {
    std::vector<std::pair<std::string, std::string>> frames;
    std::size_t polls = 0, dropped = 0, bytes = 0;
    std::vector<std::uint8_t> pending;
};

Found read(std::span<const std::uint8_t> bytes, const std::vector<std::size_t>& cuts) {
    Found r;
    Framer framer;
    const Framer::Sink sink{[&](std::string_view text, std::string_view check) {
                                r.frames.emplace_back(text, check);
                                r.bytes += text.size() + check.size() + 4;
                            },
                            [&] { ++r.polls; }, [&](FrameFault, std::span<const std::uint8_t> b) { r.dropped += b.size(); }};
    std::size_t at = 0;
    for (const auto cut : cuts) {
        const std::size_t n = std::min(cut, bytes.size() - at);
        framer.push(bytes.subspan(at, n), sink);
        at += n;
    }
    framer.push(bytes.subspan(at), sink);
    r.pending.assign(framer.pending().begin(), framer.pending().end());
    require(r.pending.size() <= Framer::text_limit + 8, "at most one frame waits");
    return r;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2 || size > 8 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    std::vector<std::uint8_t> stream;
    std::vector<std::size_t> cuts;
    std::vector<std::string> whole;
    bool clean = true;
    while (in.remaining_bytes() > 0 && stream.size() < 4096) {
        if (in.ConsumeBool()) {
            Request q;
            q.code = in.ConsumeIntegral<std::uint16_t>();
            q.parameter = in.ConsumeIntegral<std::uint32_t>();
            q.real = in.ConsumeBool();
            const auto n = in.ConsumeIntegral<std::int32_t>();
            q.data = q.real ? axis_text(n) : std::to_string(n);
            const std::string text = text_of(q);
            std::string fault;
            require(request_of(text, fault) == q, "a command is read as it was written");
            const auto form = in.PickValueInArray({CheckForm::text, CheckForm::with_etx, CheckForm::zero});
            const auto b = framed(text, form);
            require(form_of_check(text, std::to_string(check_of(text, form)), form) == form, "a check proves its form");
            stream.insert(stream.end(), b.begin(), b.end());
            whole.push_back(text);
        } else {
            const auto b = in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(0, 24));
            stream.insert(stream.end(), b.begin(), b.end());
            clean = clean && b.empty();
        }
        cuts.push_back(in.ConsumeIntegralInRange<std::size_t>(0, 40));
    }
    const Found once = read(stream, {});
    const Found pieces = read(stream, cuts);
    require(once.frames == pieces.frames && once.polls == pieces.polls && once.dropped == pieces.dropped && once.pending == pieces.pending,
            "how a stream is cut changes nothing");
    require(once.bytes + once.polls + once.dropped + once.pending.size() == stream.size(), "no byte is lost or invented");
    if (clean) require(once.frames.size() == whole.size() && once.dropped == 0 && once.polls == 0, "good frames are all found");
    for (const auto& [text, check] : once.frames) {
        std::string fault;
        if (const auto r = reply_of(text, fault)) {
            const auto again = reply_of(text_of(*r), fault);
            require(again == r, "an acknowledgement is read as it was written");
            (void)describe(*r);
        }
        if (const auto q = request_of(text, fault)) (void)describe(*q);
    }
    LineDecoder decoder;
    for_each_run(stream, [&](const Frame& f) {
        for (const auto& line : decoder.on_frame(f, std::nullopt))
            require(!line.empty() && line.find('\n') == std::string::npos, "the decoder gives lines");
    });
    require(decoder.finish().size() <= 6, "and ends");
    return 0;
}
