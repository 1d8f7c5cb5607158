// The comparison leaves out the age, which belongs to the message and is no change by itself. Drives and lines are examined rarely, axes
// when their picture has changed.
#include "gateway/doors/http/stream_sources.hpp"

#include <fmt/format.h>

#include "gateway/axis/points.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/websocket_codec.hpp"
#include "gateway/services/axis_texts.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
SharedFrame message_of(std::string_view topic, std::int64_t at_unix_ns, std::string_view data) {
    std::string text = "{\"topic\":";
    json_text(json::value(topic), text);
    fmt::format_to(std::back_inserter(text), ",\"at\":{},\"data\":", at_unix_ns);
    text += data;
    text += '}';
    return std::make_shared<const std::string>(server_frame(Opcode::text, text));
}
}  // namespace

SharedFrame stream_message(std::string_view topic, std::int64_t at_unix_ns, const json::value& data) {
    return message_of(topic, at_unix_ns, json_text(data));
}

void StreamSources::take_site(std::shared_ptr<const SiteState> site) {
    site_ = std::move(site);
    std::map<std::string, std::shared_ptr<Source>, std::less<>> next;
    const auto put = [&](Source::Kind kind, std::string topic, std::size_t index) {
        std::shared_ptr<Source> source;
        if (const auto it = by_topic_.find(topic); it != by_topic_.end()) {
            source = it->second;
        } else {
            source = std::make_shared<Source>();
            source->kind = kind;
            source->topic = topic;
            source->number = next_number();
        }
        source->index = index;
        source->fresh = true;
        next.emplace(std::move(topic), std::move(source));
    };
    for (std::size_t i = 0; i < site_->site.axes.size(); ++i)
        put(Source::Kind::axis, "axes/" + site_->site.axes[i].name, i);
    for (std::size_t i = 0; i < site_->site.drives.size(); ++i)
        put(Source::Kind::drive, "drives/" + site_->site.drives[i].name, i);
    for (std::size_t i = 0; i < site_->site.lines.size(); ++i)
        put(Source::Kind::line, "lines/" + site_->site.lines[i].name, i);
    by_topic_ = std::move(next);
}

std::shared_ptr<Source> StreamSources::find(std::string_view topic) const {
    const auto it = by_topic_.find(topic);
    return it == by_topic_.end() ? nullptr : it->second;
}

bool StreamSources::look(Source& s, Instant now, bool force) {
    if (s.looked == now && s.frame && !s.fresh && !force) return false;
    s.looked = now;
    return s.kind == Source::Kind::axis ? look_axis(s, now, force) : look_slow(s, now, force);
}

bool StreamSources::look_axis(Source& s, Instant now, bool force) {
    const AxisId id = s.index < site_->axis_ids.size() ? site_->axis_ids[s.index] : no_axis;
    if (id == no_axis) return false;
    const std::uint64_t revision = axes_.picture_revision(id);
    const bool first = !s.frame || s.fresh;
    if (!first && !force && revision == s.picture_revision) return false;
    const AxisPicture picture = axes_.picture(id);
    const bool changed = first || !same_but_time(picture, s.picture);
    const bool moved_on = picture.at != s.picture.at && now - s.built >= time_only_period;
    s.picture_revision = revision;
    if (!changed && !moved_on && !force) {
        // The revision is noted, but not the instant, which is compared with the one that was sent. The picture must be examined again, so
        // that it is sent later without another change.
        if (picture.at != s.picture.at) s.picture_revision = revision - 1;
        return false;
    }
    const AxisPlace place = axis_at(sites_, site_, s.index);
    std::string data =
        json_text(axis_document({place.spec(), place.line, place.family, place.catalogue, picture, clock_.to_unix_ns(picture.at)}));
    const bool differs = changed ? data != s.text : moved_on;
    s.picture = picture;
    s.fresh = false;
    if (!differs && !force) return true;
    // The age belongs to the message, not to the comparison: alone it is no change.
    const std::int64_t at = clock_.now_unix_ns();
    std::string shown = data;
    shown.pop_back();
    put_age(picture.ever_seen, clock_.to_unix_ns(picture.at), at, shown);
    s.frame = message_of(s.topic, at, shown);
    s.text = std::move(data);
    s.built = now;
    if (differs) ++s.version;
    return true;
}

bool StreamSources::look_slow(Source& s, Instant now, bool force) {
    if (s.frame && !s.fresh && !force && now - s.built < slow_period) return false;
    std::string data;
    if (s.kind == Source::Kind::drive) {
        data = json_text(drive_document(
            *site_, s.index, s.index < site_->drive_ids.size() ? drives_.drive_status(site_->drive_ids[s.index]) : DriveStatus{}));
    } else {
        data = json_text(
            line_document(*site_, s.index, s.index < site_->line_ids.size() ? lines_.line_report(site_->line_ids[s.index]) : LineReport{}));
    }
    s.built = now;
    s.fresh = false;
    const bool differs = data != s.text;
    if (!differs && s.frame && !force) return true;
    s.frame = message_of(s.topic, clock_.now_unix_ns(), data);
    s.text = std::move(data);
    if (differs) ++s.version;
    return true;
}

}  // namespace axisgate::http
