// Decodes the payloads of records and the site of a recording, and writes records as text. The bytes may have any origin; decoding never
// throws.
#include "gateway/engine/flight_record.hpp"

#include <fmt/format.h>

#include <boost/json.hpp>

#include "gateway/engine/flight_codec.hpp"

namespace axisgate {
namespace json = boost::json;
using namespace flight;  // this file is a part of the codec
namespace {
json::object json_of(const NonVolatile& memory) {
    json::object o;
    for (const auto& [name, value] : memory) {
        std::string packed;
        pack(packed, value);
        std::string hex;
        for (const char c : packed)
            hex += fmt::format("{:02x}", static_cast<unsigned>(static_cast<std::uint8_t>(c)));
        o[name] = hex;
    }
    return o;
}
std::optional<std::map<std::string, Value>> values_in(const json::value& v) {
    std::map<std::string, Value> out;
    if (!v.is_object()) return std::nullopt;
    for (const auto& [name, hex] : v.get_object()) {
        if (!hex.is_string() || hex.get_string().size() % 2 != 0) return std::nullopt;
        std::string packed;
        const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1; };
        for (std::size_t i = 0; i < hex.get_string().size(); i += 2) {
            const int high = digit(hex.get_string()[i]), low = digit(hex.get_string()[i + 1]);
            if (high < 0 || low < 0) return std::nullopt;
            packed.push_back(static_cast<char>(high << 4 | low));
        }
        Unpacker u{packed};
        io(u, out[name]);
        if (!u.good) return std::nullopt;
    }
    return out;
}
}  // namespace

template <class T>
std::optional<T> unpack(std::span<const char> payload) {
    Unpacker u{payload};
    T v{};
    io(u, v);
    if (!u.good || !u.in.empty()) return std::nullopt;
    return v;
}
template std::optional<PictureRecord> unpack(std::span<const char>);
template std::optional<FrameRecord> unpack(std::span<const char>);
template std::optional<CommandRecord> unpack(std::span<const char>);
template std::optional<SetPointRecord> unpack(std::span<const char>);
template std::optional<LossRecord> unpack(std::span<const char>);
template std::optional<StoredRecord> unpack(std::span<const char>);
template std::optional<HandRecord> unpack(std::span<const char>);
template std::optional<LineStateRecord> unpack(std::span<const char>);
template std::optional<LookRecord> unpack(std::span<const char>);
template std::optional<ScanWish> unpack(std::span<const char>);
template std::optional<Result> unpack(std::span<const char>);
template std::optional<Event> unpack(std::span<const char>);
template std::optional<Sample> unpack(std::span<const char>);
template std::optional<std::int64_t> unpack(std::span<const char>);

std::string_view name_of(FlightKind kind) noexcept {
    switch (kind) {
        case FlightKind::site:
            return "site";
        case FlightKind::command:
            return "command";
        case FlightKind::set_point:
            return "set_point";
        case FlightKind::client_lost:
            return "client_lost";
        case FlightKind::stored:
            return "stored";
        case FlightKind::turn:
            return "turn";
        case FlightKind::scan:
            return "scan";
        case FlightKind::scan_cancel:
            return "scan_cancel";
        case FlightKind::hand:
            return "hand";
        case FlightKind::shut_down:
            return "shut_down";
        case FlightKind::received:
            return "received";
        case FlightKind::sent:
            return "sent";
        case FlightKind::line_state:
            return "line_state";
        case FlightKind::last_received:
            return "heard";
        case FlightKind::twin_memory:
            return "twin_memory";
        case FlightKind::look:
            return "look";
        case FlightKind::send_refused:
            return "send_refused";
        case FlightKind::twin_frame:
            return "twin_frame";
        case FlightKind::handed:
            return "handed";
        case FlightKind::picture:
            return "picture";
        case FlightKind::result:
            return "result";
        case FlightKind::event:
            return "event";
        case FlightKind::sample:
            return "sample";
    }
    return "unknown";
}

PictureRecord picture_record(const AxisPicture& p, Instant now) noexcept {
    PictureRecord r;
    r.position = p.position;
    r.demand = p.position_demand;
    r.velocity = p.velocity;
    r.native_status = p.native_status;
    r.error_code = p.error_code;
    r.statusword = p.statusword;
    r.flags = p.flags;
    r.fail_safe_cause = p.fail_safe_cause;
    r.mode_display = p.mode_display;
    r.demand_source = p.demand_source;
    r.presence = p.presence;
    r.current = p.current;
    r.age = p.current ? now - p.at : Duration::zero();
    return r;
}

