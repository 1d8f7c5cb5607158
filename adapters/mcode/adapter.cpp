// Adapter of MCode: the line's discipline. Every call ends with pump(): a free line is given away at once.
// In: what the engine calls. Out: the next exchange; what has come beside an answer goes to the drive that it can be of.
// Never takes a late ACK for a new one: after a time-out, lines whose answer has no mark wait until late answers are over.
#include "adapters/mcode/adapter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "gateway/core/wire_time.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

namespace {
bool same(const DriveSetup& a, const DriveSetup& b) {
    if (a.id != b.id || a.name != b.name || a.address != b.address || a.options != b.options || a.axes.size() != b.axes.size())
        return false;
    return std::ranges::equal(a.axes, b.axes,
                              [](const AxisSetup& x, const AxisSetup& y) { return x.id == y.id && x.channel == y.channel; });
}
constexpr std::string_view marks = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
}  // namespace

Duration LineAdapter::wire(std::size_t bytes) const noexcept {
    return wire_time(std::uint64_t{bytes} * setup_.bits_per_byte, setup_.bit_rate);
}

void LineAdapter::take_manners(const LineSetup& setup, Turn& t) {
    const LineManners& m = setup.manners;
    const auto or_else = [](Duration d, Duration otherwise) { return d > Duration::zero() ? d : otherwise; };
    manners_ = Manners{};
    manners_.reply_timeout = or_else(m.reply_timeout, 120ms);
    manners_.poll_period = or_else(m.poll_period, 20ms);
    manners_.pause = std::max(m.pause, Duration::zero());
    manners_.retries = m.retries < 0 ? 2 : std::min(m.retries, 10);
    manners_.silent_limit = std::clamp(m.silent_limit, 1, 1000);
    manners_.pause_min = or_else(m.retry_pause_min, 200ms);
    manners_.pause_max = std::max(manners_.pause_min, m.retry_pause_max);
    const std::string ethernet = option(setup.options, "ethernet", "off");
    manners_.ethernet = ethernet == "on" || ethernet == "true" || ethernet == "1";
    if (!manners_.ethernet && ethernet != "off" && ethernet != "false" && ethernet != "0" && !ethernet.empty()) {
        t.out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0,
                                 fmt::format("option ethernet = {}: write on or off; off is used", ethernet), t.now});
    }
    manners_.rate_code = manners_.ethernet ? 0 : code_of(setup.bit_rate);
    const auto digit = [&](const char* name, int most, int otherwise) {
        const std::string text = option(setup.options, name, "");
        if (text.empty()) return otherwise;
        if (text.size() == 1 && text[0] >= '0' && text[0] <= '0' + most) return text[0] - '0';
        t.out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0,
                                 fmt::format("option {} = {}: write 0..{}; {} is used", name, text, most, otherwise), t.now});
        return otherwise;
    };
    manners_.em = digit("em", 3, 1);
    manners_.ck = manners_.ethernet ? 0 : digit("ck", 2, 1);
}

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    take_manners(setup, t);
    std::vector<std::unique_ptr<Drive>> kept;
    for (auto& n : nodes_) {
        if (std::ranges::any_of(setup.drives, [&](const DriveSetup& d) { return same(d, n->setup()); })) {
            kept.push_back(std::move(n));
            continue;
        }
        n->remove(t, fmt::format("drive {} was removed or changed", n->name()));
        if (flight_.node == n.get()) {
            // Its answer may still be on its way.
            dirty_until_ = std::max(flight_.deadline, now);
            flight_ = {};
        }
        if (dirty_ == n.get()) dirty_ = nullptr;
        if (answered_ == n.get()) answered_ = nullptr;
        for (auto& m : missed_)
            if (m.node == n.get()) m = {};
    }
    nodes_ = std::move(kept);
    const bool alone = setup.drives.size() == 1;
    for (const DriveSetup& d : setup.drives) {
        if (std::ranges::any_of(nodes_, [&](const auto& n) { return same(d, n->setup()); })) continue;
        std::string why = check_address(d.address);
        if (why.empty() && d.address == "!" && !alone)
            why = "a drive in single mode (address !) must be alone on its line: give every drive a name";
        for (const auto& n : nodes_) {
            if (why.empty() && n->setup().address == d.address)
                why = fmt::format("the name {} belongs to drive {} already", d.address, n->name());
        }
        if (!why.empty()) {
            out.links.push_back({d.id, false, 0, Duration{}, std::move(why)});
            continue;
        }
        nodes_.push_back(std::make_unique<Drive>(catalogue_, manners_, counters_, d, next_listing_));
        if (up_) nodes_.back()->line_up(t);
    }
    setup_ = setup;
    turn_ = urgent_turn_ = 0;
    pump(t);
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    if (up == up_) return;
    Turn t{now, out};
    up_ = up;
    flight_ = {};
    stray_.clear();
    dirty_ = nullptr;
    answered_ = nullptr;
    missed_ = {};
    resync_ = true;
    dirty_until_ = quiet_until_ = now;
    for (auto& n : nodes_)
        up ? n->line_up(t) : n->line_down(t, "the line went down");
    pump(t);
}

