// The records are read from the beginning to the requested instant; registers come from the map that serves them live. Registers that a
// recording does not contain are not shown.
#include "gateway/services/recorder/playback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/json/array.hpp>
#include <boost/json/parse.hpp>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/core/text.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/frame_decoder.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/services/recorder/trend_document.hpp"
#include "gateway/site/descriptions.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
constexpr std::size_t shown_registers = 24;
constexpr std::size_t curve_memory = 64u << 20;

/// The contents of META and SITE.
struct RecordingHead {
    Site site;
    std::int64_t unix_offset_ns = 0;
    std::map<std::uint16_t, std::string> lines, axes;
};

std::map<std::uint16_t, std::string> names_at(const json::object& meta, std::string_view key) {
    std::map<std::uint16_t, std::string> out;
    const auto* v = meta.if_contains(key);
    const auto* o = v ? v->if_object() : nullptr;
    if (!o) return out;
    for (const auto& [id, name] : *o) {
        const auto n = parse_whole(id, 0, static_cast<std::int64_t>(Image::max_ids) - 1);
        if (n && name.is_string()) out[static_cast<std::uint16_t>(*n)] = std::string(name.get_string());
    }
    return out;
}

std::optional<RecordingHead> heading_of(const Axr& axr, const Families& families, std::string& fault) {
    const auto parsed = [&](std::string_view section) {
        const auto text = axr.section(section);
        boost::system::error_code ec;
        auto v = json::parse({text.data(), text.size()}, ec);
        return ec ? json::value() : v;
    };
    fault = "what the recording says of itself cannot be read";
    const json::value meta = parsed(axr_meta);
    const auto* o = meta.if_object();
    if (!o) return std::nullopt;
    RecordingHead out;
    const auto* offset = o->if_contains("unix_offset_ns");
    out.unix_offset_ns = offset && offset->is_int64() ? offset->get_int64() : 0;
    out.lines = names_at(*o, "lines");
    out.axes = names_at(*o, "axes");
    const json::value texts = axr.has(axr_descriptions) ? parsed(axr_descriptions) : json::value();
    for (const auto& v : texts.is_array() ? texts.get_array() : json::array()) {
        const auto* d = v.if_object();
        const auto *name = d ? d->if_contains("name") : nullptr, *text = d ? d->if_contains("text") : nullptr;
        if (!name || !text || !name->is_string() || !text->is_string() || !families.descriptions) continue;
        Description kept;
        kept.name = std::string(name->get_string());
        kept.text = std::string(text->get_string());
        (void)families.descriptions->put(std::move(kept));
    }
    std::vector<SiteFault> faults;
    auto site = parse_site(parsed(axr_site), families, faults);
    if (!site) {
        fault = "the site in the recording is not one for this program" + (faults.empty() ? std::string() : ": " + faults[0].text);
        return std::nullopt;
    }
    fault.clear();
    out.site = std::move(*site);
    return out;
}

AxisPicture picture_of(const PictureRecord& r, Instant at, const AxisSpec& spec) {
    AxisPicture p;
    p.number = static_cast<std::uint16_t>(spec.number);
    p.position = r.position;
    p.position_demand = r.demand;
    p.velocity = r.velocity;
    p.native_status = r.native_status;
    p.error_code = r.error_code;
    p.statusword = r.statusword;
    p.flags = r.flags;
    p.fail_safe_cause = r.fail_safe_cause;
    p.mode_display = r.mode_display;
    p.demand_source = r.demand_source;
    p.presence = r.presence;
    p.ever_seen = p.current = r.current;
    p.at = at - r.age;
    return p;
}

/// Everything up to an instant.
class Reel {
public:
    Reel(const RecordingHead& head, const PlaybackWish& wish)
        : head_(head), wish_(wish), curves_(curve_memory, std::chrono::hours(24 * 365)) {}

