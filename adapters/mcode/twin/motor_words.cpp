// Motor: reading, writing, printing, saving and restoring its words.
// In: words and fields. Out: values, texts, MCode error codes.
// Never starts motion, except AS = 3 and what jog and torque words change while they run.
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {
namespace {
/// Its number from 0, in a row of words that begins with `first`.
std::size_t number_of(Word w, Word first) noexcept { return static_cast<std::size_t>(w) - static_cast<std::size_t>(first); }

std::int64_t wrapped(double v) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(static_cast<std::int64_t>(nearest(v)))));
}

}  // namespace

Number Motor::read(Word w, Instant now, int& error) {
    advance(now);
    if (const int code = p_.settings.available(w); code != 0) {
        error = code;
        return {};
    }
    const auto flag = [](bool b) { return Number::of(b ? 1 : 0); };
    switch (w) {
        case Word::P:
            return Number::of(wrapped(p_.shaft.shown_position(now).position));
        case Word::C1:
            return Number::of(wrapped(p_.shaft.c1(now)));
        case Word::C2:
            return Number::of(wrapped(p_.shaft.c2(now)));
        case Word::PC:
            return Number::of(wrapped(static_cast<double>(p_.trips.captured())));
        case Word::V:
            return Number::of(p_.settings.hmt_mode() == 3 ? 0 : std::llround(p_.shaft.commanded(now).velocity));
        case Word::AV:
            return Number::of(p_.settings.hmt_mode() == 0 ? 0 : std::llround(p_.shaft.rotor(now).velocity));
        case Word::VC:
            return flag(course_.velocity_changing(now));
        case Word::MV:
            return flag(moving_.at(now));
        case Word::MP:
            return flag(to_position_.at(now));
        case Word::ST:
            return flag(course_.stall_flag());
        case Word::LR:
            return flag(p_.loop.locked());
        case Word::LL:
            return Number::of(p_.settings.hmt_mode() == 0
                                  ? 0
                                  : wrapped((p_.shaft.commanded(now).position - p_.shaft.measured(now).position) * p_.shaft.way(now)));
        case Word::AF:
            return Number::of(p_.loop.status(p_.power.supply, now));
        case Word::I1:
        case Word::I2:
        case Word::I3:
        case Word::I4:
            return flag(p_.inputs.active(number_of(w, Word::I1)));
        case Word::I5:
            return Number::of(p_.inputs.analog(now));
        case Word::I6:
            return flag(p_.shaft.index_here(now));
        case Word::IN:
            return Number::of(p_.inputs.levels() & ((1 << p_.inputs.fitted()) - 1));
        case Word::OF:
            return Number::of(output_fault_);
        case Word::SA:
            return Number::of_real(p_.settings[Word::SA]);
        default:
            break;
    }
    if (info(w).access != Access::rw || info(w).owner != Owner::motor) {
        error = err::bad_print;
        return {};
    }
    return Number::of(p_.settings.whole(w));
}

std::optional<std::string> Motor::text(Word w, Instant now) {
    advance(now);
    switch (w) {
        case Word::MD:
            return std::string(text_of(moves_.last()));
        case Word::IS:
            return p_.inputs.text();
        case Word::OS:
            return p_.outputs.text();
        case Word::LS:
            return p_.limits.text();
        case Word::VT:
            return p_.power.supply.voltages();
        case Word::IT:
            return p_.power.supply.temperatures();
        default:
            return std::nullopt;
    }
}

int Motor::write(Word w, std::span<const Number> fields, Instant now) {
    advance(now);
    if (const int code = p_.settings.available(w); code != 0) return code;
    const WordInfo& i = info(w);
    if (i.access == Access::ro || i.access == Access::none) return err::read_only;
    int code = 0;
    if (w == Word::IS || w == Word::OS || w == Word::LS) {
        std::array<std::int64_t, 3> values{};
        if (fields.empty() || fields.size() > values.size()) return err::bad_value;
        for (std::size_t k = 0; k < fields.size(); ++k)
            values[k] = fields[k].as_integer();
        const std::span<const std::int64_t> given(values.data(), fields.size());
        code = w == Word::IS ? p_.inputs.set_up(given, now) : w == Word::OS ? p_.outputs.set_up(given) : p_.limits.set_up(given);
    } else {
        if (fields.size() != 1) return err::bad_value;
        const double v = w == Word::SA ? fields[0].as_double() : static_cast<double>(fields[0].as_integer());
        if (i.ranged && !(v >= i.min && v <= i.max)) return err::bad_value;
        code = write_value(w, fields[0], now);
    }
    if (w == Word::IS && code == 0) p_.cams.hold(now);
    replan(now);
    return code;
}

