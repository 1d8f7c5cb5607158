// Homing: the drive's own searches (HM, HI), behind which this gateway makes the place zero; and "here is home".
// In: a method of CiA 402 or of the drive. Out: lines; a homing as the axis shows it.
// Never repeats a search: it would begin where the first has ended.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

namespace {
/// The input typed as home is the switch of every method; what differs is the way to it [L3206-3210].
struct Search {
    int method;
    std::string_view line;
};
constexpr std::array searches{Search{21, "HM 1"}, Search{22, "HM 2"}, Search{19, "HM 3"}, Search{20, "HM 4"}, Search{33, "HI 1"},
                              Search{34, "HI 3"}, Search{-1, "HM 1"}, Search{-2, "HM 2"}, Search{-3, "HM 3"}, Search{-4, "HM 4"},
                              Search{-5, "HI 1"}, Search{-6, "HI 2"}, Search{-7, "HI 3"}, Search{-8, "HI 4"}};
bool is_here(int method) { return method == 35 || method == 37; }
}  // namespace

void Homing::plan(const Command& c, Turn& t) {
    int method = std::get<Home>(c.body).method;
    if (is_here(method)) {
        if (feedback().moving()) return refuse(Reason::wrong_state, fmt::format("{} moves: stop it first", name()), t);
        job().send("P=0");
        return;
    }
    if (!feedback().flags().de) return refuse(Reason::wrong_state, fmt::format("{} is off (DE=0): enable it first", name()), t);
    if (method == 0) method = std::atoi(option(drive_.setup().options, "home_method", "21").c_str());
    const auto search = std::ranges::find(searches, method, &Search::method);
    if (search == searches.end()) {
        return refuse(
            Reason::not_supported,
            fmt::format("homing method {}: {}use 19..22 (home switch, HM), 33, 34 (index, HI), 35, 37 (here is 0), -1..-4 (HM 1..4) or "
                        "-5..-8 (HI 1..4)",
                        method, method == 17 || method == 18 ? "the drive has no homing on a limit switch; " : ""),
            t);
    }
    // The search creeps with VI: not with what a slow move has left of it.
    Feedback::Values& now = feedback().values;
    if (now.vi != 0 && now.user_vi > now.vi && now.user_vi < now.vm) {
        job().send(fmt::format("VI={}", now.user_vi));
        now.vi = now.user_vi;
    }
    job().send(std::string(search->line), false);
}

void Homing::sending(Step&, Request&) { begin_ = feedback().position(); }

/// A search that was not received is not said again by itself, but told as not begun.
Verb::Proof Homing::proof(const Step& step, Duration since) const {
    const auto& flags = feedback().flags();
    if (step.text == "P=0") return std::llabs(feedback().position()) <= (feedback().encoder_mode() ? 50 : 0) ? Proof::taken : Proof::lost;
    if (step.text.starts_with("VI=")) return Proof::none;
    if (flags.mv || flags.vc || feedback().velocity() != 0 || std::llabs(feedback().position() - begin_) > 50) return Proof::taken;
    return since < shows_within ? Proof::open : Proof::lost;
}

void Homing::done(Turn& t) {
    if (job().steps.back().text == "P=0") {
        feedback().homed(true, t);
        return succeed({}, t);
    }
    feedback().began({Feedback::Motion::Kind::home, 0, false}, t);
    drive_.poll.soon(t.now);
    accept({}, t);
}

}  // namespace axisgate::mcode
