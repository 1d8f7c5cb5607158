// Continues until a step waits for an answer or a time; blocks and repeats are a stack of levels. After a failure or a cancellation only
// stops are sent.
#include "gateway/services/recipes/recipe_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace axisgate {
namespace {
using Kind = RecipeStep::Kind;

double seconds_in(Duration d) { return std::chrono::duration<double>(d).count(); }
std::string shown(const Value& v) { return known(v) ? to_text(v) : "not known"; }
/// The value for the report: a whole number stays one, however it was computed; an infinite one is unknown.
Value settled(const Value& v) {
    const auto* d = std::get_if<double>(&v);
    if (!d) return v;
    if (!std::isfinite(*d)) return {};
    if (std::nearbyint(*d) == *d && std::fabs(*d) < 9007199254740992.0) return static_cast<std::int64_t>(*d);
    return v;
}
bool is_stop(const RecipeStep& s) { return s.kind == Kind::disable || is_stop(word_of(s)) || word_of(s) == CommandWord::disable; }
bool is_prepared(const RecipeStep& s) {
    const auto* wish = std::get_if<CommandWish>(&s.wish);
    return wish && wish->prepare == WishedFlag::yes;
}
/// True if its motion ends at a target; unknown for an action or a register.
bool ends_itself(const RecipeStep& s) { return word_of(s) != CommandWord::missing && word_of(s) != CommandWord::move_velocity; }
}  // namespace

std::string_view name_of(RecipeRun::State state) noexcept {
    switch (state) {
        case RecipeRun::State::running:
            return "running";
        case RecipeRun::State::stopping:
            return "stopping";
        case RecipeRun::State::done:
            return "done";
        case RecipeRun::State::failed:
            return "failed";
        case RecipeRun::State::cancelled:
            return "cancelled";
    }
    return "failed";
}

std::string_view name_of(RecipeRow::State state) noexcept {
    switch (state) {
        case RecipeRow::State::not_run:
            return "not_run";
        case RecipeRow::State::running:
            return "running";
        case RecipeRow::State::done:
            return "done";
        case RecipeRow::State::failed:
            return "failed";
        case RecipeRow::State::cancelled:
            return "cancelled";
    }
    return "failed";
}

RecipeRun::RecipeRun(Recipe recipe, Instant now)
    : recipe_(std::move(recipe)), rows_(recipe_.count), started_(now), run_limit_(now + recipe_.limit), due_(now) {
    for_each_step(recipe_.steps, [this](const RecipeStep& s) { rows_[s.row].step = &s; });
    levels_.push_back({&recipe_.steps, 0, nullptr, 1});
}

void RecipeRun::answer(std::uint32_t number, RecipeAnswer a) {
    const auto it = std::ranges::find(stop_requests_, number, [](const auto& p) { return p.first; });
    if (it != stop_requests_.end()) {
        Stop& s = stops_[it->second];
        s.answered = true;
        s.good = a.good;
        s.text = std::move(a.text);
        ++revision_;
    } else if (number == waiting_for_ && phase_ == Phase::answer) {
        got_ = std::move(a);
    } else {
        return;
    }
    due_ = time_zero;
}

bool RecipeRun::cancel(std::string why) {
    if (state_ != State::running || cancelled_) return false;
    cancelled_ = std::move(why);
    due_ = time_zero;
    return true;
}

void RecipeRun::turn(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests) {
    if (state_ == State::running && cancelled_) stop(State::cancelled, *cancelled_, now);
    for (std::size_t i = 0; state_ == State::running; ++i) {
        if (now >= run_limit_) {
            stop(State::failed, fmt::format("the run took longer than its timeout_s of {} s", seconds_in(recipe_.limit)), now);
        } else if (i == steps_per_turn) {
            due_ = now + std::chrono::milliseconds(1);
            return;
        } else if (!go_on(now, world, requests)) {
            due_ = std::min(due_, run_limit_);
            return;
        }
    }
    if (state_ == State::stopping) give_stops(now, world, requests);
}

/// Returns true if something has happened, so that it must be called again; false if nothing is left to do before due_ or an answer.
bool RecipeRun::go_on(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests) {
    switch (phase_) {
        case Phase::next:
            return next(now, requests);
        case Phase::answer:
            if (got_) {
                take_answer(now);
                return true;
            }
            if (now < step_limit_) {
                due_ = step_limit_;
                return false;
            }
            stop(State::failed, fmt::format("not done within {} s", seconds_in(current_->limit)), now);
            return true;
        case Phase::pause:
            if (now < due_) return false;
            if (current_->kind == Kind::wait) {
                finish(*current_, now);
            } else {
                phase_ = Phase::look;
            }
            return true;
        case Phase::look:
            look(world, now, requests);
            return true;
    }
    return false;
}

