// Adapter of MCode: one line, single mode or party mode: whose turn it is, one exchange at a time, and what comes back.
// In: setup, line state, commands, bytes, time. Out: bytes; feedback, samples, results, links, notices.
// Stops go before everything that waits; drives take turns; a silent drive has the line once per growing pause.
// Never sends while an answer is waited for.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "adapters/mcode/drive.hpp"
#include "adapters/mcode/wire_gaps.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/line_adapter.hpp"

namespace axisgate::mcode {

class LineAdapter final : public drive::LineAdapter<Drive> {
public:
    explicit LineAdapter(const Catalogue& catalogue) : bus_(catalogue) {}

    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    [[nodiscard]] AdapterCounters counters() const override { return bus_.counters; }

private:
    void take(const LineSetup& setup, Turn& t) override;
    void arrived(const Frame& frame, Turn& t) override;
    [[nodiscard]] std::string fault(const DriveSetup& drive, const LineSetup& line) const override;
    [[nodiscard]] std::unique_ptr<Drive> make(const DriveSetup& setup, std::size_t slot, Turn& t) override;
    void leaving(Drive& drive, Turn& t) override;
    void line_changed(Turn& t) override;
    // whose turn it is
    void fitted() override { bus_.turns.forget_wishes(); }
    void settle(Drive&, Turn&) override {}  // all of them at once, before a place is given away
    void end(Turn& t) override;
    void settle_all(Instant now);
    [[nodiscard]] bool held(const Drive& drive, Instant now) const noexcept;
    [[nodiscard]] bool stop_all_at_once(Turn& t);
    [[nodiscard]] bool stop_unsent(Instant now);
    // one exchange
    void start(Drive& drive, Turn& t);
    void send(std::string_view bytes, Priority priority, Turn& t, Ticket order = no_ticket) const;
    [[nodiscard]] std::string next_mark();
    [[nodiscard]] bool close_block(Turn& t);
    void finish(Verdict v, Turn& t);
    struct Flight;
    void learn_manners(Drive& d, const Flight& f, Verdict v, Turn& t);
    // what comes beside answers
    void stray(std::string_view bytes, Turn& t);
    void stray_line(Turn& t);
    void gather(Verdict v, Turn& t);
    [[nodiscard]] bool marked(std::string_view line, Turn& t);

    Bus bus_;

    struct Flight {
        Drive* drive = nullptr;  ///< null: the line is free
        Expect::Kind kind = Expect::Kind::query;
        std::string sent;     ///< what its echo would be
        bool to_all = false;  ///< a line to `*`: nobody answers; `drive` only keeps the line busy
        bool ends = false;    ///< a block that a question closes
        int closings = 0;     ///< such questions so far
        Instant deadline = never;
        Instant latest = never;
    } flight_;
    ReplyReader reader_;
    Gaps gaps_;
    unsigned mark_ = 0;
    std::string answered_mark_;  ///< of the last question that was answered: seen again, two drives answer to one name
    Drive* answered_ = nullptr;  ///< by whom
    Instant looked_at_{};        ///< when the drives were asked last what they want: the deadline is no earlier time
    drive::LateTime late_;       ///< answers of an exchange that was given up may come until then
    const Drive* late_drive_ = nullptr;
    std::string stray_;    ///< text that nobody asked for, up to its line end, at most 256
    bool resync_ = false;  ///< a line end may be lost: the next request on a party line begins with one
    struct Missed {
        Drive* drive = nullptr;
        Instant at{};
    };
    std::array<Missed, 62> missed_{};  ///< by mark: questions that were given up
};

}  // namespace axisgate::mcode
