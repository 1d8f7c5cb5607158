// LineSetupAction and Restart: naming a fresh drive, giving it the line's rate; restarting a drive.
// In: line.setup, reset, factory_defaults; the return of the drive. Out: lines, raw bytes; results when the drive is set up.
// Never restarts another drive of the line.
#include <fmt/core.h>

#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

// --- line.setup ------------------------------------------------------------------------------------------------------------------

bool LineSetupAction::naming() const noexcept { return drive_.jobs.is(*this) && names_; }
bool LineSetupAction::named() const noexcept { return drive_.jobs.is(*this) && named_; }
bool LineSetupAction::too_late(Instant now) const noexcept { return named() && now >= drive_.jobs.job().give_up; }

void LineSetupAction::plan(const Command& c, Turn& t) {
    const std::string& argument = std::get<Action>(c.body).argument;
    const bool save = argument == "save";
    names_ = named_ = false;
    if (!argument.empty() && !save) return refuse(Reason::out_of_range, fmt::format("line.setup {}: write save, or nothing", argument), t);
    if (!drive_.link().party()) return set_rate(save, t);
    if (drive_.ready()) {
        return refuse(Reason::wrong_state,
                      fmt::format("a drive answers to {} already: line.setup names the fresh drive that is missing", drive_.address()), t);
    }
    names_ = true;
    // The fresh drive has taken all that was sent to the others for the beginning of a line: CR ends it. A LF before each line ends
    // what a drive in party mode whose name is its first letter has taken for its own. Each waits until the line is silent.
    for (const auto& raw :
         {std::string("\n"), std::string("\r"), fmt::format("DN=\"{}\"\r", drive_.address()), std::string("\n"), std::string("PY=1\r")}) {
        job().add({Step::What::bare, raw});
    }
    job().text = save ? fmt::format("a fresh drive answers to {} now, and has saved it", drive_.address())
                      : fmt::format("a fresh drive answers to {} now; program.save keeps it", drive_.address());
}

/// A drive that stays in single mode may lack the line's rate for its next restart.
void LineSetupAction::set_rate(bool save, Turn& t) {
    const int code = drive_.bus.rate_code;
    if (code == 0) {
        return refuse(Reason::not_supported,
                      "a drive at address ! stays in single mode; the rate of this line is not known or none that a drive has", t);
    }
    if (!drive_.ready()) {
        return refuse(
            Reason::wrong_state,
            fmt::format("no drive answers at {} bit/s: one with its factory values speaks at 9600. Give the line baud=9600; there set the "
                        "parameter BD, program.save, reset, and give the line its rate again",
                        rate_of(code)),
            t);
    }
    job().send(fmt::format("BD={}", code));
    if (save) job().send("S");
    job().text = fmt::format("{} keeps {} bit/s{}", name(), rate_of(code),
                             save ? " over a restart: BD is saved" : "; program.save keeps it over a restart");
    drive_.start.rate_set();
}

void LineSetupAction::sending(Step& step, Request& r) {
    if (!names_) return;
    r.text.clear();
    r.raw = step.text;
    r.kind = Expect::Kind::block;  // EM is not known: nothing may be said before its last prompt is over
    r.patience = {};
}

void LineSetupAction::done(Turn& t) {
    if (!std::exchange(names_, false)) return succeed(job().text, t);
    // It is looked for by its name, and given EM, CK and ES; S comes behind them, so that they are kept too.
    named_ = true;
    job().steps.clear();
    job().at = 0;
    job().give_up = t.now + 5s;
    if (drive_.bus.rate_code != 0) job().send(fmt::format("BD={}", drive_.bus.rate_code));
    if (std::get<Action>(job().command.body).argument == "save") job().send("S");
    drive_.start.probe_anew(t);
}

void LineSetupAction::came(Turn& t) {
    if (named() && job().steps.empty()) succeed(job().text, t);
}

void LineSetupAction::without_success(drive::Failure& how, Turn&) {
    if (how.dropped && named_) how.text += "; no fresh drive took the name, or more than one did: power up one alone";
}

// --- reset, factory_defaults -----------------------------------------------------------------------------------------------------

void Restart::plan(const Command& c, Turn& t) {
    if (std::get<Action>(c.body).name == "reset") {
        // CE is asked first: a drive that ignores the character must not be called restarted.
        job().ask("CE").send(std::string(reset_key), false);
        return;
    }
    if (drive_.link().party()) {
        return refuse(Reason::not_supported,
                      fmt::format("FD takes the name {} away and the drive leaves the party line: do it in single mode", drive_.address()),
                      t);
    }
    if (wait_for_rest(t)) job().send("FD", false);
}

void Restart::sending(Step& step, Request& r) {
    if (step.text != reset_key) return;
    // With CE = 2 the name stands right before it, at the beginning of a line.
    if (drive_.link().party()) r.raw = std::string(1, lf) + drive_.link().name;
    r.raw += ctrl_c;
    r.kind = Expect::Kind::nothing;
}

void Restart::answered(const std::string& data, Turn& t) {
    int& ce = drive_.words.ce;
    const bool party = drive_.link().party();
    const auto read = whole(data);
    ce = read && *read >= 0 && *read <= 2 ? static_cast<int>(*read) : 1;
    if (ce == 0) {
        return refuse(Reason::wrong_state, fmt::format("{} ignores CTRL+C (CE=0): write CE={} first", name(), party ? 2 : 1), t);
    }
    if (party && (ce == 1 || drive_.bus.reset_hits_others)) {
        return refuse(Reason::wrong_state,
                      fmt::format("{}: CTRL+C restarts every drive of this line that has CE=1: write CE=2 to {} first", name(),
                                  ce == 1 ? name() : std::string("the others")),
                      t);
    }
    drive_.jobs.step_done(t);
}

bool Restart::ended(const Step& step, Verdict v, Turn& t) {
    if (step.text == "FD" && v != Verdict::refused) {
        // Echo, checksum and name are the factory's now: no poll would be understood.
        job().give_up = t.now + 5s;
        drive_.programs.restarted();
        feedback().restarted(t);
        drive_.start.probe_anew(t);
        drive_.start.at_factory_rate();
        return true;
    }
    if (step.text != reset_key) return false;
    if (job().command.until_done) {
        awaited_ = drive_.jobs.hand_over().command;
        until_ = t.now + limit;
    } else {
        accept(fmt::format("{} restarts: it is looked for and set up again", name()), t);
    }
    drive_.fail_all(Reason::interrupted, fmt::format("{} was restarted by reset", name()), t);
    drive_.mode.restarted();
    drive_.programs.restarted();
    feedback().restarted(t);
    drive_.start.probe_anew(t);
    return true;
}

bool Restart::too_late(Instant now) const noexcept { return drive_.jobs.is(*this) && now >= drive_.jobs.job().give_up; }

void Restart::came(const std::string& rate_trouble, Turn& t) {
    over(Outcome::done, Reason::none, "has restarted and is set up again", t);
    if (drive_.jobs.is(*this))
        succeed(fmt::format("{} has its factory values{}{}", name(), rate_trouble.empty() ? "" : "; ", rate_trouble), t);
}

void Restart::watch(Turn& t) {
    if (awaited_ && !drive_.ready() && t.now >= until_)
        over(Outcome::failed, Reason::no_answer, "was restarted and is not set up again: see its link", t);
}

void Restart::over(Outcome o, Reason r, std::string_view what, Turn& t) {
    const auto c = std::exchange(awaited_, std::nullopt);
    if (c) drive_.tickets.answer(c->ticket, o, r, fmt::format("{}: {}", name(), what), t.out);
}

}  // namespace axisgate::mcode