void LineAdapter::on_command(const Command& c, Instant now, Out& out) {
    Turn t{now, out};
    for (auto& n : nodes_) {
        if (n->axis() == c.axis && c.axis != no_axis) {
            n->submit(c, t);
            return pump(t);
        }
    }
    if (c.ticket != no_ticket) {
        out.results.push_back({c.ticket,
                               c.axis,
                               Outcome::refused,
                               Reason::line_down,
                               0,
                               "this axis is not on the line, or its drive's address or channel is wrong (an MCode drive has one axis)",
                               {},
                               {}});
    }
}

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
    while (!line.empty() && (line.front() == '>' || line.front() == '?' || line.front() == cr))
        line.remove_prefix(1);
    while (!line.empty() && line.back() == cr)
        line.remove_suffix(1);
    if (!line.empty() && !marked(line, t)) {
        ++counters_.unexpected;
        Drive* from = nodes_.size() == 1 ? nodes_.front().get() : nullptr;
        for (auto& n : nodes_) {
            if (!from && n->may_print(t.now)) from = n.get();
        }
        if (from) from->foreign(line, t);
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
    if (at == std::string_view::npos || !missed_[at].node || t.now - missed_[at].at > 10s) return false;
    ++counters_.unexpected;
    missed_[at].node->trouble(Trouble::Kind::late, t);
    missed_[at] = {};
    return true;
}

/// What an exchange has brought beside its answer: its echo is taken out, the rest is as if nobody had been asked.
void LineAdapter::gather(const ReplyReader& reader, Verdict v, Turn& t) {
    const bool settled = v != Verdict::waiting && v != Verdict::garbled && flight_.kind != Expect::Kind::nothing;
    std::string before = settled && v != Verdict::refused ? reader.before() : reader.raw();
    for (auto at = flight_.sent.empty() ? std::string::npos : before.find(flight_.sent); at != std::string::npos;
         at = before.find(flight_.sent, at)) {
        before.erase(at, flight_.sent.size());
    }
    // A drive gives its line back without its name [L6840-6860].
    const std::string_view nameless = std::string_view(flight_.sent).substr(flight_.sent.empty() ? 0 : 1);
    if (before.starts_with(nameless)) before.erase(0, nameless.size());
    if (settled || std::ranges::any_of(nodes_, [&](const auto& n) { return n->may_print(t.now); })) stray(before, t);
    if (settled && v != Verdict::refused) {
        if (flight_.kind == Expect::Kind::query) {
            answered_mark_ = fmt::format("#{}", marks[mark_]);
            answered_ = flight_.node;
        }
        stray(reader.behind(), t);
    }
}

void LineAdapter::on_frame(const Frame& frame, Instant now, Out& out) {
    if (!up_) return;
    Turn t{now, out};
    if (frame.kind != Frame::Kind::bytes) {
        ++counters_.garbled;
        return;
    }
    const std::string_view bytes(reinterpret_cast<const char*>(frame.data().data()), frame.size);
    if (!flight_.node) {
        stray(bytes, t);
        return pump(t);
    }
    const Verdict v = reader_.push(bytes);
    if (flight_.kind == Expect::Kind::block && v == Verdict::waiting) {
        // A drive that is still speaking must not be spoken to; behind the closing question its answer is waited for.
        const Duration silence = manners_.reply_timeout / 2 + wire(24);
        flight_.deadline = std::min(flight_.latest, reader_.closing() ? std::max(flight_.deadline, now + silence) : now + silence);
    } else if (flight_.ends && v == Verdict::garbled) {
        flight_.deadline = now;  // the closing answer was spoiled: asked again
    } else if (v == Verdict::waiting && reader_.maybe_refused()) {
        // Speaking into an answer that still comes would spoil the next one too. 25 ms: what USB converters hold bytes back, and more.
        flight_.deadline = std::min(flight_.latest, now + 25ms + wire(16));
    } else if (v == Verdict::waiting) {
        // Half an answer: the rest is on its way, but noise must not hold the line for ever.
        flight_.deadline = std::min(flight_.latest, std::max(flight_.deadline, now + 10ms + wire(16)));
    } else {
        finish(v, t);
    }
    pump(t);
}

