// Exchanges: the one question that is on its way to a drive, and what late answers mean for the questions after it.
// In: messages to send, messages from the drive, the passing of time. Out: frames; the answer, or the news that there is none, to whoever
// asked. Never takes a late answer for a new one: an instruction with the same mark waits behind another exchange (LateMarks).
#pragma once

#include "adapters/uim342/drive_part.hpp"
#include "gateway/drive/exchange.hpp"

namespace axisgate::uim342 {

/// Why something was asked; decides what its answer does.
enum class Purpose : std::uint8_t {
    probe,     ///< ML: is anybody there
    startup,   ///< a value read after a drive was found
    poll,      ///< MS[0] or MS[1]
    error,     ///< ER[0], because ERR appeared
    barrier,   ///< any read: separates late answers from new ones
    clear_mf,  ///< MF=0 after a group exchange whose end is not known
    job,       ///< a step of the present job
    confirm,   ///< a stop repeated behind a motion that it may have overtaken
    orphan     ///< its job has been ended by a stop; the answer is only taken off the line
};
struct Request {
    Message message;
    Purpose purpose = Purpose::poll;
    std::uint8_t mf = 0;  ///< group that the value belongs to
};

class Exchanges : public Part {
public:
    using Part::Part;

    // --- sending ------------------------------------------------------------------------------------------------------------
    void send(const Request& request, int retries, Priority priority, Turn& t);
    /// True: something else had to go before this message, and has been sent: a read that its late answers cannot pass, or MF=0.
    [[nodiscard]] bool makes_way(const Message& m, std::uint8_t mf, Priority priority, Turn& t);
    /// The job that waits for the answer is over.
    void abandon_job() noexcept;
    void no_repeats() noexcept { exchange_.no_repeats(); }
    /// The line went down, the drive is lost or removed.
    void drop() noexcept;

    // --- what comes, or does not --------------------------------------------------------------------------------------------
    void on_message(const Message& m, Turn& t);
    void on_deadline(Turn& t);
    /// A request was given up: its answer may still come.
    void given_up(const Message& m) noexcept { late_.add(mark_of(m)); }
    void forget_late() noexcept { late_.clear(); }
    void count_silence(Turn& t);

    // --- what is known ------------------------------------------------------------------------------------------------------
    [[nodiscard]] bool active() const noexcept { return exchange_.active(); }
    [[nodiscard]] Instant deadline() const noexcept { return exchange_.deadline(); }
    /// nullptr: nothing.
    [[nodiscard]] const Request* on_its_way() const noexcept { return exchange_.active() ? &exchange_.request() : nullptr; }
    [[nodiscard]] bool on_its_way(std::uint8_t function) const noexcept {
        return exchange_.active() && exchange_.request().message.function() == function;
    }
    [[nodiscard]] bool late(const Message& m) const noexcept { return late_.has(mark_of(m)); }

    bool mf_unknown = false;  ///< a group may still be selected in the drive: MF=0 goes before what would use it up

private:
    [[nodiscard]] Ticket order_of(const Request& request) const noexcept;
    void barrier(Turn& t);
    void answered(const Message& m, Turn& t);
    void refused(const Message& m, Turn& t);
    void silent(Turn& t);
    [[nodiscard]] Request ended();

    drive::Exchange<Request> exchange_;
    drive::LateMarks<std::uint16_t> late_;  ///< of instructions that were given up, or sent twice
};

}  // namespace axisgate::uim342
