#include "gateway/drive/command_queue.hpp"

#include <fmt/core.h>

#include <utility>

namespace axisgate::drive {

bool is_motion(const CommandBody& body) noexcept {
    return std::holds_alternative<Move>(body) || std::holds_alternative<Home>(body) || std::holds_alternative<StartTogether>(body);
}

bool ended_by(const CommandBody& stop, const CommandBody& body) noexcept {
    return is_motion(body) || (std::holds_alternative<Disable>(stop) && std::holds_alternative<Enable>(body));
}

bool CommandQueue::push(Command command) {
    if (waiting_.size() >= limit_) return false;
    waiting_.push_back(std::move(command));
    return true;
}

Command CommandQueue::pop() {
    Command c = std::move(waiting_.front());
    waiting_.pop_front();
    return c;
}

bool refused_behind(const CommandBody* stop, const Command& command, const CommandQueue& queue, Turn& t) {
    if (!stop || std::holds_alternative<Halt>(*stop) || !is_motion(command.body) || queue.holds<Enable>(command.axis)) return false;
    Tickets::refuse(command, Reason::interrupted,
                    fmt::format("{} of this axis is on its way: enable the axis before it is moved again", name_of(*stop)), t.out);
    return true;
}

Admission admit(const Command& command, std::string_view name, const Presence& presence, CommandQueue& queue, Tickets& tickets, Turn& t) {
    const auto refuse = [&](Reason reason, std::string text) {
        Tickets::refuse(command, reason, std::move(text), t.out);
        return Admission::answered;
    };
    if (presence.is(Presence::Phase::down)) return refuse(Reason::line_down, "the line is down");
    if (is_urgent(command.body)) return tickets.open(command, t.out) ? Admission::urgent : Admission::answered;
    if (presence.is(Presence::Phase::absent)) {
        return refuse(Reason::no_answer, fmt::format("drive {} does not answer; it is asked again every {} ms", name,
                                                     milliseconds_of(presence.retry_pause())));
    }
    if (queue.size() >= queue.limit()) return refuse(Reason::busy, fmt::format("{} commands of {} wait already", queue.limit(), name));
    if (!tickets.open(command, t.out)) return Admission::answered;
    (void)queue.push(command);
    return Admission::queued;
}

}  // namespace axisgate::drive
