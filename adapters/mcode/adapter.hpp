// Adapter of MCode: one line, single mode or party mode: whose turn it is, one exchange at a time, and what comes back.
// In: setup, line state, commands, bytes, time. Out: bytes; feedback, samples, results, links, notices.
// Stops go before everything that waits; drives take turns; a silent drive has the line once per growing pause.
// Never sends while an answer is waited for.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

class LineAdapter final : public Adapter {
public:
    explicit LineAdapter(const Catalogue& catalogue) : catalogue_(catalogue) {}

    void configure(const LineSetup& setup, Instant now, Out& out) override;
    void on_line(bool up, Instant now, Out& out) override;
    void on_command(const Command& command, Instant now, Out& out) override;
    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    [[nodiscard]] AdapterCounters counters() const override { return counters_; }

private:
    void take_manners(const LineSetup& setup, Turn& t);
    [[nodiscard]] Duration wire(std::size_t bytes) const noexcept;
    void pump(Turn& t);
    void start(Drive& node, Turn& t);
    void finish(Verdict v, Turn& t);
    [[nodiscard]] bool close_block(Turn& t);
    [[nodiscard]] bool stop_all_at_once(Turn& t);
    void stray(std::string_view bytes, Turn& t);
    void stray_line(Turn& t);
    void gather(const ReplyReader& reader, Verdict v, Turn& t);
    [[nodiscard]] bool marked(std::string_view line, Turn& t);
    [[nodiscard]] bool held(const Drive& n, Instant now) const noexcept;

    const Catalogue& catalogue_;
    LineSetup setup_;
    Manners manners_;
    AdapterCounters counters_;
    bool up_ = false;
    std::vector<std::unique_ptr<Drive>> nodes_;
    std::size_t turn_ = 0;         ///< whose turn is next
    std::size_t urgent_turn_ = 0;  ///< among those with a stop

    struct Flight {
        Drive* node = nullptr;  ///< null: the line is free
        Request::Purpose purpose = Request::Purpose::poll;
        Expect::Kind kind = Expect::Kind::query;
        std::string sent;     ///< what its echo would be
        bool to_all = false;  ///< a line to `*`: nobody answers; `node` only keeps the line busy
        bool ends = false;    ///< a block that a question closes
        int closings = 0;     ///< such questions so far
        Instant deadline = never;
        Instant latest = never;
    } flight_;
    ReplyReader reader_;
    unsigned mark_ = 0;
    std::string answered_mark_;  ///< of the last question that was answered: seen again, two drives answer to one name
    Drive* answered_ = nullptr;  ///< by whom
    Instant quiet_until_{};      ///< LineManners::pause
    Instant looked_at_{};        ///< when the nodes were asked last what they want: the deadline asks them for no earlier time
    Instant next_listing_{};     ///< when the next drive that comes may list its variables
    Instant dirty_until_{};      ///< answers of an exchange that was given up may come until then
    const Drive* dirty_ = nullptr;
    std::string stray_;    ///< text that nobody asked for, up to its line end, at most 256
    bool resync_ = false;  ///< a line end may be lost: the next request on a party line begins with one
    struct Missed {
        Drive* node = nullptr;
        Instant at{};
    };
    std::array<Missed, 62> missed_{};  ///< by mark: questions that were given up
};

}  // namespace axisgate::mcode
