// The tickets of the service thread and their callbacks; a result for which nobody waits any more is dropped. No result is delivered from
// inside submit.
#include "gateway/runtime/warm_axes.hpp"

#include <fmt/core.h>

namespace axisgate {
namespace {
constexpr std::size_t max_waiting = 1024;  // commands without an answer, of all clients of this thread
}  // namespace

WarmAxes::WarmAxes(const WarmThreads& threads)
    : threads_(threads), results_(2 * max_waiting, threads.bell, [this](Result&& r) { answer(std::move(r)); }) {}

AxisPicture WarmAxes::picture(AxisId axis) const {
    const Image& image = threads_.hot.image_for_readers();
    return index_of(axis) < image.size() ? image.cell(axis).read() : AxisPicture{};
}

std::uint64_t WarmAxes::picture_revision(AxisId axis) const {
    const Image& image = threads_.hot.image_for_readers();
    return index_of(axis) < image.size() ? image.cell(axis).revision() : 0;
}

Ticket WarmAxes::submit(Command command, std::function<void(const Result&)> then) {
    const Ticket ticket = make_ticket(first_service_door, next_ticket_++);
    command.ticket = ticket;
    const AxisId axis = command.axis;
    if (waiting_.size() >= max_waiting || !threads_.hot.commands().push(std::move(command))) {
        threads_.answer([ticket, axis, then = std::move(then)] {
            Result r;
            r.ticket = ticket;
            r.axis = axis;
            r.outcome = Outcome::refused;
            r.reason = Reason::busy;
            r.text = fmt::format("{} commands wait for their answers already; come again in a moment", max_waiting);
            then(r);
        });
        return ticket;
    }
    waiting_.emplace(ticket, std::move(then));
    threads_.hot.commands().announce();
    return ticket;
}

void WarmAxes::client_lost(const AuthorityClient& who, LossCause cause) {
    // If the ring is full, the watchdogs of the axes notice the silence.
    (void)threads_.on_hot([who, cause](Engine& engine, Instant now) { engine.on_client_lost(who, cause, now); });
}

void WarmAxes::answer(Result&& result) {
    const auto it = waiting_.find(result.ticket);
    if (it == waiting_.end()) return;
    const auto then = std::move(it->second);
    waiting_.erase(it);
    then(result);
}

}  // namespace axisgate
