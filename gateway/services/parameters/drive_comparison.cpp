// The reply times are judged by the comparison of recorded lines, whose twin gets the memory that was adopted from the drive, so that its
// answers are alike and pair with those of the drive.
#include "gateway/services/parameters/drive_comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>
#include <cmath>

#include "gateway/core/only_reads.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/parameters/snapshots.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
double in_ms(Duration d) { return std::round(std::chrono::duration<double, std::milli>(d).count() * 1000) / 1000; }

/// Values that follow from what the drive is doing: a model cannot know them.
bool follows_from_activity(const Parameter& p) {
    const bool state = p.storage == "status" || p.storage == "state" || p.storage == "computed";
    return p.live || (!p.writable() && state && !p.unit.empty());
}

struct Options {
    std::map<std::string, std::string> all;
    std::string specimen;
};
/// Those of the drive before those of its line, as for the twin.
Options options_of(const TwinPlace& place) {
    Options out{place.drive().options, "0"};
    if (const LineSpec* line = place.site.line(place.drive().line))
        for (const auto& [name, value] : line->options)
            out.all.emplace(name, value);
    out.all.erase(only_reads_option);
    if (auto found = out.all.extract("specimen"); !found.empty()) out.specimen = found.mapped();
    if (!check_specimen(out.specimen).empty()) out.specimen = "0";
    return out;
}

class Table {
public:
    Table(const DriveComparisonInput& input, const Catalogue& catalogue, const TwinValues& twin)
        : input_(input), catalogue_(catalogue), twin_(twin) {
        for (const auto& v : input.sweep.values)
            held_[v.parameter] = &v.value;
        for (const auto& f : input.sweep.not_read)
            refused_[f.parameter] = f.reason;
        for (const auto& c : input.sweep.changed)
            changed_[c.parameter] = &c;
    }

    void fill(DriveComparison& out) {
        for (const JobPoint& p : input_.plan.points) {
            const Parameter* parameter = catalogue_.parameter(p.point);
            if (parameter) judge(p.id, *parameter, out);
        }
    }

private:
    void judge(const std::string& id, const Parameter& p, DriveComparison& out) {
        using Kind = ComparedValue::Kind;
        const auto held = held_.find(id);
        const auto twin = twin_.values.find(id);
        const auto refused = refused_.find(id);
        ComparedValue row{Kind::value, id, p.name, p.unit, {}, {}, {}};
        if (twin != twin_.values.end()) row.twin = twin->second;
        if (held == held_.end()) {
            if (refused == refused_.end()) return;  // the sweep has ended before it
            row.text = refused->second;
            row.kind = Kind::missing;
            if (twin == twin_.values.end()) return out.neither.push_back({id, row.text});
            return out.rows.push_back(std::move(row));
        }
        ++out.read;
        row.drive = *held->second;
        const bool activity = follows_from_activity(p);
        if (const auto c = changed_.find(id); c != changed_.end() && !activity) {
            row.kind = Kind::changed;
            row.again = c->second->second;
        } else if (twin == twin_.values.end()) {
            const auto why = twin_.refused.find(id);
            row.kind = Kind::extra;
            row.text = why == twin_.refused.end() ? "" : why->second;
        } else if (equal_values(row.drive, row.twin)) {
            ++out.equal;
            return;
        } else if (activity) {
            row.kind = Kind::measured;
        }
        out.rows.push_back(std::move(row));
    }

    const DriveComparisonInput& input_;
    const Catalogue& catalogue_;
    const TwinValues& twin_;
    std::map<std::string, const Value*, std::less<>> held_;
    std::map<std::string, std::string, std::less<>> refused_;
    std::map<std::string, const Sweep::Change*, std::less<>> changed_;
};

DriveComparison::Replies replies_of(const DriveComparisonInput& input, const Catalogue& page, const DriveComparison& so_far) {
    DriveComparison::Replies out;
    const TwinPlace& place = input.place;
    const LineSpec* line = place.site.line(place.drive().line);
    const Family* family = place.families.find(place.site.family_of(place.drive())).family;
    if (!line || !family || input.frames.empty()) {
        out.fault = "no frame of the drive was recorded";
        return out;
    }
    auto options = options_of(place);
    ComparisonInput c;
    c.family = family;
    c.page = &page;
    c.kind = input.frames.front().frame.kind == Frame::Kind::bytes ? LineKind::bytes : LineKind::can;
    if (c.kind == LineKind::bytes) c.bit_rate = line->bitrate != 0 ? line->bitrate : family->default_bit_rate;
    c.addresses = {place.drive().address};
    c.options = std::move(options.all);
    c.memories[place.drive().address] = so_far.adoption.memory;
    c.specimens = {options.specimen};
    c.tolerance = input.tolerance;
    c.frames = with_directions(c, input.frames);
    Comparison compared = compare(c);
    out.fault = std::move(compared.fault);
    out.shortest = compared.shortest_reply;
    out.median = compared.median_reply;
    out.longest = compared.longest_reply;
    for (Difference& d : compared.differences)
        if (d.kind == Difference::Kind::late || d.kind == Difference::Kind::early) out.outside.push_back(std::move(d));
    return out;
}

