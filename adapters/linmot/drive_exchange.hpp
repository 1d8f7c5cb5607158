// Exchanges: the one telegram that is on its way to a drive, its repeats, and the wait for late answers.
// In: telegrams to send, answers, the passing of time. Out: bytes. Every telegram may be repeated but those that are marked: control words
// and reads change nothing the second time, and a motion command with the same count is not executed twice.
#pragma once

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/exchange.hpp"

namespace axisgate::linmot {

/// Why something was asked; decides what its answer does.
enum class Purpose : std::uint8_t { probe, core, poll, job, stop, release, stream };
struct Request {
    Telegram telegram;
    Purpose purpose = Purpose::poll;
    bool any_length = false;  ///< native: whatever comes from this ID is the answer
    bool once = false;        ///< not to be repeated by itself: the drive counts such telegrams
    bool quiet = false;       ///< its answer may take seconds: silence is none, and the line is not held
};

class Exchanges : public Part {
public:
    using Part::Part;

    void send(Request request, Turn& t);
    /// An answer to what was asked: of its group, with its number where it carries one.
    [[nodiscard]] bool answers(const Telegram& telegram) const noexcept;
    [[nodiscard]] Request answered();
    /// True: it has ended without an answer, however often it was sent.
    [[nodiscard]] bool on_deadline(Turn& t);
    /// on_deadline has sent the same telegram again in this turn.
    [[nodiscard]] bool repeated(Instant now) const noexcept { return active() && repeated_at_ == now; }
    /// A late answer may still come: until then nothing is sent.
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
};

}  // namespace axisgate::linmot
