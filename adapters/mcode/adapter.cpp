// Adapter of MCode: the line's discipline. Every call ends with pump(): a free line is given away at once.
// In: what the engine calls. Out: the next exchange; what has come beside an answer goes to the drive that it can be of.
// Never takes a late ACK for a new one: after a time-out, lines whose answer has no mark wait until late answers are over.
#include "adapters/mcode/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/core/only_reads.hpp"
#include "gateway/drive/option_reader.hpp"
#include "gateway/drive/text_lines.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

namespace {
constexpr std::string_view marks = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
constexpr drive::Timing default_timing{.reply_timeout = 120ms};
}  // namespace

// --- setup -----------------------------------------------------------------------------------------------------------------------

void LineAdapter::take(const LineSetup& setup, Turn& t) {
    bus_.take(setup, default_timing);
    drive::OptionReader options(setup.options);
    bus_.only_reads = only_reads(setup.options);
    bus_.ethernet = options.flag("ethernet", false);
    bus_.em = static_cast<int>(options.whole("em", 0, 3, 1));
    const auto ck = static_cast<int>(options.whole("ck", 0, 2, 1));
    bus_.ck = bus_.ethernet ? 0 : ck;
    bus_.rate_code = bus_.ethernet ? 0 : code_of(setup.bit_rate);
    drive::tell_faults(options, t);
    bus_.turns.set({.pause = bus_.timing.pause});
}

std::string LineAdapter::fault(const DriveSetup& d, const LineSetup& line) const {
    if (std::string why = check_address(d.address); !why.empty()) return why;
    if (d.address == "!" && line.drives.size() > 1)
        return "a drive in single mode (address !) must be alone on its line: give every drive a name";
    const Drive* other = drives().find([&](const Drive& o) { return o.address() == d.address; });
    return other ? fmt::format("the name {} belongs to drive {} already", d.address, other->name()) : std::string();
}

std::unique_ptr<Drive> LineAdapter::make(const DriveSetup& s, std::size_t slot, Turn&) { return std::make_unique<Drive>(bus_, s, slot); }

void LineAdapter::leaving(Drive& d, Turn& t) {
    bus_.turns.remove(d.slot());
    if (flight_.drive == &d) {
        late_.missed(t.now, std::max(flight_.deadline - t.now, Duration{}));  // its answer may still be on its way
        flight_ = {};
    }
    if (late_drive_ == &d) late_drive_ = nullptr;
    if (answered_ == &d) answered_ = nullptr;
    for (auto& m : missed_)
        if (m.drive == &d) m = {};
}

void LineAdapter::line_changed(Turn& t) {
    bus_.turns.line_changed(t.now);
    flight_ = {};
    stray_.clear();
    late_drive_ = nullptr;
    answered_ = nullptr;
    missed_ = {};
    gaps_.line_changed();
    resync_ = true;
    late_.settled();
}

// --- what comes beside answers ---------------------------------------------------------------------------------------------------

void LineAdapter::stray(std::string_view bytes, Turn& t) {
    for (const char c : bytes) {
        if (c == lf) {
            stray_line(t);
        } else if (c != ack && c != nak && c != '\0' && stray_.size() < 256) {
            // A checksum stands before CR; what goes on behind such a byte was spoiled before it.
            if (c != cr && !stray_.empty() && static_cast<std::uint8_t>(stray_.back()) > 0x7E) stray_.clear();
            stray_ += c;
        }
    }
}

/// A whole line that nobody asked for: output of a program, an answer that came too late or twice; or nothing but an acknowledgement.
void LineAdapter::stray_line(Turn& t) {
    std::string_view line = stray_;
    line.remove_prefix(std::min(line.find_first_not_of(">?\r"), line.size()));
    line = line.substr(0, line.find_last_not_of('\r') + 1);
    if (!line.empty() && !marked(line, t)) {
        ++bus_.counters.unexpected;
        std::size_t on_line = 0;
        Drive *any = nullptr, *printing = nullptr;
        drives().each([&](Drive& d) {
            ++on_line;
            any = &d;
            if (!printing && d.feedback.may_print(t.now)) printing = &d;
        });
        if (Drive* from = on_line == 1 ? any : printing) from->foreign(line, t);
    }
    stray_.clear();
}