std::string pack_site(const SiteInput& in) {
    json::object twins, stored;
    for (const auto& [name, memory] : in.memory.twins)
        twins[name] = json_of(memory);
    for (const auto& [name, values] : in.memory.stored)
        stored[name] = json_of(values);
    json::array descriptions;
    for (const auto& d : in.descriptions)
        descriptions.push_back(json::object{{"name", d.name}, {"text", d.text}});
    return json::serialize(json::object{{"site", to_json(in.site)},
                                        {"revision", in.revision},
                                        {"at_once", in.at_once},
                                        {"lease_ns", in.lease.count()},
                                        {"watchdog_ns", in.watchdog.count()},
                                        {"twins", std::move(twins)},
                                        {"stored", std::move(stored)},
                                        {"descriptions", std::move(descriptions)}});
}

std::optional<SiteInput> read_site_input(std::span<const char> payload, const Families& families, std::string& fault) {
    fault = "the site in the recording cannot be read";
    boost::system::error_code ec;
    const auto document = json::parse({payload.data(), payload.size()}, ec);
    const auto* o = ec ? nullptr : document.if_object();
    if (!o) return std::nullopt;
    const auto at = [&](std::string_view key) -> const json::value& {
        static const json::value nothing;
        const auto* v = o->if_contains(key);
        return v ? *v : nothing;
    };
    const auto number = [&](std::string_view key) { return at(key).is_number() ? at(key).to_number<std::int64_t>(ec) : 0; };
    SiteInput in;
    in.revision = static_cast<std::uint64_t>(number("revision"));
    in.at_once = at("at_once").is_bool() && at("at_once").get_bool();
    in.lease = Duration(number("lease_ns"));
    in.watchdog = Duration(number("watchdog_ns"));
    for (const auto& v : at("descriptions").is_array() ? at("descriptions").get_array() : json::array()) {
        const auto* d = v.if_object();
        const auto *name = d ? d->if_contains("name") : nullptr, *text = d ? d->if_contains("text") : nullptr;
        if (!name || !text || !name->is_string() || !text->is_string()) return std::nullopt;
        in.descriptions.push_back({std::string(name->get_string()), std::string(text->get_string())});
        if (families.descriptions) {
            Description kept;
            static_cast<DescriptionText&>(kept) = in.descriptions.back();
            (void)families.descriptions->put(std::move(kept));
        }
    }
    for (auto [key, into] : {std::pair{"twins", &in.memory.twins}, std::pair{"stored", &in.memory.stored}}) {
        if (!at(key).is_object()) return std::nullopt;
        for (const auto& [name, values] : at(key).get_object()) {
            auto read = values_in(values);
            if (!read) return std::nullopt;
            (*into)[name] = std::move(*read);
        }
    }
    std::vector<SiteFault> faults;
    auto site = parse_site(at("site"), families, faults);
    if (!site) {
        if (!faults.empty())
            fault = fmt::format("the site in the recording is not one for this program: {}: {}", faults[0].pointer, faults[0].text);
        return std::nullopt;
    }
    fault.clear();
    in.site = std::move(*site);
    return in;
}

std::string to_text(const FlightRecord& r) {
    std::string text = fmt::format("{:.6f} s {}", static_cast<double>(ns_of(r.at)) * 1e-9, name_of(r.kind));
    if (r.index != 0xFFFF) text += fmt::format(" {}", r.index & ~flight_within);
    switch (r.kind) {
        case FlightKind::received:
        case FlightKind::sent:
        case FlightKind::twin_frame:
        case FlightKind::handed:
            if (const auto f = unpack<FrameRecord>(r.payload))
                text += fmt::format(" {} {}{}", f->to_drive ? '>' : '<', to_text(f->frame),
                                    f->cause ? fmt::format(" command {}", ticket_number(f->cause)) : "");
            break;
        case FlightKind::picture:
            if (const auto p = unpack<PictureRecord>(r.payload))
                text += fmt::format(" position {} velocity {} demand {} statusword 0x{:04X} flags 0x{:04X} error {}", p->position,
                                    p->velocity, p->demand, p->statusword, p->flags, p->error_code);
            break;
        case FlightKind::result:
            if (const auto x = unpack<Result>(r.payload))
                text += fmt::format(" command {} {} {} {}", ticket_number(x->ticket), name_of(x->outcome), name_of(x->reason), x->text);
            break;
        case FlightKind::event:
            if (const auto e = unpack<Event>(r.payload))
                text += fmt::format(" {} {} {}{}: {}", name_of(e->severity), e->kind, e->line, e->axis, e->text);
            break;
        case FlightKind::sample:
            if (const auto s = unpack<Sample>(r.payload)) text += fmt::format(" parameter {} = {}", s->point.parameter, to_text(s->value));
            break;
        case FlightKind::command:
            if (const auto c = unpack<CommandRecord>(r.payload))
                text += fmt::format(" command {} {} by {}", ticket_number(c->command.ticket), name_of(c->command.body),
                                    c->command.origin.text());
            break;
        default:
            break;
    }
    return text;
}

}  // namespace axisgate
