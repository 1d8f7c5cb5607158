// Programs: program text into the drive's memory and out of it, and what a broken download or a look at program mode has left there.
// In: text that was checked as a whole, listings. Out: CP, PG and lines; results; notices of what was removed.
// Never removes what it did not store itself.
#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

bool Programs::is(Doing doing) const noexcept { return drive_.jobs.is(*this) && work_.doing == doing; }

void Programs::begin(Doing doing) {
    work_ = {};
    work_.doing = doing;
}

void Programs::plan(const Command& c, Turn& t) {
    const Action& a = std::get<Action>(c.body);
    begin(Doing::upload);
    if (a.name == "program.upload") {
        job().list("L");
        return;
    }
    if (a.name == "program.edit") return edit(a.argument, t);
    download(a.argument, t);
}

void Programs::download(const std::string& text, Turn& t) {
    if (feedback().running())
        return refuse(Reason::wrong_state, fmt::format("a program runs in {}: end it first (program.end)", name()), t);
    auto checked = check_program(text, Language(drive_.bus.catalogue));
    if (!checked.fault.empty()) return refuse(Reason::out_of_range, fmt::format("the program was not sent; {}", checked.fault), t);
    if (!wait_for_rest(t)) return;
    work_.doing = Doing::download;
    drive_.mode.doubt(false);
    tidy_ = false;
    job().send("CP 1");
    add_lines(checked.lines);
    job().list("L");
    work_.program = std::move(checked.lines);
}

void Programs::add_lines(const std::vector<ProgramLine>& lines) {
    for (const auto& l : lines) {
        const bool setting = l.kind == ProgramLine::Kind::setting;
        const auto w = word_of(l.text);
        job().add({setting ? Step::What::send : Step::What::bare, l.text, setting && w != "IC" && w != "DC", false, l.number});
        if (setting) feedback().relearn = true;
    }
}

void Programs::sending(Step& step, Request&) {
    if ((!is(Doing::download) && !is(Doing::edit)) || step.what == Step::What::query || step.what == Step::What::block) return;
    work_.memory_touched = true;  // CP is its first line
    clear_half_ = false;
    drive_.mode.sending(step.text);
}

bool Programs::ended(const Step& step, Verdict v, Turn& t) {
    if (step.what != Step::What::bare || v == Verdict::acknowledged || v == Verdict::answered) return false;
    drive_.mode.doubt(v == Verdict::waiting);
    download_failed(fmt::format("{}{} {}", step.line != 0 ? fmt::format("line {}: ", step.line) : std::string(), step.text,
                                v == Verdict::refused ? "was refused by the drive" : "was not acknowledged"),
                    t);
    return true;
}

/// A line of the user's text outside of PG.
bool Programs::complained(const Step& step, int error, Turn& t) {
    if (!is(Doing::download) || step.line == 0) return false;
    if (error == 6) {
        // A point has this type: perhaps as the line wants it. What is read tells.
        drive_.errors.clear_last();
        Step ask{Step::What::query, word_of(step.text), step.repeatable, true, step.line};
        job().steps.insert(job().steps.begin() + static_cast<std::ptrdiff_t>(job().at) + 1, std::move(ask));
        drive_.jobs.step_done(t);
    } else if (error == 28 && job().tries > 0) {
        drive_.errors.clear_last();  // VA that was done, and whose acknowledgement was lost
        drive_.jobs.step_done(t);
    } else {
        setting_refused(error != 0 ? fmt::format("was refused with error {}", error) : "was not acknowledged", t);
    }
    return true;
}

void Programs::answered(const std::string& data, Turn& t) {
    std::istringstream rows(data);
    const std::string want = normal_form(job().steps[job().at - 1].text);
    for (std::string row; std::getline(rows, row);) {
        if (normal_form(row).starts_with(want)) return drive_.jobs.step_done(t);
    }
    setting_refused("was refused with error 6: a point has this type already", t);
}

void Programs::listed(const std::string& text, Turn& t) {
    switch (work_.doing) {
        case Doing::tidy:
            return tidy_up(text, t);
        case Doing::clear:
            return clear_if_half(text, t);
        case Doing::edit:
            return edit_listed(text, t);
        case Doing::download:
            return compare(text, t);
        case Doing::upload:
        case Doing::nothing:
            break;
    }
    std::string program;
    for (const auto& l : listed_lines(text))
        program += l + '\n';
    succeed(program, t, Value{program});
}

void Programs::compare(const std::string& listing, Turn& t) {
    std::size_t count = 0;
    if (const auto why = listing_fault(work_.program, listing, count); !why.empty())
        return fail(Reason::drive_refused, fmt::format("{}: {}; {}", name(), why, memory_is_half()), t);
    const auto& lines = work_.program;
    const bool saved = !lines.empty() && lines.back().kind == ProgramLine::Kind::setting && word_of(lines.back().text) == "S";
    succeed(fmt::format("{} statements stored and verified; {}", count, saved ? "its line S has saved them" : "program.save keeps them"),
            t);
}

void Programs::done(Turn& t) {
    if (work_.doing == Doing::clear) {
        half_.clear();
        half_from_.clear();
        was_away_ = false;
        note(Severity::info, "program", 0, fmt::format("{}: the half that a broken download has left was removed (CP)", name()), t);
        return succeed({}, t);
    }
    if (work_.doing == Doing::tidy) note(Severity::info, "program_mode", 0, job().text, t);
    succeed(job().text, t);
}

// --- what breaks off -------------------------------------------------------------------------------------------------------------

