// A streamed set-point is a job without a ticket.
#include "adapters/linmot/drive_job.hpp"

#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

void Verb::without_success(drive::Failure& how, Turn& t) {
    if (how.dropped) drive_.exchanges.no_repeats();
    if (how.outcome == Outcome::refused && how.reason == Reason::drive_refused) ++drive_.bus.counters.refused;
    const Command& c = job().command;
    if (c.ticket == no_ticket && std::holds_alternative<Move>(c.body) && how.reason != Reason::interrupted)
        t.out.stream_ends.push_back({drive_.axis(), how.reason, how.text});
}
std::string Verb::refusal(std::uint8_t code) const { return fmt::format("drive {} refused: {}", drive_.title(), communication_text(code)); }

Verb* Jobs::verb_of(const CommandBody& b) const noexcept {
    if (std::holds_alternative<Enable>(b)) return &drive_.power;
    if (std::holds_alternative<ResetFault>(b)) return &drive_.reset;
    if (std::holds_alternative<Home>(b)) return &drive_.homing;
    if (std::holds_alternative<Move>(b) || std::holds_alternative<SetPosition>(b)) return &drive_.moves;
    if (std::holds_alternative<ReadParameter>(b) || std::holds_alternative<WriteParameter>(b)) return &drive_.parameters;
    if (std::holds_alternative<Native>(b)) return &drive_.native;
    if (std::holds_alternative<Action>(b)) return &drive_.actions;
    return nullptr;
}

void Jobs::begin_next(Turn& t) {
    Command next = queue.pop();
    if (Verb* verb = verb_of(next.body)) return begin(*verb, std::move(next)).verb->begin(t);
    drive_.tickets.refused(next.ticket, Reason::not_supported,
                           std::holds_alternative<StartTogether>(next.body) ? std::string("LinMot drives cannot be started together")
                                                                            : fmt::format("a LinMot drive has no {}", name_of(next.body)),
                           t.out);
}

bool Jobs::wants(Instant now) const noexcept { return idle() ? !queue.empty() || !set_points.empty() : now >= job_.not_before; }

Instant Jobs::wish() const noexcept {
    if (!idle()) return job_.not_before;
    return queue.empty() && set_points.empty() ? never : Instant{};
}

bool Jobs::go(Turn& t) {
    // Commands that end without an exchange make room for the next one.
    while (idle() && !queue.empty())
        begin_next(t);
    if (idle() && !set_points.empty()) {  // a move without a ticket; its answers report the position, so no poll is delayed
        Command c;
        c.axis = drive_.axis();
        c.body = set_points.take().as_move();
        (void)queue.push(std::move(c));
        begin_next(t);
    }
    if (idle() || t.now < job_.not_before) return false;
    auto telegram = job_.transfer.active ? drive_.transfers.request() : job_.verb->request(t);
    if (!telegram) return false;
    Request r{std::move(*telegram), Purpose::job};
    r.any_length = std::holds_alternative<Native>(job_.command.body);
    r.once = job_.transfer.active;
    // The drive answers the start of its software after about 3 s; if the line waited for this, no stop could be sent meanwhile.
    r.quiet = r.telegram.main == static_cast<std::uint8_t>(Main::program) && r.telegram.sub == 4;
    drive_.exchanges.send(std::move(r), t);
    return true;
}

void Jobs::answered(const Telegram& telegram, Turn& t) {
    if (!idle()) job_.verb->answered(telegram, t);
}

void Jobs::look_later(Turn& t) noexcept {
    if (!idle()) job_.not_before = t.now + std::chrono::milliseconds(200);
}

void Jobs::silent(Turn& t) {
    if (idle() || drive_.transfers.again()) return;
    drive_.motion.no_target();
    if (is(drive_.motion)) drive_.motion.given_up(job_.count);
    const CommandBody& body = job_.command.body;
    if (std::holds_alternative<WriteParameter>(body) || std::holds_alternative<Native>(body) || std::holds_alternative<Action>(body))
        drive_.start.read_again();
    drive_.demand.forget();
    fail(Reason::no_answer, fmt::format("drive {} does not answer", drive_.title()), t);
}

void Jobs::forget() {
    queue.clear();
    set_points.clear();
    job_ = {};
}

}  // namespace axisgate::linmot
