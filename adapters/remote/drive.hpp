// Drive: one axis of another gateway: its state by question and by what its gateway tells unasked, one command at a time, stops beside it.
// In: commands, telegrams, the passing of time. Out: telegrams, feedback, results, links.
// Written in: drive.cpp what it sends next and what it learns, motion.cpp the verbs and their results. Never sends a command twice; a stop
// it does. A velocity move holds at the other gateway only while it is renewed from here: what is cut off there ends by itself.
#pragma once

#include <optional>

#include "gateway/drive/bus.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/presence.hpp"
#include "gateway/drive/tickets.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::remote {
using drive::Presence;
using drive::Turn;

/// What the axes of one line share.
struct Line : drive::Bus {
    using drive::Bus::Bus;
    void take(const LineSetup& setup, Instant now);
    Duration stale_after{};
    std::uint64_t next = 0;  ///< number of the next request: those of an adapter made later are greater
};

class Drive {
public:
    static constexpr int channels = 1;
    static constexpr Duration hold = std::chrono::seconds(2);            ///< of a velocity move, at the other gateway ...
    static constexpr Duration renewed = std::chrono::milliseconds(600);  ///< ... and how often it is renewed
    Drive(Line& line, const DriveSetup& setup);

    void line_up(Turn& t) { presence_.begin(t.now); }
    void line_down(std::string_view why, Turn& t);
    void remove(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void on_telegram(const mirror::Telegram& telegram, Turn& t);
    /// Sends what there is to be sent now.
    void go(Turn& t);
    [[nodiscard]] Instant deadline() const noexcept;
    void on_deadline(Turn& t);
    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }
    void look(const DriveSetup& setup) noexcept {
        if (pace_.take(setup)) timer_.hurry();
    }

private:
    struct Stop {
        Ticket ticket = no_ticket;
        std::uint64_t number = 0;
        mirror::Order order;
        Instant again = Instant{};  ///< sent then, for as many times as are left
        int left = 0;
    };
    struct Running {
        Command command;
        std::uint64_t number = 0;
        Instant until = never;
    };
    struct Renewal {
        mirror::Order order;
        std::uint64_t number = 0;  ///< of the last one that was sent
        Instant next = never;
    };

    std::uint64_t send(const mirror::Order& order, Priority priority, Turn& t, std::uint64_t number = 0);
    void ask(Turn& t);
    void asked_in_vain(std::string_view why, bool gone, Turn& t);
    void lost(const std::string& why, Turn& t);
    void learn(const mirror::State& state, Turn& t);
    void emit(Turn& t);
    // motion.cpp
    void begin(Command command, Turn& t);
    [[nodiscard]] std::string plan(const CommandBody& body, mirror::Order& order) const;
    void answered(const mirror::Answer& answer, Turn& t);
    void finish(const mirror::Answer& answer, Turn& t);
    [[nodiscard]] AxisId axis() const noexcept { return setup_.axes.empty() ? no_axis : setup_.axes.front().id; }

    Line& line_;
    DriveSetup setup_;
    Duration answer_time_;
    Presence presence_;
    drive::CommandQueue queue_;
    drive::Tickets tickets_;
    drive::StopLane<Stop, 8> stops_;
    drive::Exchange<std::uint64_t> poll_;
    drive::PollTimer timer_;
    drive::Pace pace_;
    std::optional<Running> running_;
    std::optional<Renewal> renewal_;
    std::optional<Renewal> asked_;  ///< of the velocity move on its way: in force once that is taken, for a refusal changes nothing
    AxisFeedback axis_;
    std::uint64_t newest_ = 0;  ///< the greatest number of those that moved the axis: what was asked before tells of what was before
};

}  // namespace axisgate::remote
