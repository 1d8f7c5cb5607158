// Motor: reading, writing, printing, saving and restoring its words.
// In: words and fields. Out: values, texts, MCode error codes.
// Never starts motion, except AS = 3 and what jog and torque words change while they run.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {
namespace {
struct Default {
    Word word;
    double value;
};
/// What S saves and FD resets, beside IS, OS, LS and FS. VI, VM, A and D depend on EE.
constexpr std::array saved{
    Default{Word::AJ, 0},      Default{Word::AO, 0},      Default{Word::AS, 0},      Default{Word::AT, 1},      Default{Word::BE, 0},
    Default{Word::BL, 0},      Default{Word::BM, 0},      Default{Word::CB, 1},      Default{Word::CW, 10},     Default{Word::D1, 0},
    Default{Word::D2, 0},      Default{Word::D3, 0},      Default{Word::D4, 0},      Default{Word::D5, 0},      Default{Word::DB, 1},
    Default{Word::DE, 1},      Default{Word::DJ, 0},      Default{Word::DT, 1},      Default{Word::EE, 0},      Default{Word::EL, 1000},
    Default{Word::FC, 0},      Default{Word::FL, 0},      Default{Word::FM, 0},      Default{Word::HC, 5},      Default{Word::HT, 500},
    Default{Word::JE, 0},      Default{Word::LD, 102400}, Default{Word::LG, 102400}, Default{Word::LM, 1},      Default{Word::LT, 2000},
    Default{Word::MF, 768000}, Default{Word::MS, 256},    Default{Word::MT, 500},    Default{Word::MU, 0},      Default{Word::PM, 0},
    Default{Word::RC, 25},     Default{Word::RD, 0},      Default{Word::SA, 1.8},    Default{Word::SF, 15},     Default{Word::SM, 0},
    Default{Word::TD, 1},      Default{Word::TQ, 25},     Default{Word::TS, 0},      Default{Word::VF, 0},      Default{Word::VI, 1000},
    Default{Word::VM, 768000}, Default{Word::WT, 80},     Default{Word::A, 1000000}, Default{Word::D, 1000000},
};
constexpr std::array step_angles{0.45, 0.72, 0.9, 1.8, 1.875, 2.0, 2.5, 3.6, 5.0};

std::int64_t wrapped(double v) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(static_cast<std::int64_t>(nearest(v)))));
}

}  // namespace

void Motor::defaults() noexcept {
    settings_.fill(0);
    for (const Default& d : saved)
        set(d.word, d.value);
}

int Motor::available(Word w) const noexcept {
    if ((info(w).products & setup_.product) == 0) return err::not_available;
    if (setup_.frame_size == 17) {
        if (w == Word::O1 || w == Word::O2 || w == Word::FC || w == Word::I4 || w == Word::D4) return err::not_available;
    }
    return 0;
}

Number Motor::read(Word w, Instant now, int& error) {
    advance(now);
    if (const int code = available(w); code != 0) {
        error = code;
        return {};
    }
    const auto flag = [](bool b) { return Number::of(b ? 1 : 0); };
    switch (w) {
        case Word::P:
            return Number::of(wrapped(position(now).position));
        case Word::C1:
            return Number::of(wrapped(c1(now)));
        case Word::C2:
            return Number::of(wrapped(c2(now)));
        case Word::PC:
            return Number::of(wrapped(static_cast<double>(captured_)));
        case Word::V:
            return Number::of(hmt_mode() == 3 ? 0 : std::llround(command_.at(now).velocity));
        case Word::AV:
            return Number::of(hmt_mode() == 0 ? 0 : std::llround(rotor(now).velocity));
        case Word::VC:
            return flag(phase_ == Phase::steps && command_.changing(now) != 0);
        case Word::MV:
            return flag(phase_ != Phase::rest);
        case Word::MP:
            return flag(phase_ != Phase::rest && task_ == Task::position && (!go_on_ || passing_ != never));
        case Word::ST:
            return flag(stall_flag_);
        case Word::LR:
            return flag(hmt_.locked);
        case Word::LL:
            return Number::of(hmt_mode() == 0 ? 0 : wrapped(owed(now)));
        case Word::AF:
            return Number::of(status(now));
        case Word::FS:
            return Number::of(std::llround(index_offset_));
        case Word::I1:
        case Word::I2:
        case Word::I3:
        case Word::I4:
            return flag(inputs_.active(static_cast<std::size_t>(w) - static_cast<std::size_t>(Word::I1)));
        case Word::I5:
            return Number::of(inputs_.analog(now));
        case Word::I6:
            return flag(index_here(now));
        case Word::IN:
            return Number::of(inputs_.levels() & ((1 << inputs_.fitted()) - 1));
        case Word::OF:
            return Number::of(output_fault_);
        case Word::SA:
            return Number::of_real(setting(Word::SA));
        default:
            break;
    }
    if (info(w).access != Access::rw || info(w).owner != Owner::motor) {
        error = err::bad_print;
        return {};
    }
    return Number::of(whole(w));
}

