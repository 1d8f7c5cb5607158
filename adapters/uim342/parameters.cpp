// Drive, part values: parameters of the catalogue, the drive's own language, and the actions of this family.
// In: ReadParameter, WriteParameter, Native, Action. Out: exchanges; results with what the drive said.
// Never writes FLASH for nothing: PP is read first and left alone if it holds the value already (10,000 writes [L1064]).
// Never lets anything between MF and its value: group values go as a pair inside one job.
#include <fmt/core.h>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {

void Drive::plan_read(const ReadParameter& read, Turn& t) {
    const Binding* b = bus_.points.binding(read.point);
    const Parameter* p = bus_.catalogue.parameter(read.point);
    if (!b || !p) return refuse_job(Reason::unknown_point, fmt::format("the UIM342 has no {}", bus_.catalogue.id_of(read.point)), t);
    if (!p->readable() || b->instruction->get_dl < 0) {
        return refuse_job(Reason::not_supported, fmt::format("{} can only be written", bus_.catalogue.id_of(read.point)), t);
    }
    job_.binding = b;
    if (b->mf != 0) job_.add(msg_set(cw::MF, b->mf), 0, true);
    job_.add(make_get(address_, *b->instruction, b->index), b->mf);
}

void Drive::done_read(const Message& m, Turn& t) {
    auto value = Points::value(*job_.binding, m);
    if (!value) {
        return job_over(Outcome::failed, Reason::internal, fmt::format("the answer is too short: {}", describe_answer(m)), t);
    }
    job_over(Outcome::done, Reason::none, "", t, 0, std::move(*value));
}

/// Drive IDs and group IDs of one network must all differ [L1064]; empty: no conflict known.
std::string Drive::id_conflict(std::uint8_t index, std::int64_t value) const {
    if (index != 7 && index != 8) return {};
    const auto id = static_cast<std::uint8_t>(value);
    if (index == 8) {
        if (id == address_) return fmt::format("{} is the drive's own node ID", id);
        const auto user = bus_.user_of(id, *this);
        return user.ends_with("node ID") ? fmt::format("{} is {}", id, user) : std::string();  // a group may have several members
    }
    if (group_ == id) return fmt::format("{} is the drive's own group ID", id);
    const auto user = bus_.user_of(id, *this);
    return user.empty() ? std::string() : fmt::format("{} is {}", id, user);
}

