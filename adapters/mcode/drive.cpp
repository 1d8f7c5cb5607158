// Drive: exchanges, presence, polls, stops.
// In: the end of each exchange, time. Out: the next request, feedback, links.
// Never asks ER but when EF says that there is one: reading clears it [L2587].
#include "adapters/mcode/drive.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace axisgate::mcode {
using namespace std::chrono_literals;
using What = Request::Purpose;

namespace {
std::optional<std::int64_t> whole(std::string_view s) {
    double v = 0;
    const auto [p, ec] = std::from_chars(s.data(), s.data() + s.size(), v);
    if (ec != std::errc{} || p != s.data() + s.size() || !(std::fabs(v) < 9e15)) return std::nullopt;
    return std::llround(v);
}
std::vector<std::string_view> split(std::string_view s) {
    std::vector<std::string_view> parts;
    for (;;) {
        const auto at = s.find(',');
        parts.push_back(s.substr(0, at));
        if (at == std::string_view::npos) return parts;
        s.remove_prefix(at + 1);
    }
}
}  // namespace

Drive::Drive(const Catalogue& catalogue, const Manners& manners, AdapterCounters& counters, const DriveSetup& setup, Instant& next_listing)
    : catalogue_(catalogue), manners_(manners), counters_(counters), next_listing_(next_listing), setup_(setup) {
    for (const auto& a : setup.axes) {
        if (a.channel == 1) axis_ = a.id;
    }
}

// --- presence --------------------------------------------------------------------------------------------------------------------

void Drive::line_up(Turn& t) { begin_probing(t); }

void Drive::line_down(Turn& t, std::string_view why) {
    restart_over(Outcome::failed, Reason::line_down, why, t);
    fail_all(Reason::line_down, std::string(why), t);
    half_was_away_ = half_was_away_ || clear_half_;
    mode_flight_ = false;                               // a PG that nobody can answer any more: the mode stays unknown
    if (mode_ == Mode::program) mode_ = Mode::unknown;  // it may restart meanwhile: PG would put it into program mode then
    lost_ = 0;
    phase_ = Phase::down;
    if (shown_online_) link_state(false, std::string(why), t);
    seen_ = enabled_ = false;
    demand_lost();
}

void Drive::remove(Turn& t, std::string_view why) {
    restart_over(Outcome::failed, Reason::line_down, why, t);
    fail_all(Reason::line_down, std::string(why), t);
}

void Drive::begin_probing(Turn& t) {
    phase_ = Phase::probing;
    silent_ = 0;
    retry_pause_ = {};
    next_probe_ = t.now;
    next_poll_ = never;
    link_rounds_ = 0;
    sums_ = false;
    em_ = 1;
    need_error_ = false;
}

void Drive::go_absent(Turn& t, std::string why) {
    phase_ = Phase::absent;
    link_rounds_ = 0;
    if (retry_pause_ == Duration{}) retry_pause_ = manners_.pause_min;
    next_probe_ = t.now + retry_pause_;
    next_poll_ = never;
    need_error_ = false;
    enabled_ = false;
    fb_.referenced = fb_.homing_attained = false;
    motion_ = {};
    demand_lost();
    zero_after_home_ = false;
    tidy_ = tidy_ || job_.kind == JobKind::tidy;
    // A stop that was not confirmed is said once more to a drive that may only not be heard.
    auto stops = std::move(stops_);
    stops_.clear();
    fail_all(Reason::no_answer, why, t);
    stops_ = std::move(stops);
    for (Stop& s : stops_)
        s.confirming = s.to_all = false;
    half_was_away_ = half_was_away_ || clear_half_;
    if (mode_ == Mode::program) mode_ = Mode::unknown;  // it may restart meanwhile
    lost_ = 0;
    link_state(false, std::move(why), t);
}

void Drive::link_state(bool is_online, std::string text, Turn& t) {
    shown_online_ = is_online;
    t.out.links.push_back({setup_.id, is_online, silent_, is_online ? Duration{} : retry_pause_, std::move(text)});
}