/// It begins with the mark of a question: one that was answered already (two drives have one name), or one that was given up.
bool LineAdapter::marked(std::string_view line, Turn& t) {
    if (line.size() < 3 || line[0] != '#' || line[2] == '"') return false;
    if (answered_ && line.starts_with(answered_mark_) && !answered_mark_.empty()) {
        answered_->trouble(Trouble::Kind::twice, t);
        answered_mark_.clear();
        return true;
    }
    const auto at = marks.find(line[1]);
    if (at == std::string_view::npos || !missed_[at].drive || t.now - missed_[at].at > 10s) return false;
    ++bus_.counters.unexpected;
    missed_[at].drive->trouble(Trouble::Kind::late, t);
    missed_[at] = {};
    return true;
}

/// What an exchange has brought beside its answer: its echo is taken out, the rest is as if nobody had been asked.
void LineAdapter::gather(Verdict v, Turn& t) {
    const bool settled = v != Verdict::waiting && v != Verdict::garbled && flight_.kind != Expect::Kind::nothing;
    const bool answered = settled && v != Verdict::refused;
    const std::string& sent = flight_.sent;
    std::string before = answered ? reader_.before() : reader_.raw();
    for (auto at = sent.empty() ? std::string::npos : before.find(sent); at != std::string::npos; at = before.find(sent, at))
        before.erase(at, sent.size());
    // A drive gives its line back without its name [L6840-6860].
    const std::string_view nameless = std::string_view(sent).substr(sent.empty() ? 0 : 1);
    if (before.starts_with(nameless)) before.erase(0, nameless.size());
    if (settled || drives().find([&](const Drive& d) { return d.feedback.may_print(t.now); })) stray(before, t);
    if (!answered) return;
    if (flight_.kind == Expect::Kind::query) {
        answered_mark_ = fmt::format("#{}", marks[mark_]);
        answered_ = flight_.drive;
    }
    stray(reader_.behind(), t);
}

// --- one exchange ----------------------------------------------------------------------------------------------------------------

void LineAdapter::arrived(const Frame& frame, Turn& t) {
    if (!bus_.is_run(frame)) return;
    const Instant now = t.now;
    const std::string_view bytes = drive::text_of(frame);
    // Neither a listing nor the echo of a command is printed by a program; a question is known by its mark.
    const bool echoed = flight_.drive && (flight_.drive->words.em == 0 || flight_.drive->words.em == 3);
    if (!flight_.drive || flight_.kind == Expect::Kind::query || (flight_.kind != Expect::Kind::block && !echoed)) gaps_.heard(bytes, now);
    if (!flight_.drive) return stray(bytes, t);
    const Verdict v = reader_.push(bytes);
    if (flight_.kind == Expect::Kind::block && v == Verdict::waiting) {
        // A drive that is still speaking must not be spoken to; behind the closing question its answer is waited for.
        const Duration silence = bus_.timing.reply_timeout / 2 + bus_.wire(24);
        flight_.deadline = std::min(flight_.latest, reader_.closing() ? std::max(flight_.deadline, now + silence) : now + silence);
    } else if (flight_.ends && v == Verdict::garbled) {
        flight_.deadline = now;  // the closing answer was spoiled: asked again
    } else if (v == Verdict::waiting && (reader_.maybe_refused() || reader_.awaits_trailing())) {
        // Speaking into an answer that still comes would spoil the next one too. 25 ms: what USB converters hold bytes back, and more.
        flight_.deadline = std::min(flight_.latest, now + 25ms + bus_.wire(16));
    } else if (v == Verdict::waiting) {
        // Half an answer: the rest is on its way, but noise must not hold the line for ever.
        flight_.deadline = std::min(flight_.latest, std::max(flight_.deadline, now + 10ms + bus_.wire(16)));
    } else {
        finish(v, t);
    }
}

void LineAdapter::send(std::string_view bytes, Priority priority, Turn& t, Ticket order) const {
    for_each_run(drive::bytes_of(bytes), [&](const Frame& f) { t.out.send(f, priority, order); });
}

std::string LineAdapter::next_mark() {
    mark_ = (mark_ + 1) % static_cast<unsigned>(marks.size());
    return fmt::format("#{}", marks[mark_]);
}

