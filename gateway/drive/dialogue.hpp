// Dialogue is a complete drive for languages in which each request is answered by one message, as in most text and register protocols. The
// family derives from it and implements Language: which messages a command needs, and what a message means. One request is outstanding at a
// time. A stop is sent before all waiting requests and ends them; a late answer is never taken for the answer to a newer request.
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

/// `Message` is a type of the family whose values can be compared. The axes are identified by their channel 1..`Channels`.
template <class Message, int Channels>
class Dialogue : public DriveBase, protected Language<Message> {
public:
    static constexpr int channels = Channels;
    static constexpr std::size_t stop_limit = 8;  ///< stops that can be in progress at once; a further one is refused as busy
    /// A drive that has acknowledged an enable shows its power within this time; the enable is answered then.
    static constexpr Duration power_shows_within = std::chrono::seconds(3);
    /// The state of a drive may show a change so late: power that is shown after an acknowledged disable is that of before, and so is rest
    /// behind a move, further than `play` increments from its target.
    static constexpr Duration state_is_late = std::chrono::milliseconds(500);
    static constexpr std::int64_t play = 50;
    using Job = DialogueJob<Message>;

    Dialogue(Bus& bus, const DriveSetup& setup, std::size_t slot) : DriveBase(setup, bus.timing, slot, Channels), bus_(bus) {}

    // --- for LineAdapter, settle, serve and wake -----------------------------------------------------------------------------------
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
    /// The site has changed the axes of this drive. Axes that remain are not disturbed.
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
    // --- for the language -----------------------------------------------------------------------------------------------------------
    [[nodiscard]] AxisFeedback& axis(int channel) noexcept { return at(channel).feedback; }
    [[nodiscard]] const AxisFeedback& axis(int channel) const noexcept { return axes_[place(channel)].feedback; }
    [[nodiscard]] int channel_of(AxisId axis) const noexcept {
        const auto it = std::ranges::find(setup_.axes, axis, &AxisSetup::id);
        return it == setup_.axes.end() || !has(it->channel) ? 1 : it->channel;
    }
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return bus_.catalogue; }

private:
    /// An outstanding request and its purpose.
    struct Ask {
        enum class Why : std::uint8_t { probe, poll, step, stop } why = Why::probe;
        Message message;
        Ticket ticket = no_ticket;
        int channel = 0;                    ///< 0: the request concerns the whole drive
        std::uint64_t job = 0;              ///< number of the job that the request is a step of
        std::optional<CommandBody> body{};  ///< the client's command, if the request is a stop
    };
    struct Axis {
        AxisFeedback feedback;
        Move followed;                 ///< speed and ramps that a stream has sent to the drive last
        std::vector<Ticket> enabling;  ///< enables that the drive has acknowledged without showing its power yet
        Instant on_by{};               ///< until then at the latest
        Instant off_until{};           ///< a disable was acknowledged: the power that is shown until then may be that of before
        Instant rest_until{};          ///< a move was acknowledged: rest that is shown until then away from `target` is that of before
        std::int64_t target = 0;       ///< of that move, increments
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
    void look_for_power(int channel, Turn& t);
    void leave_out_older(Axis& axis, Instant now) const;
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
    Polls polls_;  ///< the items are channels
    SetPoints set_points_;
    bool streamed_last_ = false;
    std::optional<Job> job_;
    std::uint64_t jobs_ = 0;
    std::array<Axis, Channels + 1> axes_;  ///< by channel; entry 0 stands for a channel that does not exist
};

}  // namespace axisgate::drive

#include "gateway/drive/dialogue_run.hpp"  // IWYU pragma: keep