void Drive::came(Turn& t) {
    phase_ = Phase::ready;
    program_lost(Reason::interrupted, "the drive was found anew: it may have restarted", t);
    known_sums_ = sums_;
    link_rounds_ = 0;  // it may come again in another state: a power cycle brings back EM, CK, ES and CE of its memory
    enabled_ = false;
    retry_pause_ = {};
    motion_ = {};
    fault_ = 0;
    fb_.target_reached = fb_.homing_error = false;
    seen_ = false;
    demand_lost();
    demand_.knows({vi_, vm_, a_, d_, encoder_flag_});
    link_state(true, identity_.empty() ? fmt::format("answers to {}", setup_.address) : identity_, t);
    next_poll_ = t.now;
    if (!std::exchange(survey_, true)) {  // it keeps the turn that it has
        survey_at_ = std::max(t.now, next_listing_);
        next_listing_ = survey_at_ + std::chrono::seconds(1);
    }
    at_factory_rate_ = false;
    const std::string trouble = job_.kind == JobKind::named ? std::string() : rate_trouble();  // line.setup sets BD too
    if (!trouble.empty()) note(Severity::warning, "bit_rate", 0, trouble, t);
    restart_over(Outcome::done, Reason::none, "has restarted and is set up again", t);
    if (job_.kind == JobKind::named && job_.steps.empty()) job_over(Outcome::done, Reason::none, job_.text, t);
    if (job_.kind == JobKind::factory) {
        job_over(Outcome::done, Reason::none, fmt::format("{} has its factory values{}{}", name(), trouble.empty() ? "" : "; ", trouble),
                 t);
    }
}

std::string Drive::not_understood() const {
    return fmt::format("{}: what answers to {} is not understood: noise, another rate, or two drives with this name", name(),
                       setup_.address);
}

void Drive::count_silence(Turn& t) {
    ++silent_;
    ++counters_.timeouts;
    const bool gone = silent_ >= static_cast<std::uint32_t>(manners_.silent_limit);
    if (phase_ == Phase::absent) {
        retry_pause_ = std::min(2 * retry_pause_, manners_.pause_max);
        next_probe_ = t.now + retry_pause_;
        link_state(false, babble_ ? not_understood() : fmt::format("{} does not answer to {}{}", name(), setup_.address, factory_hint()),
                   t);
    } else if (gone) {
        go_absent(t, babble_
                         ? not_understood()
                         : fmt::format("{} has not answered to {} {} times in a row{}", name(), setup_.address, silent_, factory_hint()));
    } else if (phase_ == Phase::probing) {
        next_probe_ = t.now;
    }
}

// --- how it ended ----------------------------------------------------------------------------------------------------------------