void LineAdapter::start(Drive& node, Turn& t) {
    manners_.reset_hits_others = std::ranges::any_of(nodes_, [&](const auto& n) { return n.get() != &node && n->hears_every_reset(); });
    Request r = node.next(t);
    flight_ = {};
    Expect e;
    e.kind = r.kind;
    e.checksum = node.sums();
    e.prompt = node.prompts();
    e.end_mark = r.end_mark;
    e.ends = flight_.ends = r.ends;
    std::string bytes;
    if (!r.raw.empty()) {
        bytes = r.raw;
    } else if (r.kind == Expect::Kind::query) {
        mark_ = (mark_ + 1) % static_cast<unsigned>(marks.size());
        e.mark = fmt::format("#{}", marks[mark_]);
        bytes = request(node.link(), fmt::format("PR \"{}\",{}{}", e.mark, r.text, r.end_mark ? ",\"~\"" : ""));
    } else {
        bytes = request(node.link(), r.text);
    }
    if (r.kind == Expect::Kind::command && node.quiet()) e.kind = Expect::Kind::nothing;
    if (!bytes.empty()) flight_.sent = bytes.substr(0, bytes.size() - (r.raw.empty() ? 1 : 0));
    // A LF ends what was cut off; where nothing was it does no harm (E-68).
    const bool lead = node.link().party() && !node.naming() && (r.wake || resync_);
    if (lead) bytes.insert(bytes.begin(), lf);
    resync_ = resync_ && !lead;
    node.led(lead || !node.link().party());
    node.heard_at(t.now + wire(bytes.size()));
    flight_.node = &node;
    flight_.purpose = r.purpose;
    flight_.kind = e.kind;
    const Duration expected = e.kind == Expect::Kind::nothing ? Duration{20ms} : manners_.reply_timeout + wire(64) + r.patience;
    flight_.deadline = t.now + wire(bytes.size()) + expected;
    // Drives that echo one another without end (line.setup with two fresh ones) hold the line for a second at most.
    flight_.latest = flight_.deadline + (e.kind != Expect::Kind::block ? wire(512) + 200ms
                                         : r.raw.empty()               ? wire(ReplyReader::limit) + 60s
                                                                       : Duration{1s});
    reader_.begin(std::move(e));
    for_each_run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, [&](const Frame& f) {
        t.out.send(f, r.urgent ? Priority::urgent : r.purpose == Request::Purpose::poll ? Priority::poll : Priority::command);
    });
}

/// The line is silent behind a block: the question whose answer is its end. false: that was in vain, or it is no such block.
bool LineAdapter::close_block(Turn& t) {
    if (!flight_.ends || flight_.closings > manners_.retries || t.now >= flight_.latest) return false;
    ++flight_.closings;
    mark_ = (mark_ + 1) % static_cast<unsigned>(marks.size());
    const std::string mark = fmt::format("#{}", marks[mark_]);
    const std::string bytes = request(flight_.node->link(), fmt::format("PR \"{}\",{}", mark, flight_.node->closing_items(t.now)));
    reader_.close_with(mark, bytes.substr(0, bytes.size() - 1));
    flight_.node->heard_at(t.now + wire(bytes.size()));
    flight_.deadline = t.now + wire(bytes.size()) + manners_.reply_timeout + wire(64);
    for_each_run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, [&](const Frame& f) { t.out.send(f); });
    return true;
}

void LineAdapter::finish(Verdict v, Turn& t) {
    Drive& node = *flight_.node;
    if (flight_.kind != Expect::Kind::block) gather(reader_, v, t);
    const Flight f = std::move(flight_);
    flight_ = {};
    if (f.to_all) {
        quiet_until_ = t.now + manners_.pause;
        return;
    }
    if (v == Verdict::waiting) {
        dirty_ = &node;
        dirty_until_ = t.now + 2 * manners_.reply_timeout;
        resync_ = true;
        if (f.kind == Expect::Kind::query) missed_[mark_] = {&node, t.now};
        for (const auto& n : nodes_) {
            if (!node.away()) n->line_missed();
        }
    } else if ((f.kind == Expect::Kind::query || f.ends) && v == Verdict::answered && dirty_ == &node) {
        dirty_ = nullptr;  // a drive answers in order: nothing older can come any more
        dirty_until_ = t.now;
    }
    quiet_until_ = t.now + manners_.pause;
    node.ended(v, reader_, t);
}

