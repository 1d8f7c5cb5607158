// Tickets holds the commands of one drive (or of the joint starts of a line) that have no result yet. Each command has exactly one result:
// a second answer is ignored. The number is bounded: a command beyond the limit is answered as busy.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

/// Queues, jobs and waits may keep a Command or its ticket; what they drop is answered here by fail_all, fail_axis or `answer`. no_ticket
/// belongs to no client: its commands are accepted and their answers are discarded.
class Tickets {
public:
    static constexpr std::size_t for_stops = 32;  ///< places that are reserved for urgent commands

    explicit Tickets(std::size_t limit = 160) noexcept : limit_(limit) {}

    /// False: too many tickets are open; the command was answered (refused, busy) and must be dropped.
    [[nodiscard]] bool open(const Command& command, Out& out);
    /// Gives the result. False: the ticket is not open (answered before, or no_ticket), and no result was given.
    bool answer(Ticket ticket, Outcome outcome, Reason reason, std::string text, Out& out, std::int32_t code = 0, Value value = {},
                std::vector<std::uint8_t> bytes = {});
    bool accepted(Ticket ticket, Out& out, std::string text = {}) {
        return answer(ticket, Outcome::accepted, Reason::none, std::move(text), out);
    }
    bool refused(Ticket ticket, Reason reason, std::string text, Out& out, std::int32_t code = 0) {
        return answer(ticket, Outcome::refused, reason, std::move(text), out, code);
    }
    bool failed(Ticket ticket, Reason reason, std::string text, Out& out, std::int32_t code = 0) {
        return answer(ticket, Outcome::failed, reason, std::move(text), out, code);
    }
    /// Answers all open tickets in the order of their commands: the line went down, or the drive is gone or was removed.
    void fail_all(Reason reason, std::string_view text, Out& out);
    /// The same for one axis of the drive.
    void fail_axis(AxisId axis, Reason reason, std::string_view text, Out& out);

    [[nodiscard]] bool is_open(Ticket ticket) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return open_.size(); }

    /// Refuses a command for which no ticket was opened.
    static void refuse(const Command& command, Reason reason, std::string text, Out& out);

private:
    struct Open {
        Ticket ticket;
        AxisId axis;
    };
    std::size_t limit_;
    std::vector<Open> open_;
};

}  // namespace axisgate::drive