std::optional<std::string> Motor::text(Word w, Instant now) {
    advance(now);
    switch (w) {
        case Word::MD:
            return std::string(text_of(last_motion_));
        case Word::IS:
            return inputs_.text();
        case Word::OS:
            return outputs_.text();
        case Word::LS: {
            std::string s;
            for (std::size_t i = 0; i < 2; ++i) {
                s += (i == 0 ? "LS=" : "\r\nLS=") + std::to_string(i) + ", " + std::to_string(std::llround(soft_limit_[i])) + ", " +
                     (soft_on_[i] ? "1" : "0");
            }
            return s;
        }
        case Word::VT:
            return supply_.voltages();
        case Word::IT:
            return supply_.temperatures();
        default:
            return std::nullopt;
    }
}

int Motor::write(Word w, std::span<const Number> fields, Instant now) {
    advance(now);
    if (const int code = available(w); code != 0) return code;
    const WordInfo& i = info(w);
    if (i.access == Access::ro || i.access == Access::none) return err::read_only;
    int code = 0;
    if (w == Word::IS || w == Word::OS || w == Word::LS) {
        std::array<std::int64_t, 3> values{};
        if (fields.empty() || fields.size() > values.size()) return err::bad_value;
        for (std::size_t k = 0; k < fields.size(); ++k)
            values[k] = fields[k].as_integer();
        const std::span<const std::int64_t> given(values.data(), fields.size());
        code = w == Word::IS ? inputs_.set_up(given, now) : w == Word::OS ? outputs_.set_up(given) : set_soft_limit(given);
    } else {
        if (fields.size() != 1) return err::bad_value;
        const double v = w == Word::SA ? fields[0].as_double() : static_cast<double>(fields[0].as_integer());
        if (i.ranged && !(v >= i.min && v <= i.max)) return err::bad_value;
        code = write_value(w, fields[0], now);
    }
    if (w == Word::IS && code == 0) place_switches(now);
    replan(now);
    return code;
}

int Motor::write_value(Word w, const Number& n, Instant now) {
    const std::int64_t v = n.as_integer();
    const double d = static_cast<double>(v);
    switch (w) {
        case Word::A:
        case Word::D: {
            const double low = w == Word::A && encoder_mode() ? 6 : 66;
            const double high = encoder_mode() ? 44e6 : 1.1e9;
            if (d < low || d > high) return err::bad_value;
            break;
        }
        case Word::VI:
            if (v < 1) return err::bad_value;
            if (d >= setting(Word::VM)) return err::vi_too_large;
            break;
        case Word::VM:
            if (d <= setting(Word::VI)) return err::vm_too_small;
            if (d > speed_limit()) return err::too_large;
            break;
        case Word::MS:
            return set_microsteps(v, now);
        case Word::EE:
            return set_encoder_mode(v != 0, now);
        case Word::AS:
            return set_hmt_mode(v, now);
        case Word::HT:
        case Word::MT: {
            const double other = setting(w == Word::HT ? Word::MT : Word::HT);
            if (v < 0 || d + other > 65535) return err::bad_value;
            break;
        }
        case Word::P:
        case Word::C1:
        case Word::C2:
            write_counter(w, d, now);
            return 0;
        case Word::ST:
            stall_flag_ = stall_told_ = false;
            return 0;
        case Word::FS:
            index_offset_ = d;
            return 0;
        case Word::RD: {
            if (phase_ != Phase::rest) return err::reverse_moving;
            const Kept k = keep(now);
            set(w, d);
            put_back(k, now);
            return 0;
        }
        case Word::DE:
            if (v == 0 && setting(Word::DE) != 0) {
                const bool owes = (hmt_mode() == 1 || hmt_mode() == 2) && std::abs(lag(now)) >= 1;
                aborted_ = true;
                freeze(now);
                resync(now);
                if (owes) raise(err::makeup_disabled);
            }
            if (v != 0 && supply_.over_temperature) return err::hot;
            set(w, d);
            if (v != 0) {
                maintain(now);
                jog(now);
            }
            return 0;
        case Word::SA: {
            const auto angle = std::ranges::find_if(step_angles, [&](double a) { return std::abs(a - n.as_double()) < 1e-9; });
            if (angle == step_angles.end() || phase_ != Phase::rest) return err::bad_value;
            const Kept k = keep(now);
            set(w, *angle);
            put_back(k, now);
            return 0;
        }
        case Word::EL: {
            if (phase_ != Phase::rest) return err::bad_value;
            if (encoder_mode() && d * 8 / (360.0 / setting(Word::SA)) > setting(Word::MS)) return err::bad_ratio;
            const Kept k = keep(now);
            set(w, d);
            put_back(k, now);
            return 0;
        }
        case Word::MF:
            if (v < 92 || d > top_turns_per_second * 51200) return err::makeup_out;
            break;
        case Word::TS:
            if (v < 46512) return err::bad_value;
            if (d > speed_limit()) return err::too_large;
            break;
        case Word::O1:
        case Word::O2:
        case Word::O3:
            return outputs_.set(static_cast<std::size_t>(w) - static_cast<std::size_t>(Word::O1), v != 0);
        case Word::OT:
            return outputs_.set_all(v);
        case Word::D1:
        case Word::D2:
        case Word::D3:
        case Word::D4:
            inputs_.filter(static_cast<std::size_t>(w) - static_cast<std::size_t>(Word::D1), static_cast<int>(v), now);
            break;
        case Word::D5:
            inputs_.analog_filter(static_cast<int>(v), now);
            break;
        default:
            break;
    }
    set(w, d);
    switch (w) {
        case Word::JE:
            jog(now);
            break;
        case Word::PM:
        case Word::DB:
        case Word::SF:
        case Word::SM:
            maintain(now);
            break;
        case Word::RC:
        case Word::TQ:
            judge_rotor(now);
            break;
        case Word::TS:
        case Word::TD:
            if (hmt_mode() == 3) {
                hmt_.torque_runs = true;
                run_torque(now);
            }
            break;
        case Word::WT:
            judge_supply(now);
            break;
        default:
            break;
    }
    return 0;
}

