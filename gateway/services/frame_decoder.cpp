// The cable and the twin bus each have a decoder of their own, because an answer is interpreted by the request before it. Frames of an
// unknown line or family have no sentences.
#include "gateway/services/frame_decoder.hpp"

#include <algorithm>

namespace axisgate {

FrameDecoder::FrameDecoder(const Families& families, const Site& site, std::string_view line) {
    const LineSpec* spec = site.line(line);
    if (!spec) return;
    for (const auto& name : site.families_on(*spec)) {
        const FamilyEntry entry = families.find(name);
        if (!entry.family || !entry.catalogue || !entry.family->make_decoder) continue;
        Reader& reader = readers_.emplace_back();
        reader.family = entry;
        reader.receives_all = entry.family->can_identifiers == nullptr;
        if (reader.receives_all) continue;
        std::vector<std::string> addresses;
        for (const auto& d : site.drives) {
            if (d.line == spec->name && site.family_of(d) == name) addresses.push_back(d.address);
        }
        reader.identifiers = entry.family->can_identifiers(addresses);
    }
}

std::vector<std::string> FrameDecoder::read_as(Reader& reader, const TraceEntry& e) {
    const bool bytes = e.frame.kind == Frame::Kind::bytes;
    auto& decoder = reader.decoders[(e.simulated ? 2u : 0u) + (bytes ? 1u : 0u)];
    if (!decoder) decoder = reader.family.family->make_decoder(*reader.family.catalogue, bytes ? LineKind::bytes : LineKind::can);
    return decoder ? decoder->on_frame(e.frame, e.to_drive) : std::vector<std::string>{};
}

std::vector<std::string> FrameDecoder::read(const TraceEntry& e) {
    if (readers_.empty()) return {};
    if (readers_.size() == 1 || e.frame.kind == Frame::Kind::can_error) return read_as(readers_.front(), e);
    std::vector<std::string> out;
    const auto add = [&](Reader& reader, bool known_alone) {
        for (auto& line : read_as(reader, e)) {
            if (!known_alone || line.find("unknown") == std::string::npos)
                out.push_back(std::string(reader.family.family->name) + ": " + line);
        }
    };
    for (auto& reader : readers_) {
        if (reader.receives_all || any_holds(reader.identifiers, e.frame)) add(reader, false);
    }
    if (!out.empty() || std::ranges::any_of(readers_, [&](const Reader& r) { return r.receives_all || any_holds(r.identifiers, e.frame); }))
        return out;
    for (auto& reader : readers_)
        add(reader, true);
    if (out.empty()) out.push_back(to_text(e.frame) + "  unknown: its identifier belongs to no family of this line");
    return out;
}

}  // namespace axisgate