void Drive::ended(Verdict v, const ReplyReader& reader, Turn& t) {
    if (v == Verdict::garbled) ++counters_.garbled;
    if (v == Verdict::refused) ++counters_.refused;
    const bool heard = v != Verdict::waiting;
    if (heard && v != Verdict::garbled) {
        if (v != Verdict::refused) ++counters_.exchanges;
        silent_ = 0;
    }
    if (phase_ == Phase::ready) {
        const bool begun = reader.raw().find('#') != std::string::npos && reader.raw().find("PR \"#") == std::string::npos;
        if (v == Verdict::garbled || (!heard && begun)) trouble(heard ? Trouble::Kind::garbled : Trouble::Kind::cut, t);
        if (!heard && !begun) ++lost_;
        // Without an answer it may be going away, which is told otherwise: they count when it is heard again.
        for (; heard && lost_ > 0; --lost_)
            trouble(Trouble::Kind::lost, t);
    }
    // An echo is silence; anything else is somebody who is not understood.
    if (restart_ && phase_ != Phase::ready && t.now >= restart_until_)
        restart_over(Outcome::failed, Reason::no_answer, "was restarted and is not set up again: see its link", t);
    babble_ = !heard && reader.raw().find("PR \"#") == std::string::npos && reader.raw().find_first_not_of("\r\n") != std::string::npos;
    const bool mode_line = mode_flight_;
    mode_line_ended(v);
    if ((job_.kind == JobKind::named || job_.kind == JobKind::factory) && phase_ != Phase::ready && t.now >= job_.give_up)
        return go_absent(t, not_understood() + factory_hint());
    const bool seldom_refused = purpose_ == What::poll || purpose_ == What::confirm || purpose_ == What::error;
    if (seldom_refused && mode_ == Mode::immediate && v != Verdict::answered && reader.taken_without_answer()) {
        // Perhaps somebody has put it into program mode: asked before anything else is said, a stop included.
        mode_ = Mode::unknown;
        suspected_ = true;
        stored_ = 1;
        evidence_ = 0;
    }
    if ((purpose_ == What::poll || purpose_ == What::confirm) && v != Verdict::answered) lag_missed(t.now);
    switch (purpose_) {
        case What::leave:
            return leave_ended(v, reader, t);
        case What::probe:
            if (mode_line) {
                mode_ = Mode::unknown;  // the next probe tells
                next_probe_ = t.now;
                if (!heard) count_silence(t);
                return;
            }
            if (probe_tells_mode(v, reader, t)) return;
            return probe_ended(v, reader.data(), t);
        case What::link:
            if (!heard) {
                phase_ = Phase::probing;
                next_probe_ = t.now;
                return count_silence(t);
            }
            // A probe says what it has become. After CK = 1 the first probe without a checksum is answered with NAK.
            phase_ = Phase::probing;
            next_probe_ = t.now;
            return;
        case What::startup:
            return startup_ended(v, reader.data(), t);
        case What::stop:
            return stop_ended(v, reader, t);
        case What::error:
            return error_read(v, reader.data(), t);
        case What::confirm: {
            const bool good = v == Verdict::answered && learn_poll(reader.data(), t);
            if (good) {
                if (ef_) {
                    need_error_ = true;
                    const Verdict said = !stops_.empty() && stops_.front().confirming ? stops_.front().said : job_.said;
                    const bool to_all = !stops_.empty() && stops_.front().confirming && stops_.front().to_all;
                    error_is_ours_ = said == Verdict::refused || !sums_ || quiet() || to_all;  // an ACK means: no error [L2081]
                    return;
                }
                last_error_ = 0;
                return confirmed(t);
            }
            if (!heard) count_silence(t);
            if (phase_ != Phase::ready) return;
            int& tries = !stops_.empty() && stops_.front().confirming ? stops_.front().tries : job_.tries;
            if (++tries > manners_.retries + 3) {
                if (!stops_.empty() && stops_.front().confirming) {
                    return stop_over(Outcome::failed, Reason::no_answer, fmt::format("{} did not confirm the stop", name()), t);
                }
                job_over(Outcome::failed, Reason::no_answer,
                         fmt::format("{} did not say whether it took {}", name(), job_.steps[job_.at].text), t);
            }
            return;
        }
        case What::step:
            return step_ended(v, reader, t);
        case What::poll:
            if (v != Verdict::refused) poll_refusals_ = 0;
            if (v == Verdict::answered && learn_poll(reader.data(), t)) {
                if (ef_) {
                    need_error_ = true;
                    error_is_ours_ = false;
                }
            } else if (v == Verdict::refused) {
                // One may be noise. Two: its link has changed; a restart has brought back EM and CK of its memory.
                next_poll_ = t.now;
                if (asks_lag_ || ++poll_refusals_ < 2) return;  // with LL: the next without it tells
                poll_refusals_ = 0;
                phase_ = Phase::probing;
                next_probe_ = t.now;
                ++silent_;
                if (silent_ >= static_cast<std::uint32_t>(manners_.silent_limit))
                    go_absent(t, fmt::format("{} refuses every question", name()));
            } else if (!heard) {
                count_silence(t);
            }
            return;
    }
}

void Drive::probe_ended(Verdict v, const std::string& data, Turn& t) {
    if (v == Verdict::answered && data.size() == (manners_.ethernet ? 1U : 4U)) {
        em_ = data[0] - '0';
        ck_ = manners_.ethernet ? 0 : data[1] - '0';
        es_ = manners_.ethernet ? 1 : data[2] - '0';
        ce_ = manners_.ethernet ? 1 : data[3] - '0';
        sums_ = ck_ > 0;
        const bool again = ++link_rounds_ <= link_round_limit;
        if (em_ != manners_.em && again) {
            link_line_ = fmt::format("EM={}", manners_.em);
            phase_ = Phase::linking;
        } else if (!manners_.ethernet && ck_ != manners_.ck && again) {
            link_line_ = fmt::format("CK={}", manners_.ck);
            phase_ = Phase::linking;
        } else if (link().party() && es_ != 3 && again) {
            // With ES = 1 an ESC meant for one drive would stop them all [L2742-2744].
            link_line_ = "ES=3";
            phase_ = Phase::linking;
        } else if (link().party() && ce_ == 1 && again) {
            // With CE = 1 every CTRL+C on the wires restarts it; with 2 one behind its own name does [L2005-2006].
            link_line_ = "CE=2";
            phase_ = Phase::linking;
        } else {
            if (em_ != manners_.em || (!manners_.ethernet && ck_ != manners_.ck)) {
                note(Severity::warning, "link", 0, fmt::format("{} keeps EM={} and CK={}; it is used as it is", name(), em_, ck_), t);
            }
            phase_ = Phase::starting;
            startup_at_ = 0;
            identity_.clear();
        }
        return;
    }
    own_trouble_ = true;
    // A drive with CK on ignores a line without checksum, one with CK off does not know the extra byte: the other way next time.
    sums_ = !sums_;
    if (manners_.ethernet) sums_ = false;
    if (v == Verdict::waiting) return count_silence(t);
    ++silent_;
    next_probe_ = t.now;
    if (silent_ > 2U * static_cast<std::uint32_t>(manners_.silent_limit) || phase_ == Phase::absent) {
        if (phase_ == Phase::absent) retry_pause_ = std::min(2 * retry_pause_, manners_.pause_max);
        go_absent(t, not_understood());
        // NAK is a drive that is there: the other way is tried soon.
        if (v == Verdict::refused) next_probe_ = t.now + manners_.pause_min;
    }
}

