// Lexium: settings are kept and go with the next motion, as A, D and VM do in the drive; instructions become commands.
// In: rows. Out: commands, whose clients wait for the axis behind. What the axis behind has not is refused with "not in this product".
#include "gateway/registers/profiles/lexium.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gateway/axis/cia402.hpp"

namespace axisgate::registers {

LexiumMap::Meaning LexiumMap::meaning_of(const LanguageRow& row) {
    using enum Meaning;
    constexpr std::array<std::pair<std::string_view, Meaning>, 20> names{{{"acceleration", acceleration},
                                                                          {"deceleration", deceleration},
                                                                          {"maximum_velocity", maximum_velocity},
                                                                          {"velocity", velocity},
                                                                          {"position", position},
                                                                          {"counter", counter},
                                                                          {"moving", moving},
                                                                          {"moving_to_position", moving_to_position},
                                                                          {"enable", enable},
                                                                          {"error_flag", error_flag},
                                                                          {"error", error},
                                                                          {"move_absolute", move_absolute},
                                                                          {"move_relative", move_relative},
                                                                          {"move_velocity", move_velocity},
                                                                          {"home", home},
                                                                          {"home_index", home_index},
                                                                          {"nothing", nothing},
                                                                          {"kept", kept},
                                                                          {"fixed", fixed},
                                                                          {"none", none}}};
    const auto it = std::ranges::find(names, row.meaning, &std::pair<std::string_view, Meaning>::first);
    return it == names.end() ? none : it->second;
}

LexiumMap::LexiumMap(const DoorPort& port, Setup setup) : ProfileMap(port, std::move(setup)) {
    const auto& rows = language().rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        meanings_.push_back(meaning_of(rows[i]));
        double initial = rows[i].initial;
        if (meanings_[i] == Meaning::acceleration || meanings_[i] == Meaning::deceleration)
            initial = axis(0).acceleration.value_or(initial);
        if (meanings_[i] == Meaning::maximum_velocity) initial = axis(0).velocity.value_or(initial);
        values_.push_back(bits_of(rows[i].type, initial));
        if (meanings_[i] == Meaning::acceleration) acceleration_ = i;
        if (meanings_[i] == Meaning::deceleration) deceleration_ = i;
        if (meanings_[i] == Meaning::maximum_velocity) maximum_velocity_ = i;
    }
}

int LexiumMap::error() const { return error_ != 0 ? error_ : flag(0, flag_fault) ? language().error_of("fault") : 0; }

bool LexiumMap::shown(std::size_t row, Instant, std::uint32_t& bits) {
    const MapType type = language().rows[row].type;
    const auto show = [&](double n) {
        bits = bits_of(type, n);
        return true;
    };
    switch (meanings_[row]) {
        case Meaning::velocity:
            return show(velocity(0));
        case Meaning::position:
        case Meaning::counter:
            return show(position(0));
        case Meaning::moving:
            return show(flag(0, flag_moving));
        case Meaning::moving_to_position:
            return show(flag(0, flag_moving) && picture(0).mode_display == cia402::mode_profile_position);
        case Meaning::enable:
            return show(enabled(0));
        case Meaning::error_flag:
            return show(error() != 0);
        case Meaning::error:
            return show(error());
        case Meaning::move_velocity:
            return show(run_);
        case Meaning::none:
            return false;
        default:
            bits = values_[row];
            return true;
    }
}

Verdict LexiumMap::refuse_with(Reason reason, std::string text) {
    error_ = language().error_of(reason);
    return refused(0, reason, std::move(text));
}

Move LexiumMap::move(Move::Kind kind, double counts) const {
    const auto setting = [&](std::size_t row) { return positive_increments(0, number_of(language().rows[row].type, values_[row])); };
    Move m;
    m.kind = kind;
    m.target = increments(0, counts);
    if (kind != Move::Kind::velocity) m.velocity = setting(maximum_velocity_);
    m.acceleration = setting(acceleration_);
    m.deceleration = setting(deceleration_);
    return m;
}