bool RecipeRun::next(Instant now, std::vector<RecipeRequest>& requests) {
    Level& level = levels_.back();
    if (level.at < level.list->size()) {
        const RecipeStep& s = (*level.list)[level.at++];
        begin(s, now, requests);
        return true;
    }
    const RecipeStep* owner = level.owner;
    if (!owner) {
        outcome_ = State::done;
        end(now);
        return true;
    }
    current_ = owner;
    if (owner->kind == Kind::repeat && owner->condition) {
        step_limit_ = now + owner->limit;
        phase_ = Phase::look;  // judge() decides whether there is another round
        return true;
    }
    if (owner->kind == Kind::repeat && level.rounds > 1) {
        --level.rounds;
        level.at = 0;
        return true;
    }
    levels_.pop_back();
    finish(*owner, now);
    return true;
}

void RecipeRun::begin(const RecipeStep& s, Instant now, std::vector<RecipeRequest>& requests) {
    RecipeRow& row = rows_[s.row];
    row.state = RecipeRow::State::running;
    row.started = now;
    row.ended = {};
    row.text.clear();
    row.value = {};
    row.pass.clear();
    for (const auto& level : levels_) {
        if (level.owner && level.owner->kind == Kind::repeat)
            row.pass += fmt::format("{}{} of {}", row.pass.empty() ? "" : ", ", level.owner->times - level.rounds + 1, level.owner->times);
    }
    ++row.times;
    ++revision_;
    current_ = &s;
    step_limit_ = now + s.limit;
    switch (s.kind) {
        case Kind::wait:
            phase_ = Phase::pause;
            due_ = now + s.limit;
            return;
        case Kind::message:
            row.text = s.text;
            [[fallthrough]];
        case Kind::set_parameter:
        case Kind::read_parameter:
        case Kind::enable:
        case Kind::disable:
        case Kind::home:
        case Kind::command:
        case Kind::action:
        case Kind::write_register:
        case Kind::simulate:
            if (s.kind == Kind::message) step_limit_ = now + std::chrono::seconds(30);
            ask(RecipeRequest::What::step, s, now, requests);
            return;
        case Kind::wait_for:
        case Kind::check:
        case Kind::branch:
            phase_ = Phase::look;
            return;
        case Kind::repeat:
            levels_.push_back({&s.steps, 0, &s, s.times});
            phase_ = Phase::next;
            return;
    }
}

void RecipeRun::ask(RecipeRequest::What what, const RecipeStep& s, Instant, std::vector<RecipeRequest>& requests) {
    waiting_for_ = ++last_number_;
    got_.reset();
    phase_ = Phase::answer;
    due_ = step_limit_;
    requests.push_back({waiting_for_, what, &s, what == RecipeRequest::What::step ? s.axis : s.condition->axis});
}

void RecipeRun::look(const RecipeWorld& world, Instant now, std::vector<RecipeRequest>& requests) {
    const RecipeCondition& c = *current_->condition;
    if (c.reads_drive()) return ask(RecipeRequest::What::read_parameter, *current_, now, requests);
    judge(world.point(c.axis, *c.row), now);
}

void RecipeRun::judge(const Value& seen, Instant now) {
    const Value value = settled(seen);
    const RecipeStep& s = *current_;
    RecipeRow& row = rows_[s.row];
    const auto truth = holds(*s.condition, value);
    if (row.value != value) {
        row.value = value;
        ++revision_;
    }
    if (s.kind == Kind::wait_for) {
        if (truth.value_or(false)) return finish(s, now);
        if (now >= step_limit_)
            return stop(State::failed,
                        fmt::format("{} did not come true within {} s: it is {}", to_text(*s.condition), seconds_in(s.limit), shown(value)),
                        now);
        phase_ = Phase::pause;
        due_ = std::min(now + (s.condition->reads_drive() ? read_period : look_period), step_limit_);
        return;
    }
    if (!truth) return stop(State::failed, fmt::format("{} cannot be told: it is {}", to_text(*s.condition), shown(value)), now);
    if (s.kind == Kind::check) {
        if (*truth) return finish(s, now);
        return stop(State::failed, fmt::format("{}{}: it is {}", s.text.empty() ? "" : s.text + ": ", to_text(*s.condition), shown(value)),
                    now);
    }
    if (s.kind == Kind::branch) {
        row.text = *truth ? "then" : "else";
        levels_.push_back({*truth ? &s.steps : &s.otherwise, 0, &s, 1});
        phase_ = Phase::next;
        return;
    }
    Level& level = levels_.back();  // a repeat with `until`, after a round
    if (*truth) {
        levels_.pop_back();
        return finish(s, now);
    }
    if (level.rounds <= 1)
        return stop(State::failed, fmt::format("{} did not come true in {} rounds: it is {}", to_text(*s.condition), s.times, shown(value)),
                    now);
    --level.rounds;
    level.at = 0;
    phase_ = Phase::next;
}