void Drive::plan_write(const WriteParameter& write, Turn& t) {
    const Binding* b = bus_.points.binding(write.point);
    const Parameter* p = bus_.catalogue.parameter(write.point);
    const std::string id = bus_.catalogue.id_of(write.point);
    if (!b || !p) return refuse_job(Reason::unknown_point, fmt::format("the UIM342 has no {}", id), t);
    const Instruction& i = *b->instruction;
    if (!p->writable() || (b->part && i.cw != cw::IL && i.cw != cw::DI) || i.set_dl < 0 || i.data == Data::none || i.data == Data::raw) {
        return refuse_job(Reason::not_writable, fmt::format("{} can only be read", id), t);
    }
    const auto v = as_integer(write.value);
    const Range r = i.cw == cw::DI ? Range{0, 1} : range_of(i.data);
    if (!v || *v < r.min || *v > r.max) {
        return refuse_job(Reason::out_of_range, fmt::format("{} takes a whole number {}..{}", id, r.min, r.max), t);
    }
    if ((i.cw == cw::AC || i.cw == cw::DC) && time_ramps_ == true && (*v < 1 || *v > 60'000)) {
        return refuse_job(Reason::out_of_range, fmt::format("{}: {} is outside 1..60000 ms (IC[4] = 1: AC and DC are times)", id, *v), t);
    }
    if (i.cw == cw::PP) {
        if (auto conflict = id_conflict(b->index, *v); !conflict.empty()) {
            return refuse_job(Reason::out_of_range, fmt::format("{}: {}; no two IDs of a network may coincide", id, conflict), t);
        }
        job_.add(make_get(address_, i, b->index));
    }
    job_.binding = b;
    job_.wanted = *v;
    if (b->part && i.cw == cw::IL) {
        if (auto checked = bus_.catalogue.check_write(write.point, write.value); !checked.fault.empty())
            return refuse_job(Reason::out_of_range, std::move(checked.fault), t);
        return job_.add(make_get(address_, i, b->index));  // the other parts stay as they are: done_write puts the whole together
    }
    if (i.cw == cw::MO && *v != 0) job_.add(msg_act(cw::ST));  // a residual motion would begin with the driver [L1264]
    if (b->mf != 0) job_.add(msg_set(cw::MF, b->mf), 0, true);
    job_.add(make_set(address_, i, b->index, *v), b->mf);
}

/// An answer to a step of a write.
void Drive::done_write(const Message& m, Turn& t) {
    const Binding& b = *job_.binding;
    const Instruction& i = *b.instruction;
    const Message& request = job_.steps[job_.at - 1u].message;
    if (request.function() != i.cw) return;  // the ST before MO=1
    const auto told = value_of(request, m);
    if (b.part && i.cw == cw::IL) {
        if (form_of(request) == Form::get) {
            const unsigned at = (b.byte - 1u) * 8u + b.bit;
            const std::int64_t mask = ((std::int64_t{1} << b.bits) - 1) << at;
            job_.add(make_set(address_, i, b.index, (told.value_or(0) & ~mask) | (job_.wanted << at & mask)));
            return;
        }
        return job_over(Outcome::done, Reason::none, storage_note(i, b.index), t, 0, Points::value(b, m).value_or(Value{job_.wanted}));
    }
    if (form_of(request) == Form::get) {  // PP: what is stored
        if (told == job_.wanted) {
            job_over(Outcome::done, Reason::none, "it is stored already: FLASH was not written", t, 0, Value{job_.wanted});
        }
        return;
    }
    std::int64_t value = job_.wanted;
    std::string text = storage_note(i, b.index);
    if (i.answer == SetAnswer::echo || (i.answer == SetAnswer::desired && b.mf == 0)) {
        value = told.value_or(job_.wanted);
        if (value != job_.wanted) {
            text = fmt::format("the drive took {} instead of {}{}{}", value, job_.wanted, text.empty() ? "" : "; ", text);
        }
    }
    if (i.cw == cw::MF && job_.wanted != 0) {
        mf_unknown_ = true;  // whatever of ours comes next must not hit that group
        text = "selected, but every exchange of the gateway falls back to group 0: write MF2.AC and the like instead";
    }
    job_over(Outcome::done, Reason::none, std::move(text), t, 0, b.type == ValueType::boolean ? Value{value != 0} : Value{value});
}

std::string Drive::storage_note(const Instruction& i, std::uint8_t index) const {
    std::string s;
    if (i.storage == Storage::eeprom_off && status_.on) s = "kept in RAM only, because the driver is on: lost at power-off";
    const bool late = i.cw == cw::PP || (i.cw == cw::MT && index == 0) || (i.cw == cw::QE && index == 4) ||
                      (i.cw == cw::IC && (index == 0 || index == 2 || index == 5));
    if (late) s += fmt::format("{}acts after the next restart", s.empty() ? "" : "; ");
    return s;
}

// --- native ----------------------------------------------------------------------------------------------------------------------

void Drive::plan_native(const Native& native, Turn& t) {
    const NativeScript script =
        native.is_text ? parse_native(address_, std::string_view(reinterpret_cast<const char*>(native.send.data()), native.send.size()))
                       : parse_native(address_, std::span<const std::uint8_t>(native.send));
    if (!script.fault.empty()) return refuse_job(Reason::out_of_range, script.fault, t);
    plan_messages(script.messages, t);
}

void Drive::plan_messages(const std::vector<Message>& messages, Turn& t) {
    std::uint8_t mf = 0;
    bool blind = false;
    for (std::size_t n = 0; n < messages.size(); ++n) {
        const Message& m = messages[n];
        const Instruction* i = instruction(m.cw);
        if (m.function() == cw::MF && form_of(m) == Form::set && m.d[0] != 0) {
            const Instruction* next = n + 1 < messages.size() ? instruction(messages[n + 1].cw) : nullptr;
            if (!next || !next->takes_mf) {
                return refuse_job(
                    Reason::wrong_state,
                    fmt::format("MF={} alone would be used up by anything that comes between: write MF={};AC=1000 in one line", m.d[0],
                                m.d[0]),
                    t);
            }
            mf = m.d[0];
            job_.add(m, 0, m.wants_ack());
        } else {
            job_.add(m, mf);
            mf = 0;
        }
        if (i && i->cw == cw::SY && n + 1 != messages.size()) return refuse_job(Reason::wrong_state, "SY must be the last of a line", t);
        blind = blind || !m.wants_ack() || (i && i->cw == cw::SY);
        if (i && i->cw == cw::SY) {
            job_.steps[job_.count - 1u].message.cw &= static_cast<std::uint8_t>(~ack_bit);  // it never acknowledges [L1216]
            job_.wanted = m.d[0];
            job_.kind = JobKind::system;
        }
    }
    if (blind && !(job_.kind == JobKind::system && job_.wanted == 1)) {
        job_.add(messages.back().function() == cw::MS ? msg_get(cw::MO) : msg_get(cw::MS, 1));
        job_.steps[job_.count - 1u].check = true;
    }
}

void Drive::native_answered(const Step& step, const Message* answer, Turn& t) {
    if (step.check) return;
    std::string& s = job_.text;
    if (!s.empty()) s += "; ";
    if (!answer) {
        s += describe_request(step.message) + " sent";
        if (step.message.function() == cw::BG) begin_unknown_motion(t);
        return;
    }
    s += describe_answer(*answer);
    job_.bytes.insert(job_.bytes.end(), {answer->cw, answer->dl});
    job_.bytes.insert(job_.bytes.end(), answer->d.begin(), answer->d.begin() + answer->dl);
    if (step.message.function() == cw::BG) begin_unknown_motion(t);
    if (step.message.function() == cw::OG) {
        fb_.referenced = true;
        demand_rests(fb_.position = 0);
        position_at_ = t.now;
        emit(t);
    }
    poll_now(t);
}

void Drive::done_native(Turn& t) {
    const Command c = job_.command;
    const bool action = std::holds_alternative<Action>(c.body);
    const bool system = job_.kind == JobKind::system;
    const std::int64_t which = job_.wanted;
    if (system && which == 1) {
        std::string text = std::move(job_.text);
        job_.active = false;
        const bool watch = action && c.until_done && c.ticket != no_ticket;
        if (!watch) {
            result(c.ticket, action ? Outcome::accepted : Outcome::done, Reason::none,
                   text + "; the drive does not acknowledge it and restarts", t);
        }
        reboot_begun(t);
        if (watch) add_wait(WaitFor::boot, c.ticket, 0, t);
        return;
    }
    if (system) {
        begin_reading(t, true);  // the factory settings are in force now
        poll_now(t);
    }
    if (action) return job_over(c.until_done ? Outcome::done : Outcome::accepted, Reason::none, job_.text, t);
    job_over(Outcome::done, Reason::none, job_.text, t);
}

// --- actions ---------------------------------------------------------------------------------------------------------------------

void Drive::plan_action(const Action& action, Turn& t) {
    struct Row {
        std::string_view name;
        std::string_view script;
    };
    constexpr std::array rows{Row{"reboot", "SY[1]"}, Row{"factory_defaults", "SY[2]"}, Row{"clear_status", "MS[0]=0"},
                              Row{"clear_error", "ER[0]=0"}};
    std::string script;
    for (const auto& r : rows) {
        if (r.name == action.name) script = r.script;
    }
    if (script.empty()) {
        // Any instruction of the catalogue by its id or name; the argument is what follows it: "[1]", "=5", "[0]=16", or a number.
        for (const auto& c : bus_.catalogue.commands()) {
            if (c.id != action.name && c.name != action.name) continue;
            const Instruction* i = instruction_named(c.id);
            const std::string& a = action.argument;
            if (a.empty() || a.starts_with('[') || a.starts_with('=')) {
                script = c.id + a;
            } else {
                script = i && i->indexed ? fmt::format("{}[{}]", c.id, a) : fmt::format("{}={}", c.id, a);
            }
        }
    }
    if (script.empty()) {
        return refuse_job(
            Reason::unknown_point,
            fmt::format("{} is not an action of the UIM342; there are reboot, factory_defaults, clear_status, clear_error, start_group, "
                        "global_stop, and the instructions by name",
                        action.name),
            t);
    }
    const NativeScript parsed = parse_native(address_, script);
    if (!parsed.fault.empty()) return refuse_job(Reason::out_of_range, parsed.fault, t);
    plan_messages(parsed.messages, t);
}

}  // namespace axisgate::uim342
