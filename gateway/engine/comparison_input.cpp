// Reads a recording for the comparison: which frames are of the drives, which are sent to them, and whether they are of this family at all.
#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>

#include "gateway/core/text.hpp"
#include "gateway/engine/comparison_parts.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

/// The identifiers of the frames that drives at these addresses send, by the page's "can_answers": {"extended", "mask", "value",
/// "node_bits"}. Bit i of the address stands in bit node_bits[i] of the identifier. Empty: the family does not use CAN.
/// `of_drives_only`: without those that masters send, too ("masters": the heartbeat of CANopen).
std::vector<CanIdentifiers> answers_of(const Catalogue& page, std::span<const std::string> addresses, bool of_drives_only = false) {
    std::vector<CanIdentifiers> out;
    const auto* list = page.document().if_contains("can_answers");
    if (!list || !list->is_array()) return out;
    const auto number = [](const json::object& o, std::string_view key) {
        const auto* v = o.if_contains(key);
        return v && v->is_int64() ? static_cast<std::uint32_t>(v->get_int64()) : 0u;
    };
    for (const std::string& address : addresses) {
        const auto node = parse_whole(address, 0, 0xFFFF);
        for (const auto& v : list->get_array()) {
            const auto* o = v.if_object();
            const auto* bits = o ? o->if_contains("node_bits") : nullptr;
            if (!node || !bits || !bits->is_array()) continue;
            const auto flag = [o](std::string_view key) {
                const auto* is = o->if_contains(key);
                return is && is->is_bool() && is->get_bool();
            };
            if (of_drives_only && flag("masters")) continue;
            CanIdentifiers i{flag("extended"), number(*o, "mask"), number(*o, "value")};
            unsigned bit = 0;
            for (const auto& place : bits->get_array()) {
                const std::uint32_t at =
                    place.is_int64() && place.get_int64() >= 0 && place.get_int64() < 29 ? 1u << place.get_int64() : 0u;
                i.mask |= at;
                if (*node >> bit++ & 1) i.value |= at;
            }
            out.push_back(i);
        }
    }
    return out;
}
}  // namespace

std::vector<std::string> addresses_in(const Family& family, const Catalogue& page, std::span<const SeenFrame> frames) {
    std::vector<std::string> out;
    for (int n = 1; n <= 127; ++n) {
        const std::string address = std::to_string(n);
        if (!family.check_address(address).empty()) continue;
        const auto identifiers = answers_of(page, std::span(&address, 1), true);
        const auto sent = [&](const SeenFrame& f) {
            return f.frame.kind == Frame::Kind::can && !f.frame.remote && f.to_drive != true && any_holds(identifiers, f.frame);
        };
        if (std::ranges::any_of(frames, sent)) out.push_back(address);
    }
    return out;
}

std::vector<ComparedFrame> with_directions(const ComparisonInput& input, std::span<const SeenFrame> frames) {
    const auto answers = answers_of(*input.page, input.addresses);
    std::vector<Acceptance> accepted;
    for (const auto& address : input.addresses) {
        const auto twin = comparison::make_twin(input, address, "0");
        Out out;
        twin->power_on({}, time_zero, out);
        accepted.push_back(twin->acceptance());
    }
    std::vector<ComparedFrame> out;
    for (const SeenFrame& f : frames) {
        if (f.frame.kind == Frame::Kind::can_error) continue;
        ComparedFrame& c = out.emplace_back();
        c.frame = f.frame;
        if (f.frame.kind == Frame::Kind::bytes) {
            c.to_drive = f.to_drive.value_or(true);
            continue;
        }
        // "From the drives" may also be another drive of the line.
        const bool answer = f.to_drive != true && any_holds(answers, f.frame);
        c.to_drive = f.frame.remote || !answer;
        c.foreign = c.to_drive && std::ranges::none_of(accepted, [&](const Acceptance& a) { return a.takes(f.frame.id); });
    }
    return out;
}

std::string check_family(const Families& families, const ComparisonInput& input) {
    const auto share = [&](const Family& family, const Catalogue& page) {
        const auto decoder = family.make_decoder(page, input.kind);
        std::size_t known = 0, all = 0;
        for (const ComparedFrame& f : input.frames)
            for (const auto& text : decoder->on_frame(f.frame, f.to_drive)) {
                ++all;
                if (text.find("unknown") == std::string::npos) ++known;
            }
        return all == 0 ? 0.0 : static_cast<double>(known) / static_cast<double>(all);
    };
    if (share(*input.family, *input.page) >= 0.5) return {};
    std::string others;
    for (const auto& e : families.entries) {
        if (e.family == input.family || !(input.kind == LineKind::can ? e.family->uses_can : e.family->uses_bytes)) continue;
        if (share(*e.family, *e.catalogue) >= 0.9) others += fmt::format("{}{}", others.empty() ? "" : ", ", e.family->name);
    }
    return fmt::format("most messages of the recording are unknown to {}{}", input.family->name,
                       others.empty() ? ": it is of another family, or damaged" : ": they look like those of " + others);
}

}  // namespace axisgate