void RecipeRun::take_answer(Instant now) {
    RecipeAnswer a = std::move(*got_);
    got_.reset();
    waiting_for_ = 0;
    const RecipeStep& s = *current_;
    RecipeRow& row = rows_[s.row];
    if (!s.condition) take_motion(s, a.good, a.motion, now);
    if (!a.good) {
        if (s.kind == Kind::wait_for && now < step_limit_) {  // a drive that does not answer now may answer later
            row.text = a.text;
            phase_ = Phase::pause;
            due_ = std::min(now + read_period, step_limit_);
            return;
        }
        return stop(State::failed, a.text, now);
    }
    if (s.condition) return judge(a.value, now);
    if (s.kind != Kind::message) row.text = std::move(a.text);
    row.value = std::move(a.value);
    finish(s, now);
}

/// Notes the motions of the run after a step: a refused command has begun nothing, and does not change an earlier motion.
void RecipeRun::take_motion(const RecipeStep& s, bool good, RecipeAnswer::Motion motion, Instant now) {
    using Published = RecipeAnswer::Motion;
    if (good && is_stop(s)) {
        in_motion_.erase(s.axis);
        prepared_.erase(s.axis);
    }
    if (!is_motion(s) || s.axis.empty() || motion == Published::nothing || (!good && motion == Published::by_result)) return;
    if (is_prepared(s)) {
        prepared_.insert(s.axis);
        return;
    }
    const Motion begun{now, ends_itself(s), motion == Published::interrupted};
    if (good && s.until_done && begun.ends_itself) {
        in_motion_.erase(s.axis);
    } else {
        in_motion_[s.axis] = begun;
    }
    // An action may start a group, so the prepared motions of the run are assumed to be in progress.
    if (s.kind == Kind::action && good) {
        for (const auto& axis : prepared_)
            in_motion_.insert({axis, {now, false, false}});
        prepared_.clear();
    }
}

void RecipeRun::finish(const RecipeStep& s, Instant now) {
    RecipeRow& row = rows_[s.row];
    row.state = RecipeRow::State::done;
    row.ended = now;
    ++revision_;
    phase_ = Phase::next;
}

void RecipeRun::stop(State outcome, std::string text, Instant now) {
    // An answer after this is too late: it is unknown then whether the drive has accepted the step's command.
    if (phase_ == Phase::answer && waiting_for_ != 0 && !current_->condition)
        take_motion(*current_, got_ && got_->good, got_ ? got_->motion : RecipeAnswer::Motion::unknown, now);
    got_.reset();
    outcome_ = outcome;
    state_ = State::stopping;
    where_ = current_;
    text_ = std::move(text);
    for (auto& row : rows_) {  // the step itself and those around it
        if (row.state != RecipeRow::State::running) continue;
        row.state = outcome == State::cancelled ? RecipeRow::State::cancelled : RecipeRow::State::failed;
        row.ended = now;
        if (row.step == current_) row.text = text_;
    }
    phase_ = Phase::next;
    waiting_for_ = 0;
    step_limit_ = now + stop_limit;
    doubt_until_ = now + doubt_limit;
    ++revision_;
}

/// Stops the run's own motions and releases the others. Returns false if the owner of some motion is not known yet.
bool RecipeRun::sort_motions(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests) {
    using Whose = RecipeWorld::Claim::Whose;
    for (auto it = in_motion_.begin(); it != in_motion_.end();) {
        const auto& [axis, motion] = *it;
        auto claim = world.claim(axis);
        const bool at_rest =
            claim.whose == Whose::resting && (motion.interrupted || (motion.ends_itself && now - motion.begun > start_limit));
        if (claim.whose == Whose::others) {
            stops_.push_back({axis, true, false, true, "left alone: " + std::move(claim.text)});
            ++revision_;
        } else if (motion.interrupted && !at_rest && now < doubt_until_) {
            ++it;
            continue;
        } else if (!at_rest) {
            stops_.push_back({axis, false, false, false, ""});
            stop_requests_.emplace_back(++last_number_, stops_.size() - 1);
            requests.push_back({last_number_, RecipeRequest::What::stop, nullptr, axis});
            ++revision_;
        }
        it = in_motion_.erase(it);
    }
    return in_motion_.empty();
}

void RecipeRun::give_stops(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests) {
    const bool sorted = sort_motions(now, world, requests);
    if (sorted && std::ranges::all_of(stops_, &Stop::answered)) return end(now);
    if (now < step_limit_) {
        due_ = sorted ? step_limit_ : std::min(now + look_period, step_limit_);
        return;
    }
    for (auto& s : stops_) {
        if (!s.answered) s.text = "no answer to the stop: see to it that the axis stands";
    }
    end(now);
}

void RecipeRun::end(Instant now) {
    state_ = outcome_;
    ended_at_ = now;
    current_ = nullptr;
    due_ = never;
    ++revision_;
}

}  // namespace axisgate
