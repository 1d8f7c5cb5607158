// Dialogue: a drive that answers each request by one message, as most text and register languages do: everything of it but its language.
// In: commands, set-points, messages, the passing of time, a place on the line. Out: requests; feedback, results, links, ends of streams.
// The family derives, and says by the functions of Language what a command is in messages and what a message means.
// One question at a time; a stop goes before what waits, and ends it; what came too late is never taken for something new.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/drive/bus.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/drive_base.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/language.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/set_points.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::drive {

/// `Message` is the family's: a value that can be compared. Axes are told apart by their channel 1..`Channels`.
template <class Message, int Channels>
class Dialogue : public DriveBase, protected Language<Message> {
public:
    static constexpr int channels = Channels;
    static constexpr std::size_t stop_limit = 8;  ///< on their way at once; one more is refused as busy
    using Job = DialogueJob<Message>;

    Dialogue(Bus& bus, const DriveSetup& setup, std::size_t slot) : DriveBase(setup, bus.timing, slot, Channels), bus_(bus) {}

    // --- for LineAdapter, and for settle, serve and wake ------------------------------------------------------------------------
    void line_up(Turn& t) { presence.begin(t.now); }
    void line_down(std::string_view why, Turn& t) {
        remove(why, t);
        presence.report(std::string(why), t.out);
    }
    void remove(std::string_view why, Turn& t) {
        presence.close();
        exchange_.drop();
        stops_.clear();
        end_all(Reason::line_down, why, t);
    }
    /// The site has other axes of this drive: those that stay go on.
    void set_axes(const DriveSetup& setup, Turn& t);
    void look(const DriveSetup& setup) noexcept {
        if (pace_.take(setup)) polls_.hurry();
    }
    void follow(const SetPoint& p) {
        if (presence.online()) set_points_.put(p);
    }
    void submit(const Command& command, Turn& t);
    void on_message(const Message& message, Turn& t);
    [[nodiscard]] Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return exchange_.deadline(); }
    [[nodiscard]] Instant wish() const noexcept { return std::min(presence.deadline(), polls_.deadline()); }
    void go(Turn& t);
    void on_deadline(Turn& t);

protected:
    // --- for its language -------------------------------------------------------------------------------------------------------
    [[nodiscard]] AxisFeedback& axis(int channel) noexcept { return at(channel).feedback; }
    [[nodiscard]] const AxisFeedback& axis(int channel) const noexcept { return axes_[place(channel)].feedback; }
    [[nodiscard]] int channel_of(AxisId axis) const noexcept {
        const auto it = std::ranges::find(setup_.axes, axis, &AxisSetup::id);
        return it == setup_.axes.end() || !has(it->channel) ? 1 : it->channel;
    }
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return bus_.catalogue; }

private:
    /// What was asked, and why.
    struct Ask {
        enum class Why : std::uint8_t { probe, poll, step, stop } why = Why::probe;
        Message message;
        Ticket ticket = no_ticket;
        int channel = 0;                    ///< 0: of the whole drive
        std::uint64_t job = 0;              ///< whose step it is
        std::optional<CommandBody> body{};  ///< of a stop that a client has ordered
    };
    struct Axis {
        AxisFeedback feedback;
        Move followed;  ///< whose ramps and speed the drive was told last by a stream
    };
    [[nodiscard]] static Polls::Item item(int channel) noexcept { return static_cast<Polls::Item>(channel); }
    [[nodiscard]] static std::size_t place(int channel) noexcept { return has(channel) ? static_cast<std::size_t>(channel) : 0; }
    [[nodiscard]] Axis& at(int channel) noexcept { return axes_[place(channel)]; }
    [[nodiscard]] static bool has(int channel) noexcept { return channel >= 1 && channel <= Channels; }
    void poll_every(int channel, Turn& t) {
        if (has(channel)) (void)polls_.every(item(channel), bus_.timing.poll_period, t.now);
    }
    void send(Ask ask, int retries, Turn& t);
    void transmit(Turn& t) const;
    void answered(const Ask& ask, const Message& answer, Turn& t);
    void learnt(int channel, Turn& t);
    void emit(int channel, Turn& t);
    void begin(Job job, Turn& t);
    [[nodiscard]] Job job_for(const SetPoint& set_point);
    void step_answered(const Message& answer, Turn& t);
    void finish(const Job& job, const Reported& reported, Turn& t);
    [[nodiscard]] const Parameter* parameter_of(const CommandBody& body) const;
    void end_all(Reason reason, std::string_view why, Turn& t);

    Bus& bus_;
    CommandQueue queue_;
    StopLane<Ask, stop_limit> stops_;
    Exchange<Ask> exchange_;
    LateMarks<Message, 8> late_;
    Pace pace_;
    Polls polls_;  ///< items are channels
    SetPoints set_points_;
    bool streamed_last_ = false;
    std::optional<Job> job_;
    std::uint64_t jobs_ = 0;
    std::array<Axis, Channels + 1> axes_;  ///< by channel; 0: of a channel that there is not
};

}  // namespace axisgate::drive

#include "gateway/drive/dialogue_run.hpp"  // IWYU pragma: keep