json::array reasons_json(const std::vector<JobFailure>& list) {
    json::array out;
    for (const auto& f : list)
        out.push_back(json::object{{"parameter", f.parameter}, {"reason", f.reason}});
    return out;
}
}  // namespace

std::string_view name_of(ComparedValue::Kind kind) noexcept {
    switch (kind) {
        case ComparedValue::Kind::value:
            return "value";
        case ComparedValue::Kind::changed:
            return "changed";
        case ComparedValue::Kind::measured:
            return "measured";
        case ComparedValue::Kind::missing:
            return "missing";
        case ComparedValue::Kind::extra:
            return "extra";
    }
    return "unknown";
}

std::size_t DriveComparison::differences() const noexcept {
    const auto measured = std::ranges::count(rows, ComparedValue::Kind::measured, &ComparedValue::kind);
    return rows.size() - static_cast<std::size_t>(measured) + replies.outside.size();
}

std::vector<SeenFrame> seen_frames(const std::vector<TraceEntry>& trace) {
    std::vector<SeenFrame> out;
    std::int64_t last = trace.empty() ? 0 : trace.front().at_unix_ns;
    for (const TraceEntry& e : trace) {
        last = std::max(last, e.at_unix_ns);
        SeenFrame& f = out.emplace_back(SeenFrame{e.frame, e.to_drive});
        f.frame.at = time_zero + Duration(last - trace.front().at_unix_ns);
    }
    return out;
}

DriveComparison compare_drive(const DriveComparisonInput& input) {
    DriveComparison out;
    const TwinPlace& place = input.place;
    out.fault = input.sweep.broken_off;
    out.family = place.site.family_of(place.drive());
    out.drive = place.drive().name;
    out.axis = place.axis;
    out.address = place.drive().address;
    out.identity = input.identity;
    out.specimen = options_of(place).specimen;
    out.left_out = input.plan.left_out;
    const auto catalogue = catalogue_of(place.site, place.drive(), place.families);
    if (!catalogue) {
        out.fault = "the drive's family has no catalogue";
        return out;
    }
    const TwinValues twin = read_twin(place, input.memory, input.plan.points);
    if (!twin.fault.empty()) {
        out.fault = "the twin cannot be read: " + twin.fault;
        return out;
    }
    Table(input, *catalogue, twin).fill(out);
    out.adoption = adopt(place, input.memory, input.plan.points, input.sweep.values);
    out.replies = replies_of(input, *catalogue, out);
    return out;
}

json::object document_of(const DriveComparison& c) {
    json::array rows, outside, adopted;
    for (const ComparedValue& r : c.rows) {
        json::object o{{"kind", name_of(r.kind)},      {"parameter", r.id},         {"name", r.name},
                       {"unit", text_or_null(r.unit)}, {"drive", to_json(r.drive)}, {"twin", to_json(r.twin)}};
        if (r.kind == ComparedValue::Kind::changed) o["drive_again"] = to_json(r.again);
        if (!r.text.empty()) o["text"] = r.text;
        rows.push_back(std::move(o));
    }
    for (const Difference& d : c.replies.outside)
        outside.push_back(json::object{{"kind", name_of(d.kind)},
                                       {"request", text_or_null(d.request)},
                                       {"answer", d.recorded},
                                       {"reply_ms", in_ms(d.reply)},
                                       {"least_ms", in_ms(d.least)},
                                       {"most_ms", in_ms(d.most)}});
    for (const auto& id : c.adoption.adopted)
        adopted.emplace_back(id);
    return {{"family", c.family},
            {"drive", c.drive},
            {"axis", c.axis},
            {"address", c.address},
            {"identity", text_or_null(c.identity)},
            {"specimen", c.specimen},
            {"fault", text_or_null(c.fault)},
            {"read", c.read},
            {"equal", c.equal},
            {"differences", c.differences()},
            {"rows", std::move(rows)},
            {"left_out", reasons_json(c.left_out)},
            {"refused_by_both", reasons_json(c.neither)},
            {"replies", json::object{{"fault", text_or_null(c.replies.fault)},
                                     {"shortest_ms", in_ms(c.replies.shortest)},
                                     {"median_ms", in_ms(c.replies.median)},
                                     {"longest_ms", in_ms(c.replies.longest)},
                                     {"outside", std::move(outside)}}},
            {"adoption", json::object{{"adopted", std::move(adopted)}, {"not_adopted", reasons_json(c.adoption.not_adopted)}}}};
}

}  // namespace axisgate