int Motor::write_value(Word w, const Number& n, Instant now) {
    const std::int64_t v = n.as_integer();
    const double d = static_cast<double>(v);
    if (const auto code = numbering_.write(w, n, now)) return *code;
    const Settings& s = p_.settings;
    switch (w) {
        case Word::A:
        case Word::D: {
            const double low = w == Word::A && s.encoder_mode() ? 6 : 66;
            const double high = s.encoder_mode() ? 44e6 : 1.1e9;
            if (d < low || d > high) return err::bad_value;
            break;
        }
        case Word::VI:
            if (v < 1) return err::bad_value;
            if (d >= s[Word::VM]) return err::vi_too_large;
            break;
        case Word::VM:
            if (d <= s[Word::VI]) return err::vm_too_small;
            if (d > s.speed_limit()) return err::too_large;
            break;
        case Word::HT:
        case Word::MT: {
            const double other = s[w == Word::HT ? Word::MT : Word::HT];
            if (v < 0 || d + other > 65535) return err::bad_value;
            break;
        }
        case Word::ST:
            course_.clear_stall();
            return 0;
        case Word::DE:
            return enable_drive(v != 0, now);
        case Word::MF:
            if (v < 92 || d > top_turns_per_second * 51200) return err::makeup_out;
            break;
        case Word::TS:
            if (v < 46512) return err::bad_value;
            if (d > s.speed_limit()) return err::too_large;
            break;
        case Word::O1:
        case Word::O2:
        case Word::O3:
            return p_.outputs.set(number_of(w, Word::O1), v != 0);
        case Word::OT:
            return p_.outputs.set_all(v);
        case Word::D1:
        case Word::D2:
        case Word::D3:
        case Word::D4:
            p_.inputs.filter(number_of(w, Word::D1), static_cast<int>(v), now);
            break;
        case Word::D5:
            p_.inputs.analog_filter(static_cast<int>(v), now);
            break;
        default:
            break;
    }
    p_.settings.set(w, d);
    apply(w, now);
    return 0;
}

int Motor::enable_drive(bool on, Instant now) {
    if (!on && p_.settings[Word::DE] != 0) {
        const bool owed = owes(now);
        course_.abort(now);
        course_.resync(now);
        if (owed) p_.events.raise(err::makeup_disabled);
    }
    if (on && p_.power.supply.over_temperature) return err::hot;
    p_.settings.set(Word::DE, on ? 1 : 0);
    if (on) {
        course_.maintain(now);
        moves_.jog(now);
    }
    return 0;
}

void Motor::apply(Word w, Instant now) {
    switch (w) {
        case Word::JE:
            moves_.jog(now);
            break;
        case Word::PM:
        case Word::DB:
        case Word::SF:
        case Word::SM:
            course_.maintain(now);
            break;
        case Word::RC:
        case Word::TQ:
            course_.judge_rotor(now);
            break;
        case Word::TS:
        case Word::TD:
            if (p_.settings.hmt_mode() == 3) {
                p_.loop.set_torque(true);
                course_.run_torque(now);
            }
            break;
        case Word::WT:
            judge_supply(now);
            break;
        default:
            break;
    }
}

void Motor::factory(Instant now) {
    advance(now);
    if (!course_.rests()) course_.freeze(now);
    numbering_.factory(now);
    p_.inputs.factory(now);
    p_.outputs.factory();
    p_.limits.factory();
    p_.trips.enable(0, now);
    p_.cams.anew(now);
    replan(now);
}

void Motor::save(NonVolatile& m) const {
    p_.settings.save(m);
    p_.inputs.save(m);
    p_.outputs.save(m);
    p_.limits.save(m);
}

/// Power-up and IP. Torque mode comes back without motion: the drive starts it only when AS, TS or TD is written.
void Motor::load(const NonVolatile& m, Instant now) {
    advance(now);
    if (!course_.rests()) course_.freeze(now);
    numbering_.load(m, now);
    for (std::size_t n = 0; n < 4; ++n)
        p_.inputs.filter(n, static_cast<int>(p_.settings.whole(nth(Word::D1, static_cast<int>(n)))), now);
    p_.inputs.load(m, now);
    p_.inputs.analog_filter(static_cast<int>(p_.settings.whole(Word::D5)), now);
    p_.outputs.load(m);
    p_.limits.load(m);
    p_.loop.set_torque(false);
    p_.cams.anew(now);
    replan(now);
}

}  // namespace axisgate::mcode::twin