void Motor::factory(Instant now) {
    advance(now);
    if (phase_ != Phase::rest) freeze(now);
    const Kept k = keep(now);
    defaults();
    inputs_.factory(now);
    outputs_.factory();
    soft_limit_ = {};
    soft_on_ = {};
    te_ = 0;
    command_ = Profile::rest(std::round(k.c1));
    slip_ = 0;
    held_at_ = command_.end_position();
    put_back(k, now);
    for (Cam& c : cams_)
        c.was = false;
    judge_cams(now);
    replan(now);
}

void Motor::save(NonVolatile& m) const {
    for (const Default& d : saved) {
        if (available(d.word) != 0) continue;
        const std::string name(text_of(d.word));
        m[name] = d.word == Word::SA ? Value{setting(d.word)} : Value{whole(d.word)};
    }
    if (available(Word::FS) == 0) m["FS"] = Value{std::int64_t{std::llround(index_offset_)}};
    inputs_.save(m);
    outputs_.save(m);
    for (std::size_t i = 0; i < 2; ++i) {
        m["LS." + std::to_string(i) + ".position"] = Value{std::int64_t{std::llround(soft_limit_[i])}};
        m["LS." + std::to_string(i) + ".on"] = Value{std::int64_t{soft_on_[i] ? 1 : 0}};
    }
}

/// Power-up and IP. Torque mode comes back without motion: the drive starts it only when AS, TS or TD is written.
void Motor::load(const NonVolatile& m, Instant now) {
    advance(now);
    if (phase_ != Phase::rest) freeze(now);
    const Kept k = keep(now);
    const double p = std::round(position(now).position);
    const bool counted = encoder_mode();
    for (const Default& d : saved) {
        const auto it = m.find(std::string(text_of(d.word)));
        if (it == m.end() || available(d.word) != 0) continue;
        const auto v = as_number(it->second);
        const WordInfo& i = info(d.word);
        if (v && std::isfinite(*v) && (!i.ranged || (*v >= i.min && *v <= i.max))) set(d.word, *v);
    }
    // A memory that was edited by hand must not stop the arithmetic.
    if (!(setting(Word::SA) > 0)) set(Word::SA, 1.8);
    if (setting(Word::MS) < 1) set(Word::MS, 256);
    const auto integer = [&](const std::string& name, std::int64_t fallback) {
        const auto it = m.find(name);
        return it == m.end() ? fallback : as_integer(it->second).value_or(fallback);
    };
    index_offset_ = static_cast<double>(std::clamp<std::int64_t>(integer("FS", std::llround(index_offset_)), -25600, 25600));
    for (std::size_t n = 0; n < 4; ++n)
        inputs_.filter(n, static_cast<int>(whole(nth(Word::D1, static_cast<int>(n)))), now);
    inputs_.load(m, now);
    inputs_.analog_filter(static_cast<int>(whole(Word::D5)), now);
    outputs_.load(m);
    for (std::size_t i = 0; i < 2; ++i) {
        soft_limit_[i] = static_cast<double>(integer("LS." + std::to_string(i) + ".position", std::llround(soft_limit_[i])));
        soft_on_[i] = integer("LS." + std::to_string(i) + ".on", soft_on_[i] ? 1 : 0) == 1;
    }
    hmt_.torque_runs = false;
    command_ = Profile::rest(encoder_mode() == counted ? p : std::round(encoder_mode() ? k.c2 : k.c1));
    slip_ = 0;
    held_at_ = command_.end_position();
    put_back(k, now);
    for (Cam& c : cams_)
        c.was = false;
    judge_cams(now);
    replan(now);
}

}  // namespace axisgate::mcode::twin
