// Numbering: how the frame changes with the settings.
// In: values. Out: the shaft where it was, under other numbers.
// Never changes the unit in motion.
#include "adapters/mcode/twin/numbering.hpp"

#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
constexpr std::array microsteps{1, 2, 4, 5, 8, 10, 16, 25, 32, 50, 64, 100, 108, 125, 127, 128, 180, 200, 250, 256};
constexpr std::array step_angles{0.45, 0.72, 0.9, 1.8, 1.875, 2.0, 2.5, 3.6, 5.0};

}  // namespace

std::optional<int> Numbering::write(Word w, const Number& n, Instant now) {
    const std::int64_t v = n.as_integer();
    const double d = static_cast<double>(v);
    const Settings& s = p_.settings;
    switch (w) {
        case Word::MS:
            return set_microsteps(v, now);
        case Word::EE:
            return set_encoder_mode(v != 0, now);
        case Word::AS:
            return set_hmt_mode(v, now);
        case Word::P:
            shift(d - nearest(p_.shaft.shown_position(now).position));
            return 0;
        case Word::C1: {
            const double by = d - nearest(p_.shaft.c1(now));
            if (!s.feedback()) shift(by);  // C1 supplies P [L1849]
            p_.shaft.add_c1(by);
            return 0;
        }
        case Word::C2: {
            const double by = d - nearest(p_.shaft.c2(now));
            if (s.encoder_mode()) shift(by);  // C2 supplies P [L1906]
            p_.shaft.add_c2(by);
            return 0;
        }
        case Word::RD:
            return course_.rests() ? scale(w, d, now) : err::reverse_moving;
        case Word::SA: {
            const auto angle = std::ranges::find_if(step_angles, [&](double a) { return std::abs(a - n.as_double()) < 1e-9; });
            return angle == step_angles.end() || !course_.rests() ? err::bad_value : scale(w, *angle, now);
        }
        case Word::EL:
            if (!course_.rests()) return err::bad_value;
            if (s.encoder_mode() && d * 8 / (360.0 / s[Word::SA]) > s[Word::MS]) return err::bad_ratio;
            return scale(w, d, now);
        default:
            return std::nullopt;
    }
}

int Numbering::scale(Word word, double value, Instant now) {
    const Shaft::Kept k = p_.shaft.keep(now);
    p_.settings.set(word, value);
    p_.shaft.put_back(k, now);
    return 0;
}

/// Renumbers the frame; C1, C2 and the shaft stay.
void Numbering::shift(double by) noexcept {
    p_.shaft.shift(by);
    p_.trips.shift(by);
    course_.demand.shift(by);
    moves_.shift(by);
}

int Numbering::set_microsteps(std::int64_t ms, Instant now) {
    if (std::ranges::find(microsteps, ms) == microsteps.end()) return err::bad_value;
    Settings& s = p_.settings;
    const double old = s[Word::MS], wanted = static_cast<double>(ms);
    if (wanted == old) return 0;
    if (s[Word::EE] != 0) return err::wrong_type;  // locked at 256 [L7194]
    if (!course_.rests() || (s.hmt_mode() != 0 && ms < 10)) return err::bad_value;
    const Shaft::Kept k = p_.shaft.keep(now);
    s.set(Word::MS, wanted);
    for (const Word w : {Word::VI, Word::VM, Word::A, Word::D})
        s.set(w, std::round(s[w] * wanted / old));
    p_.shaft.rescale(k, now);
    return 0;
}

int Numbering::set_encoder_mode(bool on, Instant now) {
    Settings& s = p_.settings;
    if (on == (s[Word::EE] != 0)) return 0;
    // The unit of everything changes: only at rest.
    if (!course_.rests()) return err::bad_value;
    const double least = s.counts_per_turn() * 2 / (360.0 / s[Word::SA]);  // MS >= EL*8/full steps [L2624-2632]
    if (on && s.is(lmm) && s[Word::MS] < least) return err::bad_ratio;
    if (s.hmt_mode() != 0) {
        // Beside hMT it waits: motion stays in step pulses until AS is 0 [L696, L7520]. Only MS is locked at 256 already [L7194].
        const int code = on ? set_microsteps(256, now) : 0;
        if (code == 0) s.set(Word::EE, on ? 1 : 0);
        return code;
    }
    const Shaft::Kept k = p_.shaft.keep(now);
    s.set(Word::EE, on ? 1 : 0);
    change_units(k, now);
    return 0;
}

int Numbering::set_hmt_mode(std::int64_t mode, Instant now) {
    Settings& s = p_.settings;
    if (mode == s.hmt_mode() && mode != 3) return 0;
    if (!course_.rests()) return err::in_motion;
    if (mode != 0 && s[Word::MS] < 10) return err::bad_value;  // [L1480]
    if (mode == 3 && !p_.power.supply.plus_v_good()) return err::no_supply;
    const Shaft::Kept k = p_.shaft.keep(now);
    // P goes on from its number; the rotor is taken as it stands.
    const double p = std::round(p_.shaft.shown_position(now).position);
    const bool counted = s.encoder_mode();
    s.set(Word::AS, static_cast<double>(mode));
    if (s.encoder_mode() != counted) {
        change_units(k, now);
    } else {
        p_.shaft.renumber(p, k, now);
    }
    p_.loop.clear();
    p_.loop.set_torque(mode == 3);
    if (mode == 3) course_.run_torque(now);
    return 0;
}

/// Steps have become counts or the other way round: the shaft stands where it is, P is the counter of the new unit.
void Numbering::change_units(const Shaft::Kept& k, Instant now) {
    p_.settings.set(Word::MS, 256);
    p_.settings.unit_defaults();
    p_.shaft.renumber(in_present_unit(k), k, now);
}

double Numbering::in_present_unit(const Shaft::Kept& k) const noexcept { return std::round(p_.settings.encoder_mode() ? k.c2 : k.c1); }

void Numbering::factory(Instant now) {
    const Shaft::Kept k = p_.shaft.keep(now);
    p_.settings.factory();
    p_.shaft.renumber(std::round(k.c1), k, now);
}

void Numbering::load(const NonVolatile& m, Instant now) {
    const Shaft::Kept k = p_.shaft.keep(now);
    const double p = std::round(p_.shaft.shown_position(now).position);
    const bool counted = p_.settings.encoder_mode();
    p_.settings.load(m);
    p_.shaft.renumber(p_.settings.encoder_mode() == counted ? p : in_present_unit(k), k, now);
}

}  // namespace axisgate::mcode::twin