void LexiumMap::instruct(const Written& w, Meaning meaning, WritePlan& plan) {
    const LanguageRow& row = language().rows[w.row];
    const double n = number_of(row.type, w.bits);
    const auto give = [&](CommandBody body) { order(plan, 0, std::move(body), 0, Answer::client); };
    switch (meaning) {
        case Meaning::move_absolute:
            return give(move(Move::Kind::absolute, n));
        case Meaning::move_relative:
            return give(move(Move::Kind::relative, n));
        case Meaning::move_velocity:
            return n == 0 ? give(Halt{}) : give(move(Move::Kind::velocity, n));
        case Meaning::home: {
            constexpr std::array<std::int16_t, 4> methods{21, 22, 19, 20};
            return give(Home{methods[static_cast<std::size_t>(n) - 1]});
        }
        case Meaning::home_index:
            return give(Home{static_cast<std::int16_t>(n == 1 ? 33 : 34)});
        case Meaning::position:
            return give(SetPosition{increments(0, n)});
        case Meaning::enable:
            return n != 0 ? give(Enable{}) : give(Disable{});
        case Meaning::error:
            if (flag(0, flag_fault)) give(ResetFault{});
            return;
        default:
            return;
    }
}

Verdict LexiumMap::taken(std::span<const Written> rows, WritePlan& plan) {
    for (const Written& w : rows) {
        const LanguageRow& row = language().rows[w.row];
        const Meaning meaning = meanings_[w.row];
        if (meaning == Meaning::none)
            return refuse_with(Reason::not_supported, fmt::format("axis {}: {}", axis(0).name, row.name + ": " + row.description));
        if (const double n = number_of(row.type, w.bits); meaning == Meaning::home_index && n != 1 && n != 3)
            return refuse_with(Reason::not_supported, fmt::format("axis {}: HI {}: 1 and 3 search the index", axis(0).name, n));
        if (meaning == Meaning::fixed && w.bits != values_[w.row])
            return refuse_with(Reason::out_of_range,
                               fmt::format("axis {}: {} can only be {} here", axis(0).name, row.name, number_of(row.type, values_[w.row])));
    }
    for (const Written& w : rows)  // settings first, so that what stands beside them in one request moves with them
        values_[w.row] = w.bits;
    for (const Written& w : rows) {
        instruct(w, meanings_[w.row], plan);
        if (meanings_[w.row] == Meaning::error) error_ = 0;
        if (meanings_[w.row] == Meaning::move_velocity) run_ = number_of(language().rows[w.row].type, w.bits);
    }
    return Verdict::good;
}

/// Settings count from the first image on; instructions, and what the position is called, count when they change. What stops or switches
/// off counts at once: what the axis was told before is not known here.
void LexiumMap::adopted(std::span<const Written> rows, WritePlan& plan) {
    for (const Written& w : rows) {
        switch (meanings_[w.row]) {
            case Meaning::enable:
                if (w.bits == 0 && enabled(0)) order(plan, 0, Disable{}, 0, Answer::client);
                break;
            case Meaning::move_velocity:
                run_ = 0;
                if (w.bits == 0 && flag(0, flag_moving) && picture(0).mode_display == cia402::mode_profile_velocity)
                    order(plan, 0, Halt{}, 0, Answer::client);
                break;
            case Meaning::acceleration:
            case Meaning::deceleration:
            case Meaning::maximum_velocity:
            case Meaning::kept:
                values_[w.row] = w.bits;
                break;
            default:
                break;
        }
    }
}

void LexiumMap::out_of_range() { error_ = language().error_of(Reason::out_of_range); }

void LexiumMap::on_own_result(std::uint32_t, const Result& result) {
    if (!good(result)) error_ = language().error_of(result.reason);
}

}  // namespace axisgate::registers
