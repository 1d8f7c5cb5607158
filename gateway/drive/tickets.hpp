// Tickets: the commands of one drive (or of a line's joint orders) that still owe their one result.
// In: commands as they are taken, answers. Out: exactly one Result per ticket, whatever else forgets its command meanwhile.
// Never answers twice: the second answer is no answer. Never unbounded: one more than the limit is answered as busy at once.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

/// Queues, jobs and waits keep a Command or its ticket as they like; what they drop is answered by fail_all, fail_axis or `answer` here.
/// no_ticket is nobody's: it is taken and answered without a trace.
class Tickets {
public:
    static constexpr std::size_t for_stops = 32;  ///< places that only urgent commands may take

    explicit Tickets(std::size_t limit = 160) noexcept : limit_(limit) {}

    /// False: too many are open; the command has been answered (refused, busy) and must be dropped.
    [[nodiscard]] bool open(const Command& command, Out& out);
    /// The one answer. False: the ticket is not open (answered before, or nobody's), and nothing was said.
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
    /// Everything that is open ends so, in the order in which it was taken: the line went down, the drive is gone or was removed.
    void fail_all(Reason reason, std::string_view text, Out& out);
    /// The same for one axis of the drive.
    void fail_axis(AxisId axis, Reason reason, std::string_view text, Out& out);

    [[nodiscard]] bool is_open(Ticket ticket) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return open_.size(); }

    /// For a command that is not taken at all.
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
