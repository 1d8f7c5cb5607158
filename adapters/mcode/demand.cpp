// AxisDemand, the rules: which words move, renumber or rescale, and when a reading proves that somebody else does. [Lnnn]: the maker's
// reference. In: lines, readings. Out: a demand, or none with its reason in the code beside it. Never takes a mismatch for a following
// error where another order than this gateway's may be the reason: then nobody knows.
#include "adapters/mcode/demand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "adapters/mcode/wire.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

namespace {
/// Reckoning and drive may be apart by so much time: latency of the line, the drive's own clock.
constexpr Duration margin = 100ms;

bool any_of(std::string_view word, std::span<const std::string_view> words) { return std::ranges::find(words, word) != words.end(); }

/// They move the axis, renumber it, or change what its units are.
constexpr std::array<std::string_view, 20> disturbing{"MR", "HM", "HI", "HF", "SC", "EX", "PS", "RS", "JE", "FL",
                                                      "PM", "RD", "AS", "EE", "MS", "EL", "C1", "IP", "FD", "ESC"};
constexpr std::array<std::string_view, 4> shaping{"AT", "DT", "BE", "IP"};

/// The only field of "MA 100" or "VM=100"; nothing: there is another, or it is no plain number.
std::optional<std::int64_t> field_of(std::string_view line) {
    const auto at = line.find_first_of(" =");
    if (at == std::string_view::npos) return std::nullopt;
    return parse_whole(trimmed(line.substr(at + 1)), INT64_MIN, INT64_MAX);
}

/// P counts in 32 bits and rolls over [L1866]: the demand is told beside it.
std::int64_t beside(std::int64_t position, double demand) noexcept {
    constexpr double round = 4294967296.0;
    const double off = demand - static_cast<double>(position);
    return position + std::llround(off - round * std::round(off / round));
}
}  // namespace

void AxisDemand::knows(const Values& v) noexcept {
    if (v.encoder != values_.encoder) {
        forget();
        plain_.reset();
    }
    values_ = v;
}

void AxisDemand::value(std::string_view word, std::int64_t v) noexcept {
    if (word == "VI") values_.vi = v;
    if (word == "VM") values_.vm = v;
    if (word == "A") values_.a = v;
    if (word == "D") values_.d = v;
}

DemandRamps AxisDemand::ramps() const noexcept {
    return {static_cast<double>(values_.a), static_cast<double>(values_.d), static_cast<double>(values_.vi)};
}

void AxisDemand::published(std::string_view line, Instant at, bool own) {
    before_ = Before{demand_, values_, plain_, still_};
    const std::string word = word_of(line);
    order(word, field_of(line), at, own);
    if (any_of(word, shaping)) plain_.reset();
}

void AxisDemand::doubt(std::string_view line) {
    before_.reset();
    const std::string word = word_of(line);
    value(word, 0);
    if (any_of(word, shaping)) plain_.reset();
    if (any_of(word, disturbing) || word == "MA" || word == "SL" || word == "P" || word == "C2" || word == "DE") forget();
}

void AxisDemand::withdraw() noexcept {
    if (!before_) return;
    demand_ = before_->demand;
    values_ = before_->values;
    plain_ = before_->plain;
    still_ = before_->still;
    before_.reset();
}

void AxisDemand::ended(Instant now) noexcept {
    if (demand_.known() && !demand_.over(now)) forget();
}

