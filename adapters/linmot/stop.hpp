// Stops: halt by VAI Stop, quick stop by /Abort (or OFF3, an option), disable by the switch on bit. They overtake all that waits.
// In: urgent commands. Out: one telegram each, ended by what the drive shows. Never waits for more than the exchange in progress.
#pragma once

#include <optional>
#include <string>

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/command_queue.hpp"

namespace axisgate::linmot {

struct Stop {
    Command command;
    int step = 0;
    int tries = 0;
    std::uint8_t count = 0;
};

class Stops : public Part {
public:
    using Part::Part;

    void add(const Command& command, Turn& t);
    /// The gateway's own: a motion that nobody waits for, or a control word that would give the power back by itself.
    void take_back(CommandBody stop, Turn& t);
    /// Of the first one; nothing: none of them has anything to stop, and they are answered.
    [[nodiscard]] std::optional<Telegram> request(Turn& t);
    void answered(Turn& t);
    void silent(Turn& t);
    void forget() noexcept { lane_.clear(); }

    [[nodiscard]] bool empty() const noexcept { return lane_.empty(); }
    [[nodiscard]] Ticket order() const noexcept { return empty() ? no_ticket : lane_.first()->command.ticket; }
    /// Nothing but a halt wants to go: it leaves a stream to end by itself.
    [[nodiscard]] bool empty_or_halt() const noexcept { return empty() || std::holds_alternative<Halt>(lane_.first()->command.body); }

private:
    static constexpr std::size_t limit = 16;
    void over(Outcome outcome, Reason reason, std::string text, Turn& t);

    drive::StopLane<Stop, limit> lane_;
};

}  // namespace axisgate::linmot