void Drive::startup_ended(Verdict v, const std::string& data, Turn& t) {
    if (v == Verdict::waiting || v == Verdict::garbled) {
        if (v == Verdict::waiting)
            count_silence(t);
        else if (++silent_ >= 2U * static_cast<std::uint32_t>(manners_.silent_limit))
            go_absent(t, fmt::format("the answers of {} are spoiled", name()));
        return;
    }
    const bool good = v == Verdict::answered;
    const auto asks = startup_items[startup_at_];
    own_trouble_ = own_trouble_ || !good;
    if (asks == "PN") {
        if (good) identity_ = data;
        // The part number tells closed loop [L1217]: asking others for AS would be an error in them, and run their handler (OE).
        const bool closed = identity_.starts_with("LMDC"), open = identity_.starts_with("LMDO"), module = identity_.starts_with("LMM");
        hmt_ = closed;
        encoder_ = closed || module;
        knows_model_ = closed || open || module;
    } else if (asks == "VR") {
        // "LMMCM 6.002, Hw: 3.2" [L6192]
        const auto digit = std::min(data.find_first_of("0123456789"), data.size());
        const auto major = good ? whole(std::string_view(data).substr(digit, data.find('.', digit) - digit)) : std::nullopt;
        old_firmware_ = major && *major < 6;
        if (good && !data.empty()) identity_ += fmt::format("{}firmware {}", identity_.empty() ? "" : ", ", data);
    } else if (asks == "BY") {
        running_ = good && data == "1";
    } else if (asks == "AS") {
        hmt_ = good;
    } else if (asks == "ST") {
        encoder_ = good;
    } else if (asks == "IF") {
        tells_input_ = good;
    } else if (asks == "BD") {
        bd_ = static_cast<int>(good ? whole(data).value_or(0) : 0);
    } else if (good) {
        learn_values(data);
    }
    // Without an encoder ST and EE are errors; an open loop is asked for them only when no program can be disturbed by that.
    const auto needless = [&](std::string_view item) {
        return (item == "AS" && knows_model_) || (item == "ST" && (encoder_ || running_)) || (item == "BD" && manners_.rate_code == 0);
    };
    do
        ++startup_at_;
    while (startup_at_ < startup_items.size() && needless(startup_items[startup_at_]));
    if (startup_at_ == startup_items.size()) came(t);
}

void Drive::learn_values(std::string_view data) {
    const auto f = split(data);
    if (f.size() != (encoder_ ? 5U : 4U)) return;
    const auto vi = whole(f[0]).value_or(0);
    if (vi != vi_) user_vi_ = vi;  // else it is as a slow move has left it
    vi_ = vi;
    vm_ = whole(f[1]).value_or(0);
    a_ = whole(f[2]).value_or(0);
    d_ = whole(f[3]).value_or(0);
    encoder_flag_ = encoder_ && whole(f[4]).value_or(0) == 1;
    demand_.knows({vi_, vm_, a_, d_, encoder_flag_});
}

