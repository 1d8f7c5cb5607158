// Jobs: the commands of the axes on their way: whose exchange is next, what became of it, how a command ends.
// In: requests of the verbs, acknowledgements, silences, time. Out: exchanges; exactly one result per command.
// Never sends again what the control may have executed, unless executed twice it does what it does once.
#pragma once

#include "adapters/pacontrol/feedback.hpp"

namespace axisgate::pacontrol {

class Jobs : public Part {
public:
    using Part::Part;

    // --- for the verbs ------------------------------------------------------------------------------------------------------
    void ask(Axis& a, Request request);
    /// Of the control as a whole, or of this axis, as the code takes it.
    void ask(Axis& a, std::uint16_t code, std::string data = "0");
    void ask_poll(Axis& a);
    /// The same request again, or the one asked just now, not before `at`.
    void ask_later(Axis& a, Instant at);
    void wait(Axis& a, Instant limit);
    void over(Axis& a, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0, Value value = {},
              std::vector<std::uint8_t> bytes = {});
    void refuse(Axis& a, Reason reason, std::string text, Turn& t) { over(a, Outcome::refused, reason, std::move(text), t); }
    /// Done, or taken where nobody waits for the end.
    void finished(Axis& a, Turn& t);
    /// Taken, and its end is watched without a job.
    void accepted(Axis& a, Wait::For what, std::int64_t value, std::string text, Turn& t);
    /// A step's answer is QUIT: ends the job with it. False: QUIT was 0.
    bool ended_by_quit(Axis& a, const Reply& reply, Turn& t, std::string_view advice = {}, Reason reason = Reason::drive_refused);
    /// Refuses the job where the axis cannot move.
    bool ended_by_state(Axis& a, Turn& t);

    // --- for the drive ------------------------------------------------------------------------------------------------------
    void run(Axis& a, const Reply* reply, Turn& t) { a.job.verb->run(a, reply, t); }
    /// Those that wait look again.
    void wake(Turn& t);
    [[nodiscard]] bool send(Turn& t);
    [[nodiscard]] bool send_native_poll(Turn& t);
    void send_processing_poll(Turn& t);
    void answered(Axis& a, const Reply& reply, Turn& t);
    void processing_answered(const Sent& sent, const Reply& reply, Turn& t);
    void not_read(Axis& a, const Reply& reply, Turn& t);
    void silent(Axis& a, Turn& t);
    void on_deadline(Turn& t);
    [[nodiscard]] Instant deadline(Instant now) const noexcept;

private:
    void send_of(Axis& a, Turn& t);
    [[nodiscard]] bool comes_again(Axis& a, const Reply& reply, Instant now);
    void goes_on(Axis& a, const Reply& reply, Turn& t);
    void processing_over(const Reply& reply, Turn& t);
    void processing_late(Turn& t);
    void late(Axis& a, Turn& t);

    std::size_t next_ = 0;
};

}  // namespace axisgate::pacontrol
