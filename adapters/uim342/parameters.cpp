// Parameters: points of the catalogue, read and written.
// In: ReadParameter, WriteParameter. Out: exchanges; results with what the drive said.
// Never writes FLASH for nothing: PP is read first and left alone if it holds the value already (10,000 writes [L1064]).
#include <fmt/core.h>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {

void Parameters::plan(const Command& command, Turn& t) {
    const auto* write = std::get_if<WriteParameter>(&command.body);
    const Point point = write ? write->point : std::get<ReadParameter>(command.body).point;
    const Catalogue& catalogue = drive_.bus.catalogue;
    const std::string id = catalogue.id_of(point);
    const Parameter* p = catalogue.parameter(point);
    binding_ = drive_.bus.points.binding(point);
    if (!binding_ || !p) return refuse(Reason::unknown_point, fmt::format("the UIM342 has no {}", id), t);
    if (write) return plan_write(*write, *p, id, t);
    const Binding& b = *binding_;
    if (!p->readable() || b.instruction->get_dl < 0) return refuse(Reason::not_supported, fmt::format("{} can only be written", id), t);
    add(make_get(drive_.address(), *b.instruction, b.index));
}

/// Behind its MF, if it is a group's.
void Parameters::add(const Message& m) {
    const std::uint8_t mf = binding_->mf;
    mf != 0 ? job().add_grouped(drive_.set(cw::MF, mf), m, mf) : job().add(m);
}

void Parameters::answered(const Step& step, const Message* m, Turn& t) {
    if (std::holds_alternative<WriteParameter>(job().command.body)) return written(step, *m, t);
    if (step.select) return;
    auto value = Points::value(*binding_, *m);
    if (value) return succeed("", t, std::move(*value));
    fail(Reason::internal, fmt::format("the answer is too short: {}", describe_answer(*m)), t);
}

/// Drive IDs and group IDs of one network must all differ [L1064]; empty: no conflict known.
std::string Parameters::id_conflict(std::uint8_t index, std::int64_t value) const {
    if (index != 7 && index != 8) return {};
    const auto id = static_cast<std::uint8_t>(value);
    const bool group = index == 8;
    if (group && id == drive_.address()) return fmt::format("{} is the drive's own node ID", id);
    if (!group && drive_.known.group == id) return fmt::format("{} is the drive's own group ID", id);
    const auto user = drive_.bus.user_of(id, drive_);
    if (user.empty() || (group && !user.ends_with("node ID"))) return {};  // a group may have several members
    return fmt::format("{} is {}", id, user);
}

void Parameters::plan_write(const WriteParameter& write, const Parameter& p, const std::string& id, Turn& t) {
    const Binding& b = *binding_;
    const Instruction& i = *b.instruction;
    if (!p.writable() || (b.part && i.cw != cw::IL && i.cw != cw::DI) || i.set_dl < 0 || i.data == Data::none || i.data == Data::raw)
        return refuse(Reason::not_writable, fmt::format("{} can only be read", id), t);
    const auto v = as_integer(write.value);
    const Range r = i.cw == cw::DI ? Range{0, 1} : range_of(i.data);
    if (!v || *v < r.min || *v > r.max)
        return refuse(Reason::out_of_range, fmt::format("{} takes a whole number {}..{}", id, r.min, r.max), t);
    if ((i.cw == cw::AC || i.cw == cw::DC) && drive_.known.ram.time_ramps == true && (*v < 1 || *v > 60'000))
        return refuse(Reason::out_of_range, fmt::format("{}: {} is outside 1..60000 ms (IC[4] = 1: AC and DC are times)", id, *v), t);
    if (i.cw == cw::PP) {
        if (auto conflict = id_conflict(b.index, *v); !conflict.empty())
            return refuse(Reason::out_of_range, fmt::format("{}: {}; no two IDs of a network may coincide", id, conflict), t);
        job().add(make_get(drive_.address(), i, b.index));
    }
    wanted_ = *v;
    if (b.part && i.cw == cw::IL) {
        if (auto checked = drive_.bus.catalogue.check_write(write.point, write.value); !checked.fault.empty())
            return refuse(Reason::out_of_range, std::move(checked.fault), t);
        return job().add(make_get(drive_.address(), i, b.index));  // the other parts stay as they are: `written` puts the whole together
    }
    if (i.cw == cw::MO && *v != 0) job().add(drive_.act(cw::ST));  // a residual motion would begin with the driver [L1264]
    add(make_set(drive_.address(), i, b.index, *v));
}

/// An answer to a step of a write.
void Parameters::written(const Step& step, const Message& m, Turn& t) {
    const Binding& b = *binding_;
    const Instruction& i = *b.instruction;
    if (step.message.function() != i.cw) return;  // the ST before MO=1, or an MF
    const auto reported = value_of(step.message, m);
    const bool read = form_of(step.message) == Form::get;
    if (b.part && i.cw == cw::IL) {
        if (!read) return succeed(storage_note(), t, Points::value(b, m).value_or(Value{wanted_}));
        const unsigned at = (b.byte - 1u) * 8u + b.bit;
        const std::int64_t mask = ((std::int64_t{1} << b.bits) - 1) << at;
        return job().add(make_set(drive_.address(), i, b.index, (reported.value_or(0) & ~mask) | (wanted_ << at & mask)));
    }
    if (read) {  // PP: what is stored
        if (reported == wanted_) succeed("it is stored already: FLASH was not written", t, Value{wanted_});
        return;
    }
    std::int64_t value = wanted_;
    std::string text = storage_note();
    if (i.answer == SetAnswer::echo || (i.answer == SetAnswer::desired && b.mf == 0)) value = reported.value_or(wanted_);
    if (value != wanted_) text = fmt::format("the drive took {} instead of {}{}{}", value, wanted_, text.empty() ? "" : "; ", text);
    if (i.cw == cw::MF && wanted_ != 0) {
        drive_.exchanges.mf_unknown = true;  // whatever of ours comes next must not hit that group
        text = "selected, but every exchange of the gateway falls back to group 0: write MF2.AC and the like instead";
    }
    succeed(std::move(text), t, b.type == ValueType::boolean ? Value{value != 0} : Value{value});
}

std::string Parameters::storage_note() const {
    const Instruction& i = *binding_->instruction;
    const std::uint8_t index = binding_->index;
    std::string s;
    if (i.storage == Storage::eeprom_off && drive_.feedback.status().on)
        s = "kept in RAM only, because the driver is on: lost at power-off";
    const bool late = i.cw == cw::PP || (i.cw == cw::MT && index == 0) || (i.cw == cw::QE && index == 4) ||
                      (i.cw == cw::IC && (index == 0 || index == 2 || index == 5));
    if (late) s += fmt::format("{}acts after the next restart", s.empty() ? "" : "; ");
    return s;
}

}  // namespace axisgate::uim342
