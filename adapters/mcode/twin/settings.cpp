// Settings: their factory figures, their place in the memory, ramps and the highest speed.
// In: words. Out: figures in the unit of P.
// Never reads a place or an instant.
#include "adapters/mcode/twin/settings.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

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

}  // namespace

void Settings::factory() noexcept {
    const double index_offset = (*this)[Word::FS];
    values_.fill(0);
    for (const Default& d : saved)
        set(d.word, d.value);
    set(Word::FS, index_offset);
}

void Settings::unit_defaults() noexcept {
    const double scale = encoder_mode() ? counts_per_turn() / 4000 : 1;
    set(Word::VI, encoder_mode() ? std::max(1.0, std::round(78 * scale)) : 1000);
    set(Word::VM, encoder_mode() ? std::round(60000 * scale) : 768000);
    set(Word::A, encoder_mode() ? std::round(78125 * scale) : 1000000);
    set(Word::D, (*this)[Word::A]);
}

void Settings::save(NonVolatile& m) const {
    for (const Default& d : saved) {
        if (available(d.word) != 0) continue;
        const std::string name(text_of(d.word));
        m[name] = d.word == Word::SA ? Value{(*this)[d.word]} : Value{whole(d.word)};
    }
    if (available(Word::FS) == 0) m["FS"] = Value{whole(Word::FS)};
}

void Settings::load(const NonVolatile& m) {
    for (const Default& d : saved) {
        const auto it = m.find(std::string(text_of(d.word)));
        if (it == m.end() || available(d.word) != 0) continue;
        const auto v = as_number(it->second);
        const WordInfo& i = info(d.word);
        if (v && std::isfinite(*v) && (!i.ranged || (*v >= i.min && *v <= i.max))) set(d.word, *v);
    }
    // A memory that was edited by hand must not stop the arithmetic.
    if (!((*this)[Word::SA] > 0)) set(Word::SA, 1.8);
    if ((*this)[Word::MS] < 1) set(Word::MS, 256);
    set(Word::FS, static_cast<double>(std::clamp<std::int64_t>(integer_in(m, "FS", whole(Word::FS)), -25600, 25600)));
}

int Settings::available(Word w) const noexcept {
    if (!is(info(w).products)) return err::not_available;
    if (setup_.frame_size == 17) {
        if (w == Word::O1 || w == Word::O2 || w == Word::FC || w == Word::I4 || w == Word::D4) return err::not_available;
    }
    return 0;
}

Kinematics Settings::kinematics() const noexcept {
    const auto integer = [&](Word w) { return static_cast<int>(whole(w)); };
    Kinematics k;
    k.vi = creep_speed();
    k.vm = std::max(1.0, (*this)[Word::VM]);
    k.up = {integer(Word::AT), integer(Word::AJ), std::max(1.0, (*this)[Word::A])};
    k.down = {integer(Word::DT), integer(Word::DJ), std::max(1.0, (*this)[Word::D])};
    return k;
}

double Settings::creep_speed() const noexcept { return std::max(1.0, (*this)[Word::VI]); }

double Settings::speed_limit() const noexcept {
    return encoder_mode() ? top_turns_per_second * counts_per_turn() : 10000.0 * (*this)[Word::MS];
}

}  // namespace axisgate::mcode::twin
