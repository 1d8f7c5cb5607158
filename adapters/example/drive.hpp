// Drive: one example drive with up to four axes, put together from gateway/drive: presence, one exchange, a queue, stops, polls.
// In: commands, telegrams, the passing of time, a place on the line. Out: telegrams, feedback, results, links.
// Written in: drive.cpp what it sends next and what it learns, motion.cpp the verbs and the run of a command to its result.
#pragma once

#include <array>

#include "adapters/example/wire.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/set_points.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::example {
using drive::Presence;
using drive::Turn;

/// What the drives of one line share.
struct Line {
    explicit Line(const Catalogue& of_family) : catalogue(of_family) {}
    void take(const LineSetup& setup);
    const Catalogue& catalogue;
    drive::Timing timing;
    drive::Turns turns;
    AdapterCounters counters;
    Duration on_wire{};  ///< of the longest request with its answer
};

class Drive {
public:
    static constexpr int channels = 4;
    Drive(Line& line, const DriveSetup& setup, int address, std::size_t slot);

    void line_up(Turn& t);
    void line_down(std::string_view why, Turn& t);
    /// The site has other axes of this drive: those that stay go on.
    void set_axes(const DriveSetup& setup, Turn& t);
    void submit(const Command& command, Turn& t);
    void look(const DriveSetup& setup) noexcept {
        if (pace_.take(setup)) polls_.hurry();
    }
    void follow(const SetPoint& set_point);
    void on_telegram(const Telegram& telegram, Turn& t);
    // asked by drive::settle, serve and wake
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return exchange_.deadline(); }
    [[nodiscard]] Instant wish() const noexcept { return std::min(presence_.deadline(), polls_.deadline()); }
    void go(Turn& t);
    void on_deadline(Turn& t);

    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }
    [[nodiscard]] int address() const noexcept { return address_; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }

private:
    /// Why something was asked.
    struct Ask {
        enum class Why : std::uint8_t { probe, poll, step, stop } why = Why::probe;
        Telegram telegram;
        Ticket ticket = no_ticket;
    };
    struct Stop {
        Ticket ticket = no_ticket;
        Telegram telegram;
    };
    struct Step {
        std::string item;
        Telegram::Kind kind;
        std::string text;
        bool from_here = false;  ///< the text is a distance from where the axis is then
    };
    /// A command taken apart into exchanges.
    struct Job {
        Command command;
        std::vector<Step> steps;
        std::size_t at = 0;
    };

    [[nodiscard]] Telegram telegram(AxisId axis, const Step& step) const;
    void send(Ask ask, int retries, Turn& t);
    void answered(const Ask& ask, const Telegram& answer, Turn& t);
    void learn(int channel, std::string_view text, Turn& t);
    void emit(int channel, Turn& t);
    [[nodiscard]] int channel_of(AxisId axis) const noexcept;
    // motion.cpp
    void begin(Command command, Turn& t);
    [[nodiscard]] Job job_for(const SetPoint& set_point);
    [[nodiscard]] std::string plan(Job& job, Reason& reason) const;
    void step_answered(const Telegram& answer, Turn& t);

    Line& line_;
    DriveSetup setup_;
    int address_;
    std::size_t slot_;
    Presence presence_;
    drive::CommandQueue queue_;
    drive::Tickets tickets_;
    drive::StopLane<Stop, 8> stops_;
    drive::Exchange<Ask> exchange_;
    drive::LateMarks<Telegram, 8> late_;  ///< by address, axis and item: what an answer can be told by
    drive::Pace pace_;
    drive::Polls polls_;  ///< items are channels
    drive::SetPoints set_points_;
    bool streamed_last_ = false;
    std::array<Move, channels + 1> followed_;  ///< by channel: whose ramps and speed the drive was told last by a stream
    std::optional<Job> job_;
    std::array<AxisFeedback, channels + 1> axes_;  ///< by channel
};

}  // namespace axisgate::example
