// Drive: parameters, native lines, and the actions of the family: programs, saving, setting up.
// In: commands, data of the drive. Out: steps, values, texts.
// Never sends program text that has not been checked as a whole.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "adapters/mcode/drive.hpp"
#include "adapters/mcode/native_program.hpp"
#include "adapters/mcode/parameters_variables.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

namespace {
std::string_view form_of(const Parameter& p) {
    const auto* f = p.wire.if_contains("form");
    return f && f->is_string() ? std::string_view(f->get_string()) : std::string_view("value");
}
bool is_link_word(std::string_view w) { return w == "PY" || w == "DN" || w == "CK" || w == "EM" || w == "ES"; }
}  // namespace

std::string Drive::word(const Parameter& p) const {
    const auto* w = p.wire.if_contains("word");
    return w && w->is_string() ? std::string(w->get_string()) : p.id;
}

std::optional<Value> Drive::value_of(const Parameter& p, std::string_view text) const {
    while (!text.empty() && text.front() == ' ')
        text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r' || text.back() == '\n'))
        text.remove_suffix(1);
    if (p.type == ValueType::text || p.type == ValueType::bytes) return Value{std::string(text)};
    double v = 0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (ec != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    if (p.type == ValueType::boolean) return Value{v != 0};
    if (p.type == ValueType::f32 || p.type == ValueType::f64) return Value{v};
    return Value{static_cast<std::int64_t>(std::llround(v))};
}

void Drive::plan_read(const ReadParameter& read, Turn& t) {
    const Parameter* p = drive_catalogue().parameter(read.point);
    if (!p) return job_over(Outcome::refused, Reason::unknown_point, "there is no such parameter", t);
    if (!p->readable())
        return job_over(Outcome::refused, Reason::not_supported,
                        fmt::format("{}: the drive tells nothing back about it: it can only be written", p->id), t);
    Step s;
    s.what = Step::What::query;
    s.text = word(*p);
    s.end_mark = true;
    job_.steps.push_back(std::move(s));
}

void Drive::plan_write(const WriteParameter& write, Turn& t) {
    const Parameter* p = drive_catalogue().parameter(write.point);
    if (!p) return job_over(Outcome::refused, Reason::unknown_point, "there is no such parameter", t);
    const std::string w = word(*p);
    if (is_link_word(w)) {
        return job_over(Outcome::refused, Reason::not_supported,
                        fmt::format("{} belongs to the line: set it with the line's options, or with line.setup", w), t);
    }
    if (form_of(*p) == "variables") {
        const std::string rows = to_text(write.value);
        std::istringstream in(rows);
        const Language language(catalogue_);
        std::string fault;
        for (std::string row; std::getline(in, row) && fault.empty();) {
            if (!row.empty() && row.back() == '\r') row.pop_back();
            if (row.find_first_not_of(' ') == std::string::npos) continue;
            if (auto line = variable_line(row, language, fault); !line.empty()) job_.add(Step::What::send, std::move(line));
        }
        if (fault.empty() && (job_.steps.empty() || job_.steps.size() > 192))
            fault = "write one variable or more, up to 192, each in a line of its own";
        if (!fault.empty()) return job_over(Outcome::refused, Reason::out_of_range, fault, t);
        Step s;
        s.what = Step::What::query;
        s.text = w;
        s.end_mark = true;
        job_.steps.push_back(std::move(s));
        return;
    }
    const bool quoted = form_of(*p) == "text";
    std::string text = to_text(write.value);
    if (const auto* b = std::get_if<bool>(&write.value)) text = *b ? "1" : "0";
    std::string line = quoted ? fmt::format("{}=\"{}\"", w, text) : fmt::format("{}={}", w, text);
    if (auto why = check_line(line); !why.empty())
        return job_over(Outcome::refused, Reason::out_of_range, fmt::format("{}: {}", w, why), t);
    job_.add(Step::What::send, std::move(line));
    if (p->readable() && !quoted) {
        Step s;
        s.what = Step::What::query;
        s.text = w;
        s.end_mark = true;
        job_.steps.push_back(std::move(s));
    }
}

void Drive::query_answered(const std::string& data, Turn& t) {
    if (job_.kind == JobKind::relearn) {
        learn_values(data);
        return job_over(Outcome::done, Reason::none, {}, t);
    }
    if (job_.kind == JobKind::restart) {
        ce_ = data.size() == 1 && data[0] >= '0' && data[0] <= '2' ? data[0] - '0' : 1;
        if (ce_ == 0) {
            return job_over(Outcome::refused, Reason::wrong_state,
                            fmt::format("{} ignores CTRL+C (CE=0): write CE={} first", name(), link().party() ? 2 : 1), t);
        }
        if (link().party() && (ce_ == 1 || manners_.reset_hits_others)) {
            return job_over(Outcome::refused, Reason::wrong_state,
                            fmt::format("{}: CTRL+C restarts every drive of this line that has CE=1: write CE=2 to {} first", name(),
                                        ce_ == 1 ? name() : std::string("the others")),
                            t);
        }
        return step_done(t);
    }
    if (job_.kind == JobKind::shape) {
        demand_.shape(data == "0,1,1");
        return job_over(Outcome::done, Reason::none, {}, t);
    }
    if (job_.kind == JobKind::download) {
        std::istringstream rows(data);
        const std::string want = normal_form(job_.steps[job_.at - 1].text);
        for (std::string row; std::getline(rows, row);) {
            if (normal_form(row).starts_with(want)) return step_done(t);
        }
        return setting_refused("was refused with error 6: a point has this type already", t);
    }
    const CommandBody& b = job_.command.body;
    const auto* read = std::get_if<ReadParameter>(&b);
    const auto* write = std::get_if<WriteParameter>(&b);
    const Parameter* p = drive_catalogue().parameter(read ? read->point : write ? write->point : Point{0xFFFF, 0});
    if (!p) return step_done(t);
    if (write && job_.text == already_typed) {
        const auto row = [](std::string_view s) {
            std::string bare;
            for (const char c : s)
                if (c != ' ' && c != '\r') bare += c;
            return bare;
        };
        const std::string have = '\n' + row(data) + '\n';
        if (have.find('\n' + row(job_.steps[0].text) + '\n') == std::string::npos) {
            return job_over(Outcome::refused, Reason::drive_refused,
                            fmt::format("{}: {} was refused with error 6: a point has this type already; give it type {} first", name(),
                                        job_.steps[0].text, p->id == "IS" ? 0 : 16),
                            t, 6);
        }
    }
    const auto v = value_of(*p, data);
    if (!v) {
        if (write) return job_over(Outcome::done, Reason::none, data, t, 0, write->value);
        return job_over(Outcome::failed, Reason::not_supported,
                        fmt::format("{} answered {} with \"{}\", which is no {}", name(), p->id, data, name_of(p->type)), t);
    }
    const Point point = read ? read->point : write->point;
    t.out.samples.push_back({axis_, point, *v, Quality::good, t.now});
    const std::string w = word(*p);
    const auto number = p->wire.contains("variable") ? std::nullopt : as_integer(*v);
    if (number) demand_.value(w, *number);
    if (number && w == "VI") vi_ = user_vi_ = *number;
    if (number && w == "VM") vm_ = *number;
    if (number && w == "A") a_ = *number;
    if (number && w == "D") d_ = *number;
    if (number && w == "EE") encoder_flag_ = *number == 1;
    if (number && w == "CE") ce_ = static_cast<int>(*number);
    if (write && (w == "MS" || w == "EE" || w == "AS")) {
        vi_ = user_vi_ = vm_ = a_ = d_ = 0;  // the drive has scaled them [L4293]
        demand_.knows({0, 0, 0, 0, encoder_flag_});
        relearn_ = true;
    }
    if (w == "ER" && number && *number == 0 && last_error_ != 0) {
        // The gateway has read the code already, and reading clears it in the drive.
        return job_over(Outcome::done, Reason::none, {}, t, 0, Value{static_cast<std::int64_t>(last_error_)});
    }
    job_over(Outcome::done, Reason::none, {}, t, 0, *v);
}

void Drive::plan_native(const Native& native, Turn& t) {
    std::string line(native.send.begin(), native.send.end());
    // Bytes are the same line, with its end or without: the end, the name and the checksum are the line's own business.
    if (!native.is_text && line.ends_with('\n')) line.pop_back();
    if (!native.is_text && line.ends_with('\r')) line.pop_back();
    if (auto why = check_line(line); !why.empty()) return job_over(Outcome::refused, Reason::out_of_range, why, t);
    const std::string w = word_of(line);
    if (w.starts_with("PG") && w.find_first_not_of("0123456789", 2) == std::string::npos)  // PG1 means PG 1 [L7052]
        return job_over(Outcome::refused, Reason::not_supported,
                        "PG would take the polls into the program: use the action program.download", t);
    if (is_link_word(w) && line.find('=') != std::string::npos) {
        return job_over(Outcome::refused, Reason::not_supported,
                        fmt::format("{} belongs to the line: set it with the line's options, or with line.setup", w), t);
    }
    if (w == "CE" && line.find('=') != std::string::npos) ce_ = 1;  // until it is read: perhaps
    const bool output = w == "PR" || w == "L";
    job_.add(output ? Step::What::block : Step::What::send, line, false);
}

/// A block is over when the question behind it was answered, which is a poll: it says as well whether the drive complained.
void Drive::block_came(Verdict v, const ReplyReader& r, Turn& t) {
    const std::string line = job_.steps[job_.at].text;
    if (v != Verdict::answered || r.overflowed() || !learn_poll(r.data(), t)) {
        if (v == Verdict::waiting) count_silence(t);
        if (job_.kind == JobKind::none) return;
        return job_over(Outcome::failed, Reason::no_answer,
                        r.raw().empty() ? fmt::format("{} did not answer {}", name(), line)
                                        : fmt::format("the end of what {} answers to {} was not heard: ask again", name(), line),
                        t);
    }
    job_.listing = r.block();
    if (!ef_) {
        last_error_ = 0;
        return block_ended(t);
    }
    job_.said = sums_ && job_.listing.find(nak) != std::string::npos ? Verdict::refused : Verdict::acknowledged;
    job_.confirming = need_error_ = true;
    error_is_ours_ = job_.said == Verdict::refused || !sums_ || quiet();  // an ACK means: no error [L2081]
}

void Drive::block_ended(Turn& t) {
    const std::string sent = request(link(), job_.steps[job_.at].text);
    const std::string text = plain_text(job_.listing, std::string_view(sent).substr(0, sent.size() - 1), sums_);
    if (sums_ && job_.listing.find(nak) != std::string::npos && text.empty()) {
        return job_over(Outcome::refused, Reason::drive_refused, fmt::format("{} refused {}", name(), job_.steps[job_.at].text), t);
    }
    if (sums_ && !block_sums_good(job_.listing)) {
        ++counters_.garbled;
        if (++job_.tries <= manners_.retries && job_.kind != JobKind::native) return;
        return job_over(Outcome::failed, Reason::no_answer,
                        fmt::format("what {} answers to {} does not fit its checksum", name(), job_.steps[job_.at].text), t);
    }
    if (job_.kind == JobKind::tidy) return tidy_up(text, t);
    if (job_.kind == JobKind::clear) return clear_if_half(text, t);
    if (job_.kind == JobKind::survey) return variables_listed(text, t);
    if (job_.kind == JobKind::edit) return edit_listed(text, t);
    if (job_.kind == JobKind::upload) {
        std::string program;
        for (const auto& l : listed_lines(text))
            program += l + '\n';
        return job_over(Outcome::done, Reason::none, program, t, 0, Value{program});
    }
    if (job_.kind == JobKind::download) {
        std::size_t count = 0;
        if (const auto why = listing_fault(job_.program, text, count); !why.empty()) {
            return job_over(Outcome::failed, Reason::drive_refused, fmt::format("{}: {}; {}", name(), why, memory_is_half()), t);
        }
        const auto& lines = job_.program;
        const bool saved = !lines.empty() && lines.back().kind == ProgramLine::Kind::setting && word_of(lines.back().text) == "S";
        return job_over(
            Outcome::done, Reason::none,
            fmt::format("{} statements stored and verified; {}", count, saved ? "its line S has saved them" : "program.save keeps them"),
            t);
    }
    job_over(Outcome::done, Reason::none, text, t, 0, Value{text});
}

void Drive::download_failed(std::string why, Turn& t) {
    const bool touched = job_.memory_touched;
    if (touched) keep_half();
    relearn_ = relearn_ || touched;
    job_over(Outcome::failed, Reason::interrupted, fmt::format("{}: {}{}", name(), why, touched ? "; " + memory_is_half() : ""), t);
}

/// Program mode is left first (drive_mode.cpp); CP then removes the half, behind every stop that waits, also when the drive was away.
void Drive::keep_half() {
    clear_half_ = true;
    half_was_away_ = false;
    half_from_ = job_.from;
    half_ = job_.stays;
    for (std::size_t i = 0; i <= job_.at && i < job_.steps.size(); ++i) {
        const Step& s = job_.steps[i];
        if (s.what == Step::What::bare && word_of(s.text) != "PG" && word_of(s.text) != "VA") half_.push_back(normal_form(s.text));
    }
}

/// A line outside of PG and PG. Before them the memory is empty, behind them it holds the program; only between two parts there is a half.
void Drive::setting_refused(const std::string& why, Turn& t) {
    const Step step = job_.steps[job_.at];
    const auto is_part = [](const Step& s) { return s.what == Step::What::bare; };
    const auto here = job_.steps.begin() + static_cast<std::ptrdiff_t>(job_.at);
    const bool begun = std::any_of(job_.steps.begin(), here, is_part), more = std::any_of(here, job_.steps.end(), is_part);
    if (begun && more) keep_half();
    relearn_ = true;
    const int code = last_error_;
    const ErrorCode* e = catalogue_.error(code);
    job_over(
        Outcome::failed, code != 0 ? Reason::drive_refused : Reason::no_answer,
        fmt::format("{}: line {}: {} {}{}; {}", name(), step.line,
                    step.what == Step::What::query ? job_.steps[job_.at - 1].text : step.text, why,
                    code != 0 && e ? ", " + e->text : std::string(), begun && !more ? "the program before it is stored" : memory_is_half()),
        t, code);
}

/// Actions for which the drive must not move: behind a stop or the end of a move MV stays 1 for MT + HT, which is waited for.
/// false: it moves, and the job is over.
bool Drive::wait_for_rest(Turn& t) {
    if (!mv_ && !fb_.moving) return true;
    const bool homes = motion_.kind == Motion::Kind::home && !motion_.ended;
    if (torque_ || homes || (!stopping_ && (fb_.velocity != 0 || vc_))) {
        job_over(Outcome::refused, Reason::wrong_state, fmt::format("{} moves: stop it first", name()), t);
        return false;
    }
    job_.add(Step::What::standstill, "standstill");
    job_.give_up = t.now + 70s;  // MT + HT are 65.535 s at most [L3241]
    next_poll_ = t.now;
    return true;
}

void Drive::plan_download(const Action& a, Turn& t) {
    if (running_) {
        return job_over(Outcome::refused, Reason::wrong_state, fmt::format("a program runs in {}: end it first (program.end)", name()), t);
    }
    auto checked = check_program(a.argument, Language(catalogue_));
    if (!checked.fault.empty()) {
        return job_over(Outcome::refused, Reason::out_of_range, fmt::format("the program was not sent; {}", checked.fault), t);
    }
    if (!wait_for_rest(t)) return;
    job_.kind = JobKind::download;
    mode_doubt_ = false;
    tidy_ = false;
    job_.add(Step::What::send, "CP 1");
    for (const auto& l : checked.lines) {
        const bool setting = l.kind == ProgramLine::Kind::setting;
        const auto w = word_of(l.text);
        job_.add(setting ? Step::What::send : Step::What::bare, l.text, setting && w != "IC" && w != "DC");
        job_.steps.back().line = l.number;
        relearn_ = relearn_ || setting;
    }
    job_.add(Step::What::block, "L");
    job_.program = std::move(checked.lines);
}

/// line.setup of a drive that stays in single mode: what it may lack is the line's rate for its next restart.
void Drive::plan_rate(const Action& a, Turn& t) {
    const auto refuse = [&](Reason r, std::string why) { job_over(Outcome::refused, r, std::move(why), t); };
    if (!a.argument.empty() && a.argument != "save") {
        return refuse(Reason::out_of_range, fmt::format("line.setup {}: write save, or nothing", a.argument));
    }
    if (manners_.rate_code == 0) {
        return refuse(Reason::not_supported,
                      "a drive at address ! stays in single mode; the rate of this line is not known or none that a drive has");
    }
    if (phase_ != Phase::ready) {
        return refuse(
            Reason::wrong_state,
            fmt::format("no drive answers at {} bit/s: one with its factory values speaks at 9600. Give the line baud=9600; there set the "
                        "parameter BD, program.save, reset, and give the line its rate again",
                        rate_of(manners_.rate_code)));
    }
    const bool save = a.argument == "save";
    job_.add(Step::What::send, fmt::format("BD={}", manners_.rate_code));
    if (save) job_.add(Step::What::send, "S");
    job_.text = fmt::format("{} keeps {} bit/s{}", name(), rate_of(manners_.rate_code),
                            save ? " over a restart: BD is saved" : "; program.save keeps it over a restart");
    bd_ = manners_.rate_code;
}

void Drive::plan_action(const Action& a, Turn& t) {
    const auto refuse = [&](Reason r, std::string why) { job_over(Outcome::refused, r, std::move(why), t); };
    const auto line = [&](std::string text, bool repeatable = true) {
        const auto w = word_of(text);
        // Refused by the drive while MV is 1, which a finished move leaves behind; what really moves is the drive's to refuse.
        const bool at_rest = w == "S" || w == "CP" || w == "IP" || w == "SC";
        const bool goes = torque_ || (motion_.kind == Motion::Kind::home && !motion_.ended) || (!stopping_ && (fb_.velocity != 0 || vc_));
        if (at_rest && mv_ && !goes) (void)wait_for_rest(t);
        job_.add(Step::What::send, std::move(text), repeatable);
    };
    if (a.name == "program.list") {
        job_.kind = JobKind::list;
        job_.add(Step::What::block, a.argument.empty() ? "L" : fmt::format("L {}", a.argument));
    } else if (a.name == "program.upload") {
        job_.kind = JobKind::upload;
        job_.add(Step::What::block, "L");
    } else if (a.name == "program.download") {
        return plan_download(a, t);
    } else if (a.name == "program.edit") {
        return plan_edit(a, t);
    } else if (a.name == "program.start") {
        job_.awaits_end = job_.command.until_done;
        line(fmt::format("EX {}", a.argument.empty() ? "1" : a.argument), false);
    } else if (a.name == "program.pause") {
        line("PS");
    } else if (a.name == "program.resume") {
        line("RS");
    } else if (a.name == "program.end") {
        line("E");
    } else if (a.name == "program.clear") {
        tidy_ = tidy_ && !a.argument.empty();
        line(a.argument.empty() ? "CP" : fmt::format("CP {}", a.argument));
    } else if (a.name == "program.save") {
        line("S");
    } else if (a.name == "restore") {
        line("IP");
    } else if (a.name == "clear_locked_rotor") {
        line("CF");
    } else if (a.name == "calibrate") {
        line("SC 1", false);
    } else if (a.name == "factory_defaults") {
        if (link().party()) {
            return refuse(
                Reason::not_supported,
                fmt::format("FD takes the name {} away and the drive leaves the party line: do it in single mode", setup_.address));
        }
        if (!wait_for_rest(t)) return;
        job_.kind = JobKind::factory;
        line("FD", false);
    } else if (a.name == "line.setup") {
        if (!link().party()) return plan_rate(a, t);
        if (!a.argument.empty() && a.argument != "save") {
            return refuse(Reason::out_of_range, fmt::format("line.setup {}: write save, or nothing", a.argument));
        }
        if (phase_ == Phase::ready) {
            return refuse(Reason::wrong_state,
                          fmt::format("a drive answers to {} already: line.setup names the fresh drive that is missing", setup_.address));
        }
        job_.kind = JobKind::setup;
        // The fresh drive has taken all that was said to the others for the beginning of a line: CR ends it. A LF before each line ends
        // what a drive in party mode whose name is its first letter has taken for its own. Each waits until the line is silent.
        for (const auto& raw :
             {std::string("\n"), std::string("\r"), fmt::format("DN=\"{}\"\r", setup_.address), std::string("\n"), std::string("PY=1\r")}) {
            job_.add(Step::What::bare, raw);
        }
        job_.text = a.argument.empty() ? fmt::format("a fresh drive answers to {} now; program.save keeps it", setup_.address)
                                       : fmt::format("a fresh drive answers to {} now, and has saved it", setup_.address);
    } else if (a.name == "reset") {
        // CE is asked first: a drive that ignores the character must not be called restarted.
        job_.kind = JobKind::restart;
        Step ask;
        ask.what = Step::What::query;
        ask.text = "CE";
        job_.steps.push_back(std::move(ask));
        job_.add(Step::What::send, std::string(reset_key), false);
        return;
    } else {
        const std::string w = word_of(a.name);
        if (w == a.name && (w == "AL" || w == "UV")) {  // keywords of PR
            job_.kind = JobKind::list;
            job_.add(Step::What::block, "PR " + w);
            return;
        }
        const bool known = w == a.name && std::ranges::any_of(catalogue_.commands(), [&](const CatalogueCommand& c) { return c.id == w; });
        if (!known || w == "PG" || w == "PR" || w == "L" || w == "FD" || w == "UG") {
            return refuse(Reason::unknown_point, fmt::format("there is no action {}; see the family's commands", a.name));
        }
        std::string text = a.argument.empty() ? w : fmt::format("{} {}", w, a.argument);
        if (auto why = check_line(text); !why.empty()) return refuse(Reason::out_of_range, why);
        line(std::move(text), false);
    }
    for (const auto& s : job_.steps) {
        if (job_.kind == JobKind::setup) break;
        if (auto why = check_line(s.text); !why.empty()) return refuse(Reason::out_of_range, fmt::format("{}: {}", a.name, why));
    }
}

}  // namespace axisgate::mcode
