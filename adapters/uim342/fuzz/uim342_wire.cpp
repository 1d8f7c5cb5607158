// Fuzz: the UIM342 wire: UIMessages found in a byte stream, and SimpleCAN identifiers.
// In: the fuzzer's bytes. Out: nothing; laws: how a stream is cut changes nothing, no byte is lost or invented, what is read can be written
// and is the same; and the twin's own reading of the manual finds the same messages.
#include <algorithm>

#include "adapters/uim342/fuzz/frames.hpp"
#include "adapters/uim342/twin/wire.hpp"

using namespace axisgate;
using fuzz::require;
using namespace axisgate::uim342;

namespace {
struct Found {
    std::vector<UiCheck> frames;
    std::vector<UiBytes> raw;
    std::vector<std::uint8_t> junk, pending;
};

Found read(std::span<const std::uint8_t> bytes, CrcMode mode, const std::vector<std::size_t>& cuts) {
    Found r;
    UiFramer framer(mode);
    const auto push = [&](std::span<const std::uint8_t> part) {
        framer.push(
            part,
            [&](const UiCheck& c, const UiBytes& b) {
                r.frames.push_back(c);
                r.raw.push_back(b);
            },
            [&](std::uint8_t b) { r.junk.push_back(b); });
        require(framer.pending().size() < uimessage_size, "a whole frame does not wait");
    };
    std::size_t at = 0;
    for (const auto cut : cuts) {
        const std::size_t n = std::min(cut, bytes.size() - at);
        push(bytes.subspan(at, n));
        at += n;
    }
    push(bytes.subspan(at));
    r.pending.assign(framer.pending().begin(), framer.pending().end());
    return r;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2 || size > 8 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    const auto mode = static_cast<CrcMode>(in.ConsumeIntegralInRange<int>(0, 3));

    // CAN
    {
        const Frame f = fuzz::any_frame(in);
        const auto mine = from_can(f);
        const auto twins = twin::read_can(f);
        require(mine.has_value() == twins.has_value(), "both readings of the manual take the same frames");
        if (mine) {
            Message back = mine->message;
            back.id = mine->consumer;
            require(to_can(back, mine->producer).same(f), "a CAN frame is written as it was read");
            require(twins->producer == mine->producer && twins->consumer == mine->consumer && twins->cw == mine->message.cw &&
                        twins->dl == mine->message.dl &&
                        std::equal(twins->d.begin(), twins->d.begin() + twins->dl, mine->message.d.begin()),
                    "both readings of the manual read the same");
            (void)status_of(mine->message);
            (void)notification_of(mine->message);
            (void)model_of(mine->message);
            (void)error_text(mine->message.d[0]);
            (void)alarm_text(mine->message.d[1]);
        }
    }

    // bytes: good frames among others, and others
    std::vector<std::uint8_t> stream;
    std::vector<std::size_t> cuts;
    std::size_t whole = 0;
    bool clean = true;
    while (in.remaining_bytes() > 0 && stream.size() < 4096) {
        if (in.ConsumeBool()) {
            const auto m = uim342::fuzz_frames::any_message(in, in.ConsumeIntegralInRange<std::uint8_t>(0, 127), in.ConsumeBool());
            const auto b = to_uimessage(m, mode);
            stream.insert(stream.end(), b.begin(), b.end());
            ++whole;
        } else {
            const auto b = in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(0, 24));
            stream.insert(stream.end(), b.begin(), b.end());
            clean = clean && b.empty();
        }
        cuts.push_back(in.ConsumeIntegralInRange<std::size_t>(0, 40));
    }
    const Found once = read(stream, mode, {});
    const Found pieces = read(stream, mode, cuts);
    require(once.raw == pieces.raw && once.junk == pieces.junk && once.pending == pieces.pending, "how a stream is cut changes nothing");
    require(once.raw.size() * uimessage_size + once.junk.size() + once.pending.size() == stream.size(), "no byte is lost or invented");
    if (clean) require(once.frames.size() == whole && once.junk.empty() && once.pending.empty(), "good frames are all found");
    for (std::size_t i = 0; i < once.frames.size(); ++i) {
        const UiCheck& c = once.frames[i];
        require(c.good && c.message.dl <= 8 && c.message.id <= 127, "a found frame is one");
        const UiBytes again = to_uimessage(c.message, c.proved);
        const auto check = check_uimessage(again, c.proved == CrcMode::none ? CrcMode::none : c.proved);
        require(check.good && check.message.id == c.message.id && check.message.cw == c.message.cw && check.message.dl == c.message.dl &&
                    std::ranges::equal(check.message.data(), c.message.data()),
                "a message is read as it was written");
    }
    return 0;
}