void AxisDemand::order(std::string_view word, std::optional<std::int64_t> number, Instant at, bool own) noexcept {
    if (word == "EE" || word == "AS" || word == "MS")
        values_ = {0, 0, 0, 0, word == "EE" ? number == 1 : values_.encoder};  // scaled [L4293]
    if (any_of(word, disturbing) || (word == "DE" && number != 1)) return forget();
    if (word == "IC" || word == "DC") {
        values_.vi = values_.vm = values_.a = values_.d = 0;  // which one it counts up is read anew
        return forget();
    }
    value(word, number.value_or(0));
    if (word == "P" || word == "C2") {
        // C2 supplies P with EE = 1 [L1906].
        if (!still_ || !number) return forget();
        position_ = *number;
        return demand_.rest(static_cast<double>(*number));
    }
    if (word != "MA" && word != "SL") return;
    ordered_ = true;
    stall_is_new_ = false;
    strange_ = 0;
    // A motion from rest begins where the encoder says that the axis is; one out of a motion goes on from what it has done so far.
    if (still_ && (!demand_.known() || demand_.over(at))) demand_.rest(static_cast<double>(position_));
    const bool computes = demand_.known() && values_.encoder && values_.vi > 0 && values_.d > 0 && plain_.value_or(false);
    if (!own || !number || !computes) return forget();
    if (word == "SL" && *number == 0) return demand_.stop(at, ramps());  // D, down to VI [L861, L4110]
    still_ = false;
    if (values_.a <= 0) return forget();
    if (word == "SL") return demand_.run(at, static_cast<double>(*number), ramps());  // VM does not bound it [L5404]
    if (values_.vm <= 0) return forget();
    demand_.move(at, static_cast<double>(*number), static_cast<double>(values_.vm), ramps());
}

/// V is the speed that the drive gives its motor: not this order's, some time around now. At rest a correction at VI towards the demand is
/// the drive's own [L4825, L7360].
bool AxisDemand::strange(const Reading& r) const noexcept {
    if (!r.moving || r.velocity == 0) return false;
    const auto speeds = {demand_.at(r.at - margin).velocity, demand_.at(r.at).velocity, demand_.at(r.at + margin).velocity};
    const double low = std::min(speeds), high = std::max(speeds), v = static_cast<double>(r.velocity);
    const double slack = static_cast<double>(std::max<std::int64_t>(values_.vi, 1)) + 0.1 * std::max(std::abs(low), std::abs(high));
    if (v < low - slack || v > high + slack) return true;
    const double off = demand_.at(r.at).position - static_cast<double>(r.position);
    return demand_.over(r.at - margin) && off * v <= 0;
}

void AxisDemand::judge(const Reading& r) noexcept {
    if (!demand_.known()) return;
    if (r.program) return forget();
    strange_ = strange(r) ? strange_ + 1 : 0;
    if (strange_ >= 2) return forget();
    // It stands, and the order is not over: a limit, a stall (SM = 0), an input, somebody else.
    const bool stalls = stall_is_new_ && r.velocity == 0;
    if ((!r.moving || stalls) && !demand_.over(r.at + margin)) return forget();
    // MV rose without an order, and what it was is over already: a correction has come nearer, anything else has not.
    if (r.moving && !moving_ && !ordered_ && r.velocity == 0) {
        const double d = demand_.at(r.at).position;
        if (std::abs(d - static_cast<double>(r.position)) > std::abs(d - static_cast<double>(position_)) + 1) forget();
    }
}

void AxisDemand::read(const Reading& r, AxisFeedback& fb) noexcept {
    if (r.velocity != 0) way_ = r.velocity < 0 ? -1 : 1;
    stall_is_new_ = r.stalled && (stall_is_new_ || !stalled_);
    stalled_ = r.stalled;
    fb.demand_source = DemandSource::none;
    fb.position_demand = r.position;
    // EE = 1 acts with AS = 0 only [E-25].
    const bool reckons = r.energised && values_.encoder && r.hmt == 0;
    if (!reckons) forget();
    if (reckons) judge(r);
    still_ = r.energised && !r.moving && !r.changing && r.velocity == 0;
    moving_ = r.moving;
    position_ = r.position;
    ordered_ = false;
    if (!r.energised || r.hmt == 3) return;
    if (reckons) {
        if (!demand_.known() && still_ && !r.program && !r.homing && !r.stalled) demand_.rest(static_cast<double>(r.position));
        if (!demand_.known()) return;
        fb.demand_source = DemandSource::computed;
        fb.position_demand = beside(r.position, demand_.at(r.at).position);
    } else if (r.hmt == 0) {
        fb.demand_source = DemandSource::open_loop;
    } else if (r.lag) {
        // LL: commanded pulses less steps made [L7470, L7516], positive when the rotor is behind [L3868]: behind is against the motion.
        fb.demand_source = DemandSource::drive;
        fb.position_demand = r.position + way_ * *r.lag;
    }
}

}  // namespace axisgate::mcode
