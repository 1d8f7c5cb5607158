// Frame decoder: a reader of its own for the cable and for the twin bus, since an answer is read by the request that went before it.
// In: recorded frames. Out: sentences; none for a line or family that is not known. Never mixes the two.
#include "gateway/doors/http/frame_decoder.hpp"

#include <algorithm>

namespace axisgate::http {

FrameDecoder::FrameDecoder(const Families& families, const Site& site, std::string_view line) {
    const auto it = std::ranges::find(site.lines, line, &LineSpec::name);
    if (it != site.lines.end()) family_ = families.find(it->family);
}

std::vector<std::string> FrameDecoder::read(const TraceEntry& e) {
    if (!family_.family || !family_.catalogue || !family_.family->make_decoder) return {};
    const bool bytes = e.frame.kind == Frame::Kind::bytes;
    auto& decoder = decoders_[(e.simulated ? 2u : 0u) + (bytes ? 1u : 0u)];
    if (!decoder) decoder = family_.family->make_decoder(*family_.catalogue, bytes ? LineKind::bytes : LineKind::can);
    return decoder ? decoder->on_frame(e.frame, e.to_drive) : std::vector<std::string>{};
}

}  // namespace axisgate::http