bool Drive::learn_poll(const std::string& data, Turn& t) {
    const auto f = split(data);
    const std::size_t lr = 6U + (encoder_ ? 1U : 0U), as = lr + 1U;
    const std::size_t flags = lr + (hmt_ ? 2U : 0U) + (tells_input_ ? 1U : 0U);
    const auto fits = [&](std::size_t i) {
        return f[2][i] == '0' || f[2][i] == '1' || (hmt_ && i == as && f[2][i] >= '0' && f[2][i] <= '3');
    };
    bool whole_line = f.size() == (asks_lag_ ? 4U : 3U) && f[2].size() == flags;
    for (std::size_t i = 0; whole_line && i < flags; ++i)
        whole_line = fits(i);
    const auto number = [&](std::size_t i) { return whole_line ? whole(f[i]) : std::nullopt; };
    const auto p = number(0), v = number(1), lag = asks_lag_ ? number(3) : std::nullopt;
    if (!p || !v || (asks_lag_ && !lag)) {
        lag_missed(t.now);
        ++counters_.garbled;
        return false;
    }
    const auto flag = [&](std::size_t i) { return f[2][i] == '1'; };
    read_at_ = std::min(heard_at_, t.now);
    fb_.position = *p;
    fb_.velocity = *v;
    mv_ = flag(0);
    mp_ = flag(1);
    vc_ = flag(2);
    de_ = flag(3);
    ef_ = flag(4);
    running_ = flag(5);
    if (running_) prints_until_ = t.now + 2s;
    if (!mv_) stopping_ = false;
    stalled_ = encoder_ && flag(6);
    locked_ = hmt_ && flag(lr);
    hmt_mode_ = hmt_ ? f[2][as] - '0' : 0;
    torque_ = hmt_mode_ == 3;
    if (asks_lag_) lag_misses_ = 0;
    take_demand(lag);
    program_ran_ = program_ran_ || running_;
    if (!running_ && std::exchange(program_ran_, false)) relearn_ = true;
    const bool waited = std::exchange(input_, tells_input_ && flag(flags - 1));
    if (input_ && !waited) {
        // No poll can be the number: it begins with PR. What is sent as native text and begins with a digit or a sign is.
        note(Severity::info, "input", 0, fmt::format("{}: its program waits for a number (IV): send it as a native line", name()), t);
    }
    if (!std::exchange(seen_, true) && running_) {
        note(Severity::info, "program", 0,
             fmt::format("{}: a program runs in it already: it is left alone; quick stop ends it, halt stops its motion only", name()), t);
    }
    next_poll_ = t.now + manners_.poll_period;
    derive(t);
    emit(t);
    watch_program(t);
    if (job_.kind != JobKind::none && !job_.confirming && job_.at < job_.steps.size() &&
        job_.steps[job_.at].what == Step::What::standstill) {
        if (!mv_) {
            step_done(t);
        } else if (t.now >= job_.give_up) {
            job_over(Outcome::failed, Reason::wrong_state, fmt::format("{} does not come to a standstill", name()), t);
        }
    }
    return true;
}

void Drive::learn_error(int code, bool ours, Turn& t) {
    const ErrorCode* e = catalogue_.error(code);
    const std::string text = e ? e->text : std::string("a code that the catalogue does not have");
    last_error_ = code;
    if (program_ && !ours && code != 0) program_->code = code;
    if (is_fault_code(code)) fault_ = code;
    // SM says whether a stall (86) ends the motion, and the flags tell that.
    if (!ours && code != 86 && (is_fault_code(code) || code == 83 || code == 84 || code == 91)) demand_.ended(t.now);
    const bool no_news = std::exchange(own_trouble_, false) && !is_fault_code(code);
    if (!ours && !no_news && code != 0) {
        note(is_fault_code(code) ? Severity::alarm : Severity::warning, "error", code, fmt::format("{}: error {}, {}", name(), code, text),
             t);
    }
    derive(t);
    emit(t);
}

void Drive::error_read(Verdict v, const std::string& data, Turn& t) {
    const auto code = v == Verdict::answered ? whole(data) : std::nullopt;
    if (!code) {
        if (v == Verdict::waiting) count_silence(t);
        if (v == Verdict::refused || phase_ != Phase::ready) need_error_ = false;
        if (!need_error_ || ++error_tries_ <= manners_.retries) return;  // asked again
        // What is no number stays none: the polls go on, and who waits for it hears so.
        need_error_ = false;
        error_tries_ = 0;
        const auto why = fmt::format("{} has an error and its code cannot be read", name());
        if (!stops_.empty() && stops_.front().confirming) return stop_over(Outcome::failed, Reason::no_answer, why, t);
        if (job_.kind != JobKind::none && job_.confirming) job_over(Outcome::failed, Reason::no_answer, why, t);
        return;
    }
    need_error_ = false;
    error_tries_ = 0;
    ef_ = false;
    const bool waits = (!stops_.empty() && stops_.front().confirming) || (job_.kind != JobKind::none && job_.confirming);
    // With a line to all nobody says whose error it is: a fault is told, and the stop is judged by what is read.
    const bool fault_beside = !stops_.empty() && stops_.front().to_all && is_fault_code(static_cast<int>(*code));
    const bool ours = waits && error_is_ours_ && !fault_beside;
    learn_error(static_cast<int>(*code), ours, t);
    if (!waits) return;
    if (!ours) last_error_ = is_fault_code(last_error_) ? last_error_ : last_error_;
    const int keep = last_error_;
    if (!ours) last_error_ = 0;
    confirmed(t);
    if (last_error_ == 0) last_error_ = keep;
    if (!ours && program_ && program_->code == 0) program_->code = keep;  // of its first line, before its start was confirmed
}

}  // namespace axisgate::mcode
