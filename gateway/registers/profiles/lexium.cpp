// Settings are kept and used by the next motion, as A, D and VM in the drive; instructions become commands, whose clients wait for the
// axis. An instruction that the axis cannot carry out is refused with "not in this product".
#include "gateway/registers/profiles/lexium.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gateway/axis/cia402.hpp"

namespace axisgate::registers {
namespace {
constexpr std::uint16_t latched = 1u << 0;  // of register 23
}

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
        said_.push_back(false);
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
    if (meaning != Meaning::move_velocity && (moves(meaning) || meaning == Meaning::enable)) ordered_speed_ = 0;
    const auto give = [&](CommandBody body) { order(plan, 0, std::move(body), 0, Answer::client); };
    switch (meaning) {
        case Meaning::move_absolute:
            return give(move(Move::Kind::absolute, n));
        case Meaning::move_relative:
            return give(move(Move::Kind::relative, n));
        case Meaning::move_velocity:
            if (n != 0 && turns_at(n)) return;
            ordered_speed_ = n;
            ordered_at_ = now();
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
    look_for_a_stop();
    received_ = received_ || flag(0, flag_online) != 0;
    acting_.clear();
    for (const Written& w : rows) {
        if (!is_held(w)) acting_.push_back(w);
    }
    const bool held = acting_.size() != rows.size();
    const bool fresh = std::ranges::any_of(acting_, [&](const Written& w) {
        const Meaning m = meanings_[w.row];
        return w.bits != 0 && w.bits != values_[w.row] && (moves(m) || m == Meaning::enable);
    });
    for (const Written& w : rows) {  // settings first, so that settings in the same request apply to the motion
        values_[w.row] = w.bits;
        said_[w.row] = true;
    }
    for (const Written& w : acting_) {
        instruct(w, meanings_[w.row], plan);
        if (meanings_[w.row] == Meaning::error) error_ = 0;
        if (meanings_[w.row] == Meaning::move_velocity) run_ = number_of(language().rows[w.row].type, w.bits);
    }
    if (held && !std::exchange(held_told_, true)) {
        error_ = language().error_of(Reason::wrong_state);
        (void)refused(
            0, Reason::wrong_state,
            fmt::format("axis {}: somebody else has stopped it: what is merely repeated begins nothing; write another value, or DE "
                        "as 0 and then as 1",
                        axis(0).name));
    }
    if (fresh) held_ = held_told_ = unheard_ = false;
    return Verdict::good;
}

bool LexiumMap::moves(Meaning m) noexcept {
    return m == Meaning::move_absolute || m == Meaning::move_relative || m == Meaning::move_velocity || m == Meaning::home ||
           m == Meaning::home_index;
}

/// True if the axis turns at this speed already, or was ordered to and does not move yet. An axis that cannot change its speed while moving
/// would stop and start at each write of a controller that repeats it.
bool LexiumMap::turns_at(double counts) const {
    constexpr Duration begins_within = std::chrono::seconds(1);
    if (counts == ordered_speed_ && now() - ordered_at_ < begins_within) return true;
    return flag(0, flag_moving) && picture(0).mode_display == cia402::mode_profile_velocity &&
           picture(0).target_velocity == increments(0, counts);
}

/// The motion of an axis that moved before its client wrote anything belongs to no client: the first words of the client may be as old as
/// that motion. Words that were written while another drive, channel or twin served the axis are not valid for this one.
void LexiumMap::look_for_a_stop() noexcept {
    const bool found_moving = !received_ && flag(0, flag_online) && flag(0, flag_moving);
    const bool another = picture(0).current && source_ != 0 && picture(0).source != source_;
    if (picture(0).current) source_ = picture(0).source;
    if ((picture(0).stop_latch & latched) == 0 && !found_moving && !another) return;
    if (!std::exchange(held_, true)) unheard_ = !received_;
}

/// True for an instruction that would move the axis or switch it on, and repeats an earlier one. Instructions that stop or switch off are
/// never held.
bool LexiumMap::is_held(const Written& w) const {
    const Meaning m = meanings_[w.row];
    const bool stops = (m == Meaning::move_velocity || m == Meaning::enable) && w.bits == 0;
    return held_ && !stops && (moves(m) || m == Meaning::enable) && (w.bits == values_[w.row] || (unheard_ && !said_[w.row]));
}

/// Settings count from the first image on. Instructions and a set position count when they change. Instructions that stop or switch off
/// count at once, because earlier orders to the axis are not known here.
void LexiumMap::adopted(std::span<const Written> rows, WritePlan& plan) {
    received_ = received_ || flag(0, flag_online) != 0;
    for (const Written& w : rows) {
        if (const Meaning m = meanings_[w.row]; moves(m) || m == Meaning::enable) {
            values_[w.row] = w.bits;
            said_[w.row] = true;
        }
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
    if (good(result)) return;
    error_ = language().error_of(result.reason);
    ordered_speed_ = 0;  // no order is assumed to be in progress
}

}  // namespace axisgate::registers