std::string Programs::memory_is_half() const {
    return work_.from.empty() ? "the program memory is cleared or incomplete: download again"
                              : fmt::format("the program is cleared or incomplete from address {} on: edit again", work_.from);
}

void Programs::interrupt(std::string_view by, Turn& t) {
    if (is(Doing::download)) download_failed(fmt::format("{} came in between", by), t);
}

void Programs::download_failed(std::string why, Turn& t) {
    const bool touched = work_.memory_touched;
    if (touched) keep_half();
    feedback().relearn = feedback().relearn || touched;
    fail(Reason::interrupted, fmt::format("{}: {}{}", name(), why, touched ? "; " + memory_is_half() : ""), t);
}

void Programs::without_success(drive::Failure& how, Turn& t) {
    const bool clears = work_.doing == Doing::clear, tidies = work_.doing == Doing::tidy;
    if (how.dropped) {
        clear_half_ = clear_half_ || clears;
        tidy_ = tidy_ || tidies;
        if (!work_.memory_touched) return;
        keep_half();
        how.text += "; " + memory_is_half();
    } else if (tidies) {
        note(Severity::warning, "program_mode", how.code,
             fmt::format("{}: questions of this gateway may stand at the end of its program (PR \"#...): they could not be removed, {}",
                         name(), how.text),
             t);
    } else if (clears) {
        note(Severity::warning, "program", how.code,
             fmt::format("{}: the half of a broken download stays in its program memory: it could not be removed, {}", name(), how.text),
             t);
    }
}

/// Program mode is left first; CP then removes the half, behind every stop that waits, also when the drive was away.
void Programs::keep_half() {
    clear_half_ = true;
    was_away_ = false;
    half_from_ = work_.from;
    half_ = work_.stays;
    for (std::size_t i = 0; i <= job().at && i < job().steps.size(); ++i) {
        const Step& s = job().steps[i];
        if (s.what == Step::What::bare && word_of(s.text) != "PG" && word_of(s.text) != "VA") half_.push_back(normal_form(s.text));
    }
}

/// Before PG and PG the memory is empty, behind them it holds the program; only between two parts there is a half.
void Programs::setting_refused(const std::string& why, Turn& t) {
    const Step step = job().steps[job().at];
    const auto is_part = [](const Step& s) { return s.what == Step::What::bare; };
    const auto here = job().steps.begin() + static_cast<std::ptrdiff_t>(job().at);
    const bool begun = std::any_of(job().steps.begin(), here, is_part), more = std::any_of(here, job().steps.end(), is_part);
    if (begun && more) keep_half();
    feedback().relearn = true;
    const int code = drive_.errors.last();
    const ErrorCode* e = code != 0 ? drive_.bus.catalogue.error(code) : nullptr;
    fail(code != 0 ? Reason::drive_refused : Reason::no_answer,
         fmt::format("{}: line {}: {} {}{}; {}", name(), step.line,
                     step.what == Step::What::query ? job().steps[job().at - 1].text : step.text, why, e ? ", " + e->text : std::string(),
                     begun && !more ? "the program before it is stored" : memory_is_half()),
         t, code);
}

// --- what was left behind --------------------------------------------------------------------------------------------------------

void Programs::clean_up() {
    if (!feedback().at_rest()) return;
    if (std::exchange(clear_half_, false)) {
        begin(Doing::clear);
        Job& job = drive_.jobs.begin_own(*this);
        was_away_ || !half_from_.empty() ? job.list("L") : job.send("CP");
    } else if (std::exchange(tidy_, false)) {
        begin(Doing::tidy);
        drive_.jobs.begin_own(*this).list("L");
    }
}

/// The drive was away: it may have restarted with the program that it had saved, which is none of this gateway's business.
void Programs::clear_if_half(const std::string& listing, Turn& t) {
    std::size_t i = 0;
    for (const auto& l : was_away_ ? listed_lines(listing) : std::vector<std::string>()) {
        const auto w = word_of(l);
        const std::string have = normal_form(l);
        if (w == "PG" || w == "VA" || have.starts_with("PR\"#")) continue;
        // The last one may have been cut off.
        if (i + 1 < half_.size() ? have == half_[i] : i + 1 == half_.size() && half_[i].starts_with(have)) {
            ++i;
            continue;
        }
        note(Severity::info, "program", 0,
             fmt::format("{}: a download has broken off, but its program memory holds another program now: that is left alone", name()), t);
        half_.clear();
        return succeed({}, t);
    }
    was_away_ = false;
    work_.from = half_from_;
    if (half_from_.empty())
        job().send("CP");
    else if (!clear_from(addressed_lines(listing), t) && !drive_.jobs.is(*this))
        return;
    drive_.jobs.step_done(t);
}

void Programs::tidy_up(const std::string& listing, Turn& t) {
    const auto left = stored_questions(listing);
    if (left.count == 0) return succeed({}, t);
    if (left.address.empty()) return fail(Reason::wrong_state, "the listing shows no addresses", t);
    if (!left.at_end) {
        return fail(Reason::wrong_state,
                    fmt::format("the first stands at address {} and other lines follow: see program.list", left.address), t);
    }
    job().text = fmt::format("{}: {} stored question{} removed from the end of its program (CP 0,{}); the program is as it was found",
                             name(), left.count, left.count == 1 ? " was" : "s were", left.address);
    job().send(fmt::format("CP 0,{}", left.address), false);
    drive_.jobs.step_done(t);
}

}  // namespace axisgate::mcode