/// Every drive in reach is to be stopped by the same line, and two or more have not heard it: it goes to `*` once [L5004], and each is
/// then read. Not in single mode, nor with checksums in some drives only, nor when one drive shall go on: then one by one.
/// A drive with DG = 0 answers [L2399]: that is over before the next question, whose mark no such answer has.
bool LineAdapter::stop_all_at_once(Turn& t) {
    std::string_view line;
    Drive* first = nullptr;
    std::size_t unsent = 0;
    for (const auto& n : nodes_) {
        if (!n->in_reach()) continue;
        const std::string_view own = n->stop_line();
        if (own.empty() || !n->link().party() || (first && (own != line || n->sums() != first->sums()))) return false;
        line = own;
        if (!first) first = n.get();
        unsent += n->stop_unsent() ? 1 : 0;
    }
    if (unsent < 2) return false;
    std::string bytes = request({'*', first->sums()}, line);
    flight_ = {};
    flight_.sent = bytes.substr(0, bytes.size() - 1);
    if (std::exchange(resync_, false)) bytes.insert(bytes.begin(), lf);
    flight_.node = first;
    flight_.purpose = Request::Purpose::stop;
    flight_.kind = Expect::Kind::nothing;
    flight_.to_all = true;
    flight_.deadline = flight_.latest = t.now + wire(bytes.size()) + Duration{20ms};
    reader_.begin({Expect::Kind::nothing, {}, false, false, false});
    for (const auto& n : nodes_)
        n->told_by_all(t.now + wire(bytes.size()));
    for_each_run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
                 [&](const Frame& f) { t.out.send(f, Priority::urgent); });
    return true;
}

void LineAdapter::pump(Turn& t) {
    if (!up_) return;
    looked_at_ = t.now;
    // Each round starts an exchange or ends the loop; a node that only gives results does so a bounded number of times (its queue).
    for (std::size_t guard = 0; guard < 4 && !flight_.node && t.now >= quiet_until_; ++guard) {
        if (stop_all_at_once(t)) return;
        Drive* next = nullptr;
        // Stops that no drive has heard yet go before the confirmation of those that are sent.
        for (const bool unsent : {true, false}) {
            for (std::size_t i = 0; i < nodes_.size() && !next; ++i) {
                const std::size_t at = (urgent_turn_ + i) % nodes_.size();
                if (nodes_[at]->wants(t.now) != Drive::Want::urgent || (unsent && !nodes_[at]->stop_unsent())) continue;
                next = nodes_[at].get();
                urgent_turn_ = (at + 1) % nodes_.size();
            }
        }
        // line.setup keeps the line to itself, but from a stop.
        for (std::size_t i = 0; i < nodes_.size() && next && next->naming(); ++i) {
            if (nodes_[i]->wants(t.now) == Drive::Want::urgent && !nodes_[i]->naming()) next = nodes_[i].get();
        }
        for (std::size_t i = 0; i < nodes_.size() && !next; ++i) {
            Drive& n = *nodes_[(turn_ + i) % nodes_.size()];
            if (n.wants(t.now) != Drive::Want::other) continue;
            if (held(n, t.now)) continue;
            next = &n;
            turn_ = (turn_ + i + 1) % nodes_.size();
        }
        if (!next) return;
        start(*next, t);
    }
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    if (flight_.node && now >= flight_.deadline && !close_block(t)) finish(reader_.give_up(), t);
    pump(t);
}

/// After a time-out: lines wait until late answers are over, and the drive that was late is not asked again while one waits for that.
bool LineAdapter::held(const Drive& n, Instant now) const noexcept {
    if (n.wants_unmarked(now)) return now < dirty_until_;
    return &n == dirty_ && std::ranges::any_of(nodes_, [now](const auto& o) { return o->wants_unmarked(now); });
}

Instant LineAdapter::deadline() const {
    if (!up_) return never;
    if (flight_.node) return flight_.deadline;
    const Instant earliest = std::max(quiet_until_, looked_at_);
    Instant due = never;
    for (const auto& n : nodes_) {
        const Drive::Want want = n->wants(earliest);
        Instant at = want == Drive::Want::nothing ? n->due() : earliest;
        if (want != Drive::Want::urgent && held(*n, earliest)) at = std::max(at, dirty_until_);
        due = std::min(due, at);
    }
    return std::max(due, earliest);
}

}  // namespace axisgate::mcode
