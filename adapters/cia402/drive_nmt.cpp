// A node is started at most three times a minute, and a warning is given once.
#include "adapters/cia402/drive_nmt.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {

bool NmtWatch::turning() const noexcept {
    return std::ranges::any_of(drive_.axes, [](const auto& a) { return a->known.fb.moving; });
}

void NmtWatch::stopped(Turn& t) {
    constexpr int most_starts = 3;
    constexpr Duration in = std::chrono::minutes(1);
    Node& node = drive_.node;
    const bool turns = turning(), again = turns || node.restart_stopped;
    if (!std::exchange(node.stopped, true)) {
        // The exchange of a stop starts the node itself.
        if (drive_.exchanges.ask().why != Ask::Why::stop && drive_.exchanges.give_up())
            node.tickets.failed(drive_.exchanges.ask().ticket, Reason::interrupted,
                                "somebody else has stopped the node (NMT stop): nmt_start starts it again", t.out);
        for (const auto& a : drive_.axes)
            a->node_stopped(t);
        const std::string text =
            fmt::format("somebody else has stopped the node (NMT stop): it answers nothing and shows nothing but its heartbeat{}",
                        turns   ? ", while it may be turning: it is started again, to be seen"
                        : again ? "; it is started again, as the option restart_stopped says, three times a minute at most"
                                : "; nmt_start starts it again");
        drive_.notice(Severity::warning, "nmt_stopped", 0, fmt::format("{}: {}", node.setup.name, text), t);
        node.presence.report(text, t.out);
    }
    if (!again || node.only_reads) return;
    if (t.now - since_ > in) starts_ = 0, since_ = t.now;
    if (++starts_ <= most_starts) start(Priority::command, no_ticket, t);
}

void NmtWatch::wake(Turn& t) {
    t.out.send(canopen::nmt_frame(canopen::NmtCommand::pre_operational, drive_.node.number), Priority::command);
}

void NmtWatch::back(Turn& t) {
    drive_.node.stopped = false;
    drive_.node.presence.report(drive_.start.title(), t.out);
    for (const auto& a : drive_.axes) {
        a->feedback.begin(t.now);
        a->feedback.doubt(t.now);  // it may have lost its power meanwhile
    }
}

void NmtWatch::silent(Turn& t) {
    if (turning() && !drive_.node.only_reads) start(Priority::command, no_ticket, t);
}

void NmtWatch::start(Priority priority, Ticket order, Turn& t) {
    t.out.send(canopen::nmt_frame(canopen::NmtCommand::start, drive_.node.number), priority, order);
}

}  // namespace axisgate::cia402_drive