void LineAdapter::start(Drive& d, Turn& t) {
    bus_.reset_hits_others = drives().find([&](const Drive& o) { return &o != &d && o.receives_every_reset(); }) != nullptr;
    Request r = d.next(t);
    Expect e{r.kind, {}, r.end_mark, d.words.sums, d.words.em == 0, r.ends};
    std::string bytes = r.raw;
    if (bytes.empty() && r.kind == Expect::Kind::query) {
        e.mark = next_mark();
        bytes = request(d.link(), fmt::format("PR \"{}\",{}{}", e.mark, r.text, r.end_mark ? ",\"~\"" : ""));
    } else if (bytes.empty()) {
        bytes = request(d.link(), r.text);
    }
    if (r.kind == Expect::Kind::command && d.quiet()) e.kind = Expect::Kind::nothing;
    flight_ = {.drive = &d, .kind = e.kind, .sent = bytes.substr(0, bytes.size() - (r.raw.empty() ? 1 : 0)), .ends = r.ends};
    e.sent = flight_.sent;
    e.trailing = d.words.em == 1 && d.trailing.expected();
    // A LF ends what was cut off; where nothing was it does no harm (E-68).
    const bool lead = d.link().party() && !d.line_setup.naming() && (r.wake || resync_);
    if (lead) bytes.insert(bytes.begin(), lf);
    resync_ = resync_ && !lead;
    d.mode.led(lead || !d.link().party());
    d.feedback.received_at = t.now + bus_.wire(bytes.size());
    const Duration expected = e.kind == Expect::Kind::nothing ? Duration{20ms} : bus_.timing.reply_timeout + bus_.wire(64) + r.patience;
    flight_.deadline = d.feedback.received_at + expected;
    // Drives that echo one another without end (line.setup with two fresh ones) hold the line for a second at most.
    flight_.latest = flight_.deadline + (e.kind != Expect::Kind::block ? bus_.wire(512) + 200ms
                                         : r.raw.empty()               ? bus_.wire(ReplyReader::limit) + 60s
                                                                       : Duration{1s});
    reader_.begin(std::move(e));
    d.turnaround.sends(t.now);
    bus_.turns.began(d.slot(), false);
    send(bytes, r.urgent ? Priority::urgent : r.purpose == Request::Purpose::poll ? Priority::poll : Priority::command, t, r.order);
}

/// The line is silent behind a block: the question whose answer is its end. false: that was in vain, or it is no such block.
bool LineAdapter::close_block(Turn& t) {
    if (!flight_.ends || flight_.closings > bus_.timing.retries || t.now >= flight_.latest) return false;
    ++flight_.closings;
    Drive& d = *flight_.drive;
    const std::string mark = next_mark();
    const std::string bytes = request(d.link(), fmt::format("PR \"{}\",{}", mark, d.feedback.poll_items(t.now)));
    reader_.close_with(mark, bytes.substr(0, bytes.size() - 1));
    d.feedback.received_at = t.now + bus_.wire(bytes.size());
    flight_.deadline = d.feedback.received_at + bus_.timing.reply_timeout + bus_.wire(64);
    send(bytes, Priority::command, t);
    return true;
}

/// A request was lost if nothing of its answer has come. A refusal says neither: the beginning of the request may be missing. Lines that
/// nobody acknowledges are judged by what is read behind them.
void LineAdapter::learn_manners(Drive& d, const Flight& f, Verdict v, Turn& t) {
    if (v != Verdict::waiting && f.kind != Expect::Kind::nothing) d.turnaround.answered(t.now);
    if (f.kind == Expect::Kind::nothing) return;
    if (v == Verdict::answered || v == Verdict::acknowledged) {
        d.turnaround.received(d.turnaround.at_once());
    } else if (v == Verdict::waiting && reader_.nothing_of_it()) {
        (void)d.turnaround.lost(d.turnaround.at_once());
    }
    // The EM of a drive that is being looked for is not known yet.
    const bool known = d.ready() || d.presence.is(drive::Presence::Phase::starting);
    if (f.kind == Expect::Kind::query && v == Verdict::answered && known && d.words.em == 1) d.trailing.stood(reader_.acknowledgement());
}

void LineAdapter::finish(Verdict v, Turn& t) {
    Drive& d = *flight_.drive;
    if (flight_.kind != Expect::Kind::block) gather(v, t);
    const Flight f = std::exchange(flight_, {});
    bus_.turns.ended(d.slot());
    gaps_.ended(v == Verdict::waiting || v == Verdict::garbled || v == Verdict::refused, t.now);
    if (!f.to_all) learn_manners(d, f, v, t);
    bus_.turns.set({.pause = std::max(bus_.timing.pause, d.turnaround.pause())});
    bus_.turns.received(t.now);
    if (f.to_all) return;
    if (v == Verdict::waiting) {
        late_drive_ = &d;
        late_.missed(t.now, 2 * bus_.timing.reply_timeout);
        resync_ = true;
        if (f.kind == Expect::Kind::query) missed_[mark_] = {&d, t.now};
        if (!d.away()) drives().each([](Drive& o) { o.mode.line_missed(); });
    } else if ((f.kind == Expect::Kind::query || f.ends) && v == Verdict::answered && late_drive_ == &d) {
        late_drive_ = nullptr;  // a drive answers in order: nothing older can come any more
        late_.settled();
    }
    d.ended(v, reader_, t);
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    if (flight_.drive && now >= flight_.deadline && !close_block(t)) finish(reader_.give_up(), t);
    end(t);
}

