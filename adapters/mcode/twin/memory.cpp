// Device: RAM against non-volatile memory.
// In: S, IP, FD, power, CTRL+C. Out: the drive's memory under its own names.
// Never saves by itself: what is not saved by S is gone with the power [L5259].
#include <algorithm>
#include <charconv>

#include "adapters/mcode/twin/device.hpp"
#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {

void Device::factory_state(bool as_delivered) {
    program_.clear(true);
    run_.stop();
    for (std::size_t i = 0; i < 4; ++i)
        run_.integer(i) = 0;
    for (std::size_t i = 0; i < 8; ++i)
        run_.real(i) = 0;
    comm_.flags = LinkFlags{};
    comm_.flags.py = address_input_;
    bd_ = 96;
    for (const int code : rate_codes) {
        // A drive comes set to the rate of its line; FD gives it the factory's, for its next start [L1594, L2884].
        if (as_delivered && setup_.bit_rate == rate_of_code(code)) bd_ = code;
    }
    if (as_delivered && setup_.name != '!') {
        comm_.flags.dn = setup_.name;
        comm_.flags.py = true;
    }
    if (as_delivered) {
        comm_.flags.em = setup_.manners.delivered_em;
        if (!setup_.ethernet) comm_.flags.ck = setup_.manners.delivered_ck;
        load_chatter(setup_.manners, program_);
    }
    comm_.restart();
    lk_ = lk_saved_ = false;
    ne_ = false;
    radians_ = true;
    format_ = {};
    format_.pad = setup_.pad || setup_.manners.number_form >= 1;
    format_.sign_blank = setup_.manners.number_form == 2;
    on_error_.reset();
    tracer_.clear_break();
    trips_.clear();
    awaited_.forget();
    awaited_.drop();
    motor_->factory(now_);
}

void Device::keep() {
    NonVolatile m;
    motor_->save(m);
    const LinkFlags& f = comm_.flags;
    const auto put = [&](const char* name, std::int64_t v) { m[name] = Value{v}; };
    put("BD", bd_);
    put("CE", f.ce);
    put("CK", f.ck);
    put("DG", f.dg ? 1 : 0);
    put("EM", f.em);
    put("ES", f.es);
    put("LK", lk_ ? 1 : 0);
    put("NE", ne_ ? 1 : 0);
    put("PY", f.py ? 1 : 0);
    put("QD", f.qd ? 1 : 0);
    put("RA", radians_ ? 1 : 0);
    m["DN"] = Value{std::string(1, f.dn)};
    put("PF.1", format_.width);
    put("PF.2", format_.decimals);
    put("PF.3", format_.scientific ? 1 : 0);
    put("PF.4", format_.left ? 1 : 0);
    for (std::size_t i = 0; i < pw_.size(); ++i)
        m["PW." + std::to_string(i + 1)] = Value{pw_[i]};
    for (std::size_t i = 0; i < 4; ++i)
        m["R" + std::to_string(i + 1)] = Value{std::int64_t{run_.integer(i)}};
    for (std::size_t i = 0; i < 8; ++i)
        m["F" + std::to_string(i + 1)] = Value{run_.real(i)};
    for (std::size_t i = 0; i < program_.symbols().size(); ++i) {
        const Symbol& s = program_.symbols().at(static_cast<SymbolId>(i));
        if (s.kind == Symbol::Kind::global) m["VA." + s.name] = Value{std::int64_t{s.value}};
    }
    m["PG"] = Value{program_.text()};
    nvm_ = std::move(m);
    ++nvm_revision_;
}

