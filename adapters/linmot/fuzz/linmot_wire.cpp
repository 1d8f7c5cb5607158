// Fuzzes the framer and the decoder of LinRS with any bytes in any pieces. Telegrams must pack to the same bytes, and no byte may be lost.
#include <cstdlib>

#include "adapters/linmot/decoder.hpp"
#include "gateway/core/assets.hpp"

namespace {
const axisgate::Catalogue& page() {
    static const axisgate::Catalogue all = [] {
        std::vector<std::string> faults;
        auto c = axisgate::Catalogue::parse(axisgate::asset("schema/families/linmot.json"), faults);
        if (!c) std::abort();
        return std::move(*c);
    }();
    return all;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace axisgate;
    if (size < 2) return 0;
    linmot::ChecksumRule rule;
    rule.kind = static_cast<linmot::ChecksumRule::Kind>(data[0] & 3);
    rule.from = (data[0] & 4) != 0 ? 3 : 0;
    const std::size_t piece = data[1] % 70 + 1;
    const std::span<const std::uint8_t> all(data + 2, size - 2);
    linmot::Framer framer;
    framer.set(rule);
    std::size_t seen = 0;
    linmot::LineDecoder decoder(page());
    const auto junk = [&](std::span<const std::uint8_t> b, std::string_view) { seen += b.size(); };
    for (std::size_t at = 0; at < all.size(); at += piece) {
        const auto part = all.subspan(at, std::min(piece, all.size() - at));
        framer.push(
            part,
            [&](const linmot::Telegram& t, std::span<const std::uint8_t> bytes) {
                seen += bytes.size();
                if (bytes[2] > 2 && !std::ranges::equal(linmot::pack(t, rule), bytes)) std::abort();
                (void)linmot::status_of(t);
                (void)linmot::config_of(t);
            },
            junk);
        (void)decoder.on_frame(Frame::run(part.first(std::min(part.size(), Frame::capacity))),
                               (data[1] & 0x80) != 0 ? std::optional((data[1] & 0x40) != 0) : std::nullopt);
    }
    framer.reset(junk);
    if (seen != all.size()) std::abort();
    (void)decoder.finish();
    return 0;
}
