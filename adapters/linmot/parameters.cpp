// RAM values are read together with a default response and written by Write Live Parameter; ROM values use the parameter messages. Each
// value is read back, because a RAM write has no answer of its own. Entries of the command table and curves are texts, transferred by
// parameters_transfer.cpp.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"
#include "adapters/linmot/parameters_tables.hpp"

namespace axisgate::linmot {
namespace {
std::uint32_t raw_of(const Value& v) { return static_cast<std::uint32_t>(as_integer(v).value_or(0)); }
Value value_of(std::uint32_t raw, ValueType type) {
    switch (type) {
        case ValueType::boolean:
            return Value{(raw & 1) != 0};
        case ValueType::u16:
            return Value{std::int64_t{raw & 0xFFFF}};
        case ValueType::i16:
            return Value{std::int64_t{static_cast<std::int16_t>(raw)}};
        case ValueType::u32:
            return Value{std::int64_t{raw}};
        default:
            return Value{std::int64_t{static_cast<std::int32_t>(raw)}};
    }
}
struct Place {
    const Parameter* parameter = nullptr;
    std::uint16_t upid = 0;
    bool rom = false;
    std::string item;  ///< "status", "state", "warn"
};
Place place_of(const Catalogue& catalogue, Point point) {
    Place p;
    p.parameter = catalogue.parameter(point);
    if (!p.parameter) return p;
    const auto& wire = p.parameter->wire;
    if (const auto* upid = wire.if_contains("upid")) p.upid = static_cast<std::uint16_t>(upid->as_int64());
    if (const auto* rom = wire.if_contains("rom")) p.rom = rom->as_bool();
    if (const auto* item = wire.if_contains("item")) p.item = std::string(item->as_string());
    return p;
}
}  // namespace

/// The point of the read or of the write.
Point Parameters::point() {
    const CommandBody& body = job().command.body;
    const auto* read = std::get_if<ReadParameter>(&body);
    return read ? read->point : std::get<WriteParameter>(body).point;
}

void Parameters::done(Value v, Turn& t) {
    const Place p = place_of(drive_.bus.catalogue, point());
    const bool rate = std::ranges::find(Limits::upids, p.upid) != std::end(Limits::upids);
    if (rate && !p.rom && std::holds_alternative<WriteParameter>(job().command.body)) drive_.start.read_again();
    t.out.samples.push_back({drive_.axis(), point(), v, Quality::good, t.now, 0});
    if (job().command.ticket == no_ticket) drive_.start.limit_set({}, t);
    succeed({}, t, std::move(v));
}

/// A write without a client's command is one of the site's limits.
void Parameters::without_success(drive::Failure& how, Turn& t) {
    Verb::without_success(how, t);
    if (job().command.ticket == no_ticket) drive_.start.limit_set(how.text, t);
}

/// A text of the command table or of a curve is checked completely before the first telegram is sent.
bool Parameters::begin_text(const Parameter& parameter, Turn& t) {
    const auto* item = parameter.wire.if_contains("item");
    const bool curve = item && item->as_string() == "curve";
    if (!item || (!curve && item->as_string() != "table")) return false;
    const std::uint16_t element = point().element;
    const auto* write = std::get_if<WriteParameter>(&job().command.body);
    if (!drive_.options.inferred) {
        refuse(Reason::not_supported,
               fmt::format("{} rests on messages that are inferred, and the drive option inferred is off", parameter.id), t);
        return true;
    }
    if (!write) return drive_.transfers.begin_read(curve, element), true;
    const auto* text = std::get_if<std::string>(&write->value);
    CurveBytes c;
    EntryBytes e;
    if (curve)
        c = curve_of(element, text ? *text : std::string());
    else
        e = entry_of(drive_.bus.motions, text ? *text : std::string());
    if (const std::string& fault = curve ? c.fault : e.fault; !fault.empty()) {
        refuse(Reason::out_of_range, fmt::format("{}[{}]: {}", parameter.id, element, fault), t);
        return true;
    }
    curve ? drive_.transfers.begin_write(true, element, std::move(c.info), std::move(c.data))
          : drive_.transfers.begin_write(false, element, std::move(e.bytes));
    return true;
}

std::optional<Telegram> Parameters::request(Turn& t) {
    const std::uint8_t id = drive_.id();
    const auto* write = std::get_if<WriteParameter>(&job().command.body);
    const Place p = place_of(drive_.bus.catalogue, point());
    if (!p.parameter) return refused(Reason::unknown_point, "this drive has no such parameter", t);
    if (begin_text(*p.parameter, t)) return drive_.transfers.active() ? drive_.transfers.request() : std::nullopt;
    if (p.item == "warn") {
        if (drive_.options.warn_inferred) return linmot::request(id, Main::response, 3);
        return refused(Reason::not_supported, "the request for the warn word is inferred; the drive option warn_word = inferred allows it",
                       t);
    }
    if (!p.item.empty()) return linmot::request(id, Main::response, 1);
    if (!write) return p.rom ? request16(id, Main::parameters, 0, p.upid) : request16(id, Main::ram, 0, p.upid);
    const std::uint32_t raw = raw_of(write->value);
    if (p.rom) return request48(id, Main::parameters, 1, p.upid, raw);
    // RAM: written by a motion command, then read; if the command was not executed, once more with another count.
    if (job().step % 2 == 1) return request16(id, Main::ram, 0, p.upid);
    const std::vector<Value> values{std::int64_t{p.upid}, std::int64_t{raw}};
    job().count = drive_.motion.next_count(t.now);
    return drive_.motion.telegram(*drive_.bus.motions.named("002xh"), job().count, values);
}

void Parameters::answered(const Telegram& telegram, Turn& t) {
    const auto* write = std::get_if<WriteParameter>(&job().command.body);
    const Place p = place_of(drive_.bus.catalogue, point());
    const Status& status = drive_.feedback.status();
    const std::size_t behind = drive_.start.response_size();
    if (drive_.transfers.active()) {
        if (drive_.transfers.answered(telegram, t)) done(drive_.transfers.text(), t);
        return;
    }
    if (p.item == "status") return done(std::int64_t{status.status}, t);
    if (p.item == "state") return done(std::int64_t{status.state_var}, t);
    if (p.item == "warn") {
        if (telegram.size < behind + 2)
            return refuse(Reason::not_supported, fmt::format("drive {} does not send its warn word so", drive_.title()), t);
        return done(std::int64_t{telegram.u16(behind)}, t);
    }
    if (p.rom) return rom_answered(telegram, p.parameter->type, t);
    if (!write) return done(value_of(telegram.u32(behind), p.parameter->type), t);
    if (job().step++ % 2 == 0) return;  // written; the read comes next
    const std::uint32_t raw = raw_of(write->value);
    const Value is = value_of(telegram.u32(behind), p.parameter->type), wanted = value_of(raw, p.parameter->type);
    if (is == wanted) {
        for (std::size_t i = 0; i < std::size(Limits::upids); ++i) {
            if (p.upid == Limits::upids[i]) drive_.limits.at(i) = raw;
        }
        return done(is, t);
    }
    if (job().step < 4) return;
    refuse(Reason::drive_refused,
           fmt::format("drive {} keeps {} for {}: the parameter is not live, or it does not take this value", drive_.title(), to_text(is),
                       p.parameter->id),
           t);
}

void Parameters::rom_answered(const Telegram& telegram, ValueType type, Turn& t) {
    const auto a = config_of(telegram);
    if (!a) return fail(Reason::drive_refused, "the answer has another form", t);
    if (a->communication == 0) return done(value_of(a->value, type), t);
    // C0h and C3h: this drive does not have the value; other codes are refusals.
    const bool absent = (a->communication == 0xC0 || a->communication == 0xC3) && std::holds_alternative<ReadParameter>(job().command.body);
    refuse(absent ? Reason::not_supported : Reason::drive_refused, refusal(a->communication), t, a->communication);
}

}  // namespace axisgate::linmot
