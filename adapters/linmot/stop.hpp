// Stops carries out halt by VAI Stop, quick stop by /Abort (or OFF3, an option), and disable by the switch-on bit. A stop is sent before
// all waiting requests; only the exchange in progress is completed first. It ends when the drive shows its effect.
#pragma once

#include <optional>
#include <string>

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/command_queue.hpp"

namespace axisgate::linmot {

struct Stop {
    Command command;
    int step = 0;
    int tries = 0, silences = 0;  ///< answers that do not show its effect; exchanges without an answer
    Instant limit = never;        ///< of the time in which the drive may show its effect
    Instant not_before{};         ///< of its next telegram
    std::uint8_t count = 0;
};

class Stops : public Part {
public:
    using Part::Part;

    void add(const Command& command, Turn& t);
    /// A stop by the gateway itself: for a motion whose client was informed of its failure, or a control word that would restore the power.
    void take_back(CommandBody stop, Turn& t);
    /// The telegram of the first stop; empty: no stop has anything to end, and all were answered.
    [[nodiscard]] std::optional<Telegram> request(Turn& t);
    void answered(Turn& t);
    void silent(Turn& t);
    void forget() noexcept { lane_.clear(); }

    [[nodiscard]] bool empty() const noexcept { return lane_.empty(); }
    /// When the next telegram of a stop is due; `never`: no stop waits.
    [[nodiscard]] Instant wish() const noexcept { return empty() ? never : lane_.first()->not_before; }
    [[nodiscard]] Ticket order() const noexcept { return empty() ? no_ticket : lane_.first()->command.ticket; }
    /// No stop waits except a halt, before which the stream must end.
    [[nodiscard]] bool empty_or_halt() const noexcept { return empty() || std::holds_alternative<Halt>(lane_.first()->command.body); }

private:
    static constexpr std::size_t limit = 16;
    void over(Outcome outcome, Reason reason, std::string text, Turn& t);

    drive::StopLane<Stop, limit> lane_;
};

}  // namespace axisgate::linmot