/// `programs`: as at power-up; without: IP, which keeps programs and declarations and takes back their saved values [L3468].
void Device::restore(const NonVolatile& memory, bool programs) {
    if (memory.empty()) return;
    LinkFlags& f = comm_.flags;
    bd_ = static_cast<int>(integer_in(memory, "BD", bd_));
    f.ce = static_cast<int>(std::clamp<std::int64_t>(integer_in(memory, "CE", f.ce), 0, 2));
    f.ck = static_cast<int>(std::clamp<std::int64_t>(integer_in(memory, "CK", f.ck), 0, 2));
    f.dg = integer_in(memory, "DG", f.dg) != 0;
    f.em = static_cast<int>(std::clamp<std::int64_t>(integer_in(memory, "EM", f.em), 0, 3));
    f.es = static_cast<int>(std::clamp<std::int64_t>(integer_in(memory, "ES", f.es), 0, 3));
    f.py = integer_in(memory, "PY", f.py) != 0 || address_input_;
    f.qd = integer_in(memory, "QD", f.qd) != 0;
    if (const auto it = memory.find("DN"); it != memory.end()) {
        if (const auto* text = std::get_if<std::string>(&it->second); text != nullptr && text->size() == 1) f.dn = (*text)[0];
    }
    lk_ = lk_saved_ = integer_in(memory, "LK", lk_) != 0;
    ne_ = integer_in(memory, "NE", ne_) != 0;
    radians_ = integer_in(memory, "RA", radians_) != 0;
    format_.width = static_cast<int>(std::clamp<std::int64_t>(integer_in(memory, "PF.1", format_.width), 0, 16));
    format_.decimals = static_cast<int>(std::clamp<std::int64_t>(integer_in(memory, "PF.2", format_.decimals), 0, 16));
    format_.scientific = integer_in(memory, "PF.3", format_.scientific) != 0;
    format_.left = integer_in(memory, "PF.4", format_.left) != 0;
    for (std::size_t i = 0; i < pw_.size(); ++i)
        pw_[i] = integer_in(memory, "PW." + std::to_string(i + 1), pw_[i]);
    for (std::size_t i = 0; i < 4; ++i)
        run_.integer(i) =
            static_cast<std::int32_t>(std::clamp<std::int64_t>(integer_in(memory, "R" + std::to_string(i + 1), 0), -INT32_MAX, INT32_MAX));
    for (std::size_t i = 0; i < 8; ++i) {
        const auto it = memory.find("F" + std::to_string(i + 1));
        run_.real(i) = it == memory.end() ? 0.0 : as_number(it->second).value_or(0.0);
    }
    if (programs) program_.clear(true);
    for (const auto& [name, value] : memory) {
        if (!name.starts_with("VA.") || !Symbols::well_formed(std::string_view(name).substr(3), 2)) continue;
        const SymbolId id = program_.symbols().mention(std::string_view(name).substr(3));
        if (id == no_symbol) continue;
        if (program_.symbols().at(id).kind == Symbol::Kind::unknown) (void)program_.symbols().define(id, Symbol::Kind::global);
        (void)run_.store(id, Number::of(as_integer(value).value_or(0)));
    }
    if (programs) {
        if (const auto it = memory.find("PG"); it != memory.end()) {
            if (const auto* text = std::get_if<std::string>(&it->second)) program_.load(*text);
        }
    }
    motor_->load(memory, now_);
}

/// Power-up and CTRL+C: what was not saved is lost, then the label SU runs [L862].
void Device::boot() {
    waiting_.clear();
    command_due_ = never;
    pace_.restart(now_);
    stop_program();
    program_mode_.leave();
    announce_ = false;
    upgrading_ = false;
    tx_.restart(now_);
    error_ = {};
    motor_->restart(now_);
    factory_state(true);
    restore(nvm_, true);
    comm_.restart();
    active_rate_ = rate_of_code(bd_);
    tx_.say(sign_on(setup_.manners, comm_.flags, setup_.ethernet), now_);
    const SymbolId start = program_.symbols().find("SU");
    if (start != no_symbol && program_.symbols().at(start).kind == Symbol::Kind::label) {
        Target t;
        t.label = start;
        t.given = true;
        (void)run_program(t, Tracer::Mode::normal);
    }
}

void Device::power_on(const NonVolatile& memory, Instant now, Out& out) {
    now_ = std::max(now_, now);
    nvm_ = memory;
    powered_ = true;
    pw_ = {};
    boot();
    settle(out);
}

TwinMechanics Device::mechanics(int, Instant now) const { return motor_->mechanics(std::max(now, now_)); }

}  // namespace axisgate::mcode::twin
