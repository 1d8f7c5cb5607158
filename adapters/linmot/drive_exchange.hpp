// Exchanges controls the one telegram that is outstanding with a drive: its repetitions, and the wait for late answers. Telegrams may be
// repeated unless they are marked: control words and reads have no effect the second time, and a motion command with the same count is not
// executed twice.
#pragma once

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/exchange.hpp"

namespace axisgate::linmot {

/// The purpose of a request; it decides how the answer is used.
enum class Purpose : std::uint8_t { probe, core, poll, job, stop, release, stream };
struct Request {
    Telegram telegram;
    Purpose purpose = Purpose::poll;
    bool any_length = false;  ///< native: any telegram from this ID is the answer
    bool once = false;        ///< not repeated automatically: the drive counts such telegrams
    bool quiet = false;       ///< the answer may take seconds: a time-out does not count, and the line is not reserved
};

class Exchanges : public Part {
public:
    using Part::Part;

    void send(Request request, Turn& t);
    /// The telegram answers the request: same group, the same number if the answer has one, and the size that the response of this drive
    /// has. A response that the drive sends without a request is not distinguishable from an answer with the same content.
    [[nodiscard]] bool answers(const Telegram& telegram) const noexcept;
    /// The outstanding request itself, as a converter returns it that hears what it sends.
    [[nodiscard]] bool echoes(const Telegram& telegram) const noexcept { return active() && request().telegram == telegram; }
    [[nodiscard]] Request answered();
    /// True: the exchange has ended without an answer after all repetitions.
    [[nodiscard]] bool on_deadline(Turn& t);
    /// on_deadline has repeated the telegram in this turn.
    [[nodiscard]] bool repeated(Instant now) const noexcept { return active() && repeated_at_ == now; }
    /// A late answer may still arrive; until then nothing is sent.
    void missed(Instant now) noexcept;
    void nothing_late() noexcept { late_.settled(); }
    void drop() noexcept { exchange_.drop(); }
    /// A stop has overtaken a step of a command.
    void no_repeats() noexcept;

    [[nodiscard]] bool active() const noexcept { return exchange_.active(); }
    [[nodiscard]] bool ready(Instant now) const noexcept { return !active() && late_.over(now); }
    [[nodiscard]] const Request& request() const noexcept { return exchange_.request(); }
    [[nodiscard]] Instant deadline() const noexcept { return exchange_.deadline(); }
    [[nodiscard]] Instant ready_at() const noexcept { return late_.until(); }

private:
    [[nodiscard]] Ticket order_of(const Request& request) const noexcept;

    drive::Exchange<Request> exchange_;
    drive::LateTime late_;
    Instant repeated_at_ = Instant::min();
    Instant timed_out_at_ = never;  ///< of the request that waits for its repetition
};

}  // namespace axisgate::linmot
