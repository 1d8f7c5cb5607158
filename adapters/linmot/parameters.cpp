// Parameters: RAM values by the read that comes with a default response and by Write Live Parameter, ROM values by the parameter messages.
// In: reads and writes of catalogue points. Out: values as the drive has them. What was written is read back: a RAM write has no answer of
// its own. Entries of the command table and curves are texts, carried by parameters_transfer.cpp.
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

/// A text of the command table or of a curve: what is to be written is checked as a whole, before the drive is asked anything.
bool Drive::begin_table_parameter(const Parameter& parameter, Point point, Turn& t) {
    const auto* item = parameter.wire.if_contains("item");
    const bool curve = item && item->as_string() == "curve";
    if (!item || (!curve && item->as_string() != "table")) return false;
    const auto* write = std::get_if<WriteParameter>(&job_.command.body);
    if (!inferred_) {
        end_job(Outcome::refused, Reason::not_supported,
                fmt::format("{} rests on messages that are inferred, and the drive option inferred is off", parameter.id), t);
        return true;
    }
    if (!write) return begin_transfer(curve, false, point.element), true;
    const auto* text = std::get_if<std::string>(&write->value);
    CurveBytes c;
    EntryBytes e;
    if (curve)
        c = curve_of(point.element, text ? *text : std::string());
    else
        e = entry_of(bus_.motions, text ? *text : std::string());
    if (const std::string& fault = curve ? c.fault : e.fault; !fault.empty()) {
        end_job(Outcome::refused, Reason::out_of_range, fmt::format("{}[{}]: {}", parameter.id, point.element, fault), t);
        return true;
    }
    curve ? begin_transfer(true, true, point.element, std::move(c.info), std::move(c.data))
          : begin_transfer(false, true, point.element, std::move(e.bytes));
    return true;
}

std::string Drive::refusal(std::uint8_t code) const { return fmt::format("drive {} refused: {}", title(), communication_text(code)); }

std::optional<Telegram> Drive::parameter_request(Turn& t) {
    const auto* read = std::get_if<ReadParameter>(&job_.command.body);
    const auto* write = std::get_if<WriteParameter>(&job_.command.body);
    const Place p = place_of(bus_.catalogue, read ? read->point : write->point);
    if (!p.parameter) {
        end_job(Outcome::refused, Reason::unknown_point, "this drive has no such parameter", t);
        return std::nullopt;
    }
    if (begin_table_parameter(*p.parameter, read ? read->point : write->point, t)) return job_.active ? transfer_request() : std::nullopt;
    if (p.item == "warn") {
        if (warn_inferred_) return request(id_, Main::response, 3);
        end_job(Outcome::refused, Reason::not_supported,
                "the request for the warn word is inferred; the drive option warn_word = inferred allows it", t);
        return std::nullopt;
    }
    if (!p.item.empty()) return request(id_, Main::response, 1);
    if (read) return p.rom ? request16(id_, Main::parameters, 0, p.upid) : request16(id_, Main::ram, 0, p.upid);
    const std::uint32_t raw = raw_of(write->value);
    if (p.rom) return request48(id_, Main::parameters, 1, p.upid, raw);
    // RAM: written by a motion command, then read; once more with another count where the first was not executed.
    if (job_.step % 2 == 1) return request16(id_, Main::ram, 0, p.upid);
    const std::vector<Value> values{std::int64_t{p.upid}, std::int64_t{raw}};
    job_.count = next_count();
    return motion_telegram(*bus_.motions.named("002xh"), job_.count, values);
}

void Drive::parameter_answered(const Telegram& telegram, Turn& t) {
    const auto* read = std::get_if<ReadParameter>(&job_.command.body);
    const auto* write = std::get_if<WriteParameter>(&job_.command.body);
    const Point point = read ? read->point : write->point;
    const Place p = place_of(bus_.catalogue, point);
    const auto done = [&](Value v) {
        t.out.samples.push_back({axis_, point, v, Quality::good, t.now, 0});
        end_job(Outcome::done, Reason::none, {}, t, 0, std::move(v));
    };
    if (job_.transfer.active) {
        if (transfer_answered(telegram, t)) done(transfer_text());
        return;
    }
    if (p.item == "status") return done(std::int64_t{status_.status});
    if (p.item == "state") return done(std::int64_t{status_.state_var});
    if (p.item == "warn") {
        if (telegram.size < default_size + 2)
            return end_job(Outcome::refused, Reason::not_supported, fmt::format("drive {} does not send its warn word so", title()), t);
        return done(std::int64_t{telegram.u16(default_size)});
    }
    if (p.rom) {
        const auto a = config_of(telegram);
        if (!a) return end_job(Outcome::failed, Reason::drive_refused, "the answer has another form", t);
        if (a->communication != 0) {
            // C0h and C3h: this drive has no such value; what else it says is its refusal.
            const bool absent = a->communication == 0xC0 || a->communication == 0xC3;
            return end_job(Outcome::refused, absent && read ? Reason::not_supported : Reason::drive_refused, refusal(a->communication), t,
                           a->communication);
        }
        return done(value_of(a->value, p.parameter->type));
    }
    if (read) return done(value_of(telegram.u32(default_size), p.parameter->type));
    if (job_.step++ % 2 == 0) return;  // written; now it is read
    const Value is = value_of(telegram.u32(default_size), p.parameter->type), wanted = value_of(raw_of(write->value), p.parameter->type);
    if (is == wanted) {
        for (const auto& [upid, into] : {std::pair{0x14BE, &vmax_}, std::pair{0x14BF, &acc_}, std::pair{0x14C0, &dec_}}) {
            if (p.upid == upid) *into = raw_of(write->value);
        }
        return done(is);
    }
    if (job_.step < 4) return;
    end_job(Outcome::refused, Reason::drive_refused,
            fmt::format("drive {} keeps {} for {}: the parameter is not live, or it does not take this value", title(), to_text(is),
                        p.parameter->id),
            t);
}

}  // namespace axisgate::linmot