// --- whose turn it is ------------------------------------------------------------------------------------------------------------

/// Every drive in reach is to be stopped by the same line, and two or more have not heard it: it goes to `*` once [L5004], and each is
/// then read. Not in single mode, nor with checksums in some drives only, nor when one drive shall go on: then one by one.
/// A drive with DG = 0 answers [L2399]: that is over before the next question, whose mark no such answer has.
bool LineAdapter::stop_all_at_once(Turn& t) {
    std::string line;
    Drive* first = nullptr;
    std::size_t unsent = 0;
    const Drive* other = drives().find([&](const Drive& d) {
        if (!d.in_reach()) return false;
        const std::string_view own = d.stops.line();
        if (own.empty() || !d.link().party() || (first && (own != line || d.words.sums != first->words.sums))) return true;
        line = own;
        if (!first) first = drives().at(d.slot());
        unsent += d.stops.confirming() ? 0 : 1;
        return false;
    });
    if (other || unsent < 2) return false;
    std::string bytes = request({'*', first->words.sums}, line);
    flight_ = {.drive = first, .kind = Expect::Kind::nothing, .sent = bytes.substr(0, bytes.size() - 1), .to_all = true};
    if (std::exchange(resync_, false)) bytes.insert(bytes.begin(), lf);
    flight_.deadline = flight_.latest = t.now + bus_.wire(bytes.size()) + 20ms;
    reader_.begin({Expect::Kind::nothing, {}, false, false, false});
    drives().each([&](Drive& d) { d.stops.taken_by_all(t.now + bus_.wire(bytes.size())); });
    bus_.turns.began(first->slot(), false);
    send(bytes, Priority::urgent, t);
    return true;
}

/// A stop is sent at once for the first time, whatever the line carries: on lines with a pair for each direction the drive hears it. Its
/// repetitions find the gaps.
bool LineAdapter::stop_unsent(Instant now) {
    return drives().find([now](const Drive& d) { return d.wants(now) == drive::Want::urgent; }) != nullptr;
}

/// Each drive's wish, as far as the line lets it have one: line.setup keeps the line to itself but from stops.
void LineAdapter::settle_all(Instant now) {
    const Drive* naming = drives().find([](const Drive& d) { return d.line_setup.naming(); });
    drives().each([&](Drive& d) {
        using drive::Want;
        const Want want = d.wants(now);
        const bool stops = want == Want::urgent || want == Want::command;
        if (want == Want::nothing || stops || !(naming || held(d, now))) return bus_.turns.settle(d.slot(), want, never, d.wish());
        bus_.turns.settle(d.slot(), Want::nothing, never, naming || late_.over(now) ? never : late_.until());
    });
}

void LineAdapter::end(Turn& t) {
    if (!up()) return;
    looked_at_ = t.now;
    while (!flight_.drive && (gaps_.from(t.now) <= t.now || stop_unsent(t.now))) {
        settle_all(t.now);
        const auto slot = bus_.turns.next(t.now);
        if (!slot) return;
        if (!stop_all_at_once(t)) start(*drives().at(*slot), t);
    }
}

/// After a time-out: lines wait until late answers are over, and the drive that was late is not asked again while one waits for that.
bool LineAdapter::held(const Drive& d, Instant now) const noexcept {
    if (d.wants_unmarked(now)) return !late_.over(now);
    return &d == late_drive_ && drives().find([now](const Drive& o) { return o.wants_unmarked(now); });
}

Instant LineAdapter::deadline() const {
    if (!up()) return never;
    if (flight_.drive) return flight_.deadline;
    const Instant gap = gaps_.from(looked_at_);  // until then nobody was asked what it wants
    return gap > looked_at_ ? gap : std::max(bus_.turns.deadline(), looked_at_);
}

}  // namespace axisgate::mcode