    void read(std::span<const char> records) {
        FlightReader reader(records);
        while (const auto r = reader.next()) {
            if (!first_) first_ = r->at;
            last_ = std::max(last_, r->at);
            if (wish_.columns > 0 && r->kind == FlightKind::picture) {
                if (const auto p = unpack<PictureRecord>(r->payload)) curves_.add(AxisId{r->index}, *p, r->at);
            }
            if (!wish_.at_unix_ns || unix_of(r->at) <= *wish_.at_unix_ns) take(*r);
        }
    }
    [[nodiscard]] json::object document(const Families& families) {
        const Instant at = wish_.at_unix_ns ? std::clamp(at_ns(saturated_difference(*wish_.at_unix_ns, head_.unix_offset_ns)),
                                                         first_.value_or(Instant{}), last_)
                                            : last_;
        return {{"from", time(first_.value_or(Instant{}))},
                {"to", time(last_)},
                {"at", time(at)},
                {"axes", axes(families)},
                {"registers", registers()},
                {"frames", frames(families)},
                {"happened", happened()},
                {"curves", curves()}};
    }

private:
    [[nodiscard]] std::int64_t unix_of(Instant at) const { return saturated_sum(ns_of(at), head_.unix_offset_ns); }
    [[nodiscard]] json::string time(Instant at) const { return json::string(format_time(unix_of(at))); }
    void take(const FlightRecord& r) {
        switch (r.kind) {
            case FlightKind::picture:
                if (const auto p = unpack<PictureRecord>(r.payload)) pictures_[r.index] = {*p, r.at};
                return;
            case FlightKind::received:
            case FlightKind::sent:
            case FlightKind::twin_frame:
                if (const auto f = unpack<FrameRecord>(r.payload); f && wish_.frames > 0) {
                    TraceEntry e;
                    e.sequence = ++frame_count_;
                    e.at_unix_ns = unix_of(r.at);
                    e.to_drive = f->to_drive;
                    e.simulated = r.kind == FlightKind::twin_frame;
                    e.frame = f->frame;
                    frames_.push_back({static_cast<std::uint16_t>(r.index & ~flight_within), f->cause, e});
                    if (frames_.size() > wish_.frames) frames_.pop_front();
                }
                return;
            case FlightKind::command:
            case FlightKind::result:
            case FlightKind::event:
            case FlightKind::client_lost:
            case FlightKind::hand:
            case FlightKind::line_state:
                happened_.push_back({r.at, r.kind, r.index, command_of(r), to_text(r)});
                if (happened_.size() > PlaybackWish::happenings) happened_.pop_front();
                return;
            default:
                return;
        }
    }
    static Ticket command_of(const FlightRecord& r) {
        if (r.kind == FlightKind::command) {
            const auto c = unpack<CommandRecord>(r.payload);
            return c ? c->command.ticket : no_ticket;
        }
        if (r.kind != FlightKind::result) return no_ticket;
        const auto x = unpack<Result>(r.payload);
        return x ? x->ticket : no_ticket;
    }
    /// In the form of the record's text; null: none.
    static json::value number(Ticket command) {
        return command == no_ticket ? json::value(nullptr) : json::value(static_cast<std::int64_t>(ticket_number(command)));
    }
    [[nodiscard]] const AxisSpec* spec_of(std::uint16_t id) const {
        const auto it = head_.axes.find(id);
        const auto i = it == head_.axes.end() ? std::nullopt : index_of_name(head_.site.axes, it->second);
        return i ? &head_.site.axes[*i] : nullptr;
    }
    [[nodiscard]] json::array axes(const Families& families) const {
        json::array out;
        for (const auto& [id, was] : pictures_) {
            const AxisSpec* spec = spec_of(id);
            const auto drive = spec ? index_of_name(head_.site.drives, spec->drive) : std::nullopt;
            if (!drive) continue;
            const DriveSpec& d = head_.site.drives[*drive];
            const auto line = index_of_name(head_.site.lines, d.line);
            const std::string family = !d.family.empty() || !line ? d.family : head_.site.lines[*line].family;
            const auto catalogue = catalogue_of(head_.site, d, families);
            const AxisPicture p = picture_of(was.first, was.second, *spec);
            out.push_back(axis_document({*spec, d.line, family, catalogue.get(), p, unix_of(p.at)}));
        }
        return out;
    }
    [[nodiscard]] json::array registers() const {
        json::array out;
        for (const auto& [id, was] : pictures_) {
            const AxisSpec* spec = spec_of(id);
            if (!spec || spec->number < 1) continue;
            std::array<std::uint8_t, registers::block_size> block{};
            registers::render(picture_of(was.first, was.second, *spec), 0, registers::WordOrder::high_first, block.data());
            json::array words;
            for (std::size_t i = 0; i < shown_registers; ++i)
                words.emplace_back(static_cast<unsigned>(block[2 * i]) << 8 | block[2 * i + 1]);
            out.push_back(json::object{{"axis", spec->name}, {"address", (spec->number - 1) * 64}, {"words", std::move(words)}});
        }
        return out;
    }
    [[nodiscard]] json::array frames(const Families& families) const {
        std::map<std::uint16_t, FrameDecoder> decoders;
        json::array out;
        for (const auto& [line, cause, entry] : frames_) {
            const auto known = head_.lines.find(line);
            const std::string name = known == head_.lines.end() ? fmt::format("line {}", line) : known->second;
            const auto d = decoders.try_emplace(line, families, head_.site, name).first;
            json::object o = frame_document(entry, d->second.read(entry));
            o["line"] = name;
            o["command"] = number(cause);
            out.push_back(std::move(o));
        }
        return out;
    }
    [[nodiscard]] json::array happened() const {
        json::array out;
        for (const auto& h : happened_) {
            const auto axis = head_.axes.find(h.index);
            const bool of_axis = (h.kind == FlightKind::command || h.kind == FlightKind::result) && axis != head_.axes.end();
            // The instant and the kind are members of their own.
            const auto words = h.text.find(std::string(name_of(h.kind)));
            out.push_back(json::object{{"at", time(h.at)},
                                       {"kind", name_of(h.kind)},
                                       {"axis", of_axis ? json::value(axis->second) : json::value(nullptr)},
                                       {"command", number(h.command)},
                                       {"text", words == std::string::npos ? h.text : h.text.substr(words)}});
        }
        return out;
    }
    [[nodiscard]] json::array curves() const {
        json::array out;
        if (wish_.columns == 0) return out;
        const std::vector<std::string> points(trend_points.begin(), trend_points.end());
        for (const auto& [id, name] : head_.axes) {
            const AxisSpec* spec = spec_of(id);
            if (!spec) continue;
            const TrendAxis a{name, spec->unit, spec->increments_per_unit,
                              curves_.read(AxisId{id}, first_.value_or(Instant{}), last_, wish_.columns)};
            if (!a.stretch.columns.empty()) out.push_back(trend_document(a, points, head_.unix_offset_ns));
        }
        return out;
    }

    struct Happening {
        Instant at;
        FlightKind kind;
        std::uint16_t index;
        Ticket command;
        std::string text;
    };
    struct Crossed {
        std::uint16_t line;
        Ticket command;  ///< the command for which it was sent at once
        TraceEntry entry;
    };
    const RecordingHead& head_;
    const PlaybackWish& wish_;
    Trends curves_;
    std::optional<Instant> first_;
    Instant last_{};
    std::uint64_t frame_count_ = 0;
    std::map<std::uint16_t, std::pair<PictureRecord, Instant>> pictures_;
    std::deque<Crossed> frames_;
    std::deque<Happening> happened_;
};
}  // namespace

json::object play_back(std::span<const char> file, const Families& families, const PlaybackWish& wish, std::string& fault) {
    const Axr axr = read_axr(file);
    fault = axr.fault;
    if (!fault.empty()) return {};
    const auto head = heading_of(axr, families, fault);
    if (!head) return {};
    Reel reel(*head, wish);
    reel.read(axr.section(axr_records));
    return reel.document(families);
}

}  // namespace axisgate
