// A text is made anew when the revision of its picture has changed, or when the wall clock was set. The revision is read before the
// picture, so that at worst a newer picture is rendered twice.
#include "gateway/services/axis_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "gateway/core/text.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {
namespace {
/// A text contains the time of its picture. If the wall clock has been set by more than this since, the text is made anew.
constexpr std::int64_t clock_step_ns = 1'000'000;
}  // namespace

void put_age(bool ever_seen, std::int64_t at_unix_ns, std::int64_t now_unix_ns, std::string& text) {
    if (ever_seen) {
        fmt::format_to(std::back_inserter(text), ",\"age_ms\":{}}}", std::max<std::int64_t>(0, (now_unix_ns - at_unix_ns) / 1'000'000));
    } else {
        text += ",\"age_ms\":null}";
    }
}

std::string AxisTexts::text(const Needs& ports, const std::shared_ptr<const SiteState>& site, std::size_t index) {
    const auto& axes = ports.get<AxisPort>();
    const auto& clock = ports.get<ClockPort>();
    if (site != site_) {
        site_ = site;
        kept_.assign(site->site.axes.size(), {});
    }
    Kept& k = kept_[index];
    const AxisId id = index < site->axis_ids.size() ? site->axis_ids[index] : no_axis;
    const bool current = !k.text.empty() && id != no_axis && axes.picture_revision(id) == k.revision &&
                         std::llabs(clock.to_unix_ns(k.at) - k.at_unix_ns) < clock_step_ns;
    if (!current) make(k, ports, site, index, id);
    std::string out;
    out.reserve(k.text.size() + 32);
    out = k.text;
    put_age(k.ever_seen, k.at_unix_ns, clock.now_unix_ns(), out);
    return out;
}

void AxisTexts::make(Kept& k, const Needs& ports, const std::shared_ptr<const SiteState>& site, std::size_t index, AxisId id) {
    const auto& axes = ports.get<AxisPort>();
    // The revision is read first: a picture that arrives in between is then rendered again next time, and never missed.
    k.revision = id == no_axis ? 0 : axes.picture_revision(id);
    const AxisPicture picture = id == no_axis ? AxisPicture{} : axes.picture(id);
    k.at = picture.at;
    k.ever_seen = picture.ever_seen;
    k.at_unix_ns = ports.get<ClockPort>().to_unix_ns(picture.at);
    const AxisPlace place = axis_at(ports.get<SitePort>(), site, index);
    k.text = json_text(axis_document({place.spec(), place.line, place.family, place.catalogue, picture, k.at_unix_ns}));
    k.text.pop_back();
    ++made_;
}

}  // namespace axisgate
