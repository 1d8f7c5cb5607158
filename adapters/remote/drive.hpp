// Drive is one axis of another gateway: its state by request and by reports of its gateway, and one command at a time, with stops beside
// it. A command is never sent twice; a stop is repeated. A velocity move continues at the other gateway only while it is renewed from here,
// so it ends by itself if the connection is lost. drive.cpp has transmission and feedback, motion.cpp the verbs and their results.
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

/// The members that the axes of one line share.
struct Line : drive::Bus {
    using drive::Bus::Bus;
    void take(const LineSetup& setup, Instant now);
    Duration stale_after{};
    std::uint64_t next = 0;  ///< number of the next request; it is higher in an adapter that was made later
};

class Drive {
public:
    static constexpr int channels = 1;
    static constexpr Duration hold = std::chrono::seconds(2);            ///< duration of a velocity move at the other gateway without a
                                                                         ///< renewal ...
    static constexpr Duration renewed = std::chrono::milliseconds(600);  ///< ... and the interval of renewals
    Drive(Line& line, const DriveSetup& setup);

    void line_up(Turn& t) { presence_.begin(t.now); }
    void line_down(std::string_view why, Turn& t);
    void remove(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void on_telegram(const mirror::Telegram& telegram, Turn& t);
    /// Sends all requests that are due.
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
        Instant again = Instant{};  ///< time of the next repetition, if any are left
        int left = 0;
    };
    struct Running {
        Command command;
        std::uint64_t number = 0;
        Instant until = never;
    };
    struct Renewal {
        mirror::Order order;
        std::uint64_t number = 0;  ///< of the last request
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
    std::optional<Renewal> asked_;  ///< of the velocity move that was requested, which may turn before its answer comes; replaces renewal_
                                    ///< once that is accepted, because a refusal changes nothing
    AxisFeedback axis_;
    Instant begun_{};           ///< when the last motion was accepted
    std::uint64_t newest_ = 0;  ///< the highest number of the requests that moved the axis: states that were requested before are older
};

}  // namespace axisgate::remote
