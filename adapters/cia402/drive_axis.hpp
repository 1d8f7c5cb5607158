// Axis is one axis of a node: its queue, its stops, and the next SDO transfer that it needs. It never sends: the node has one SDO channel,
// and the drive gives it to one axis after the other. Its PDOs are evaluated in feedback.hpp, its streamed set-points in demand.hpp; its
// plans are in motion.cpp and native.cpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/cia402/demand.hpp"
#include "adapters/cia402/drive_polled.hpp"
#include "adapters/cia402/drive_rates.hpp"
#include "adapters/cia402/drive_turns.hpp"
#include "adapters/cia402/feedback.hpp"
#include "adapters/cia402/start_pdos.hpp"
#include "gateway/drive/command_queue.hpp"

namespace axisgate::cia402_drive {

class Axis {
public:
    Axis(Node& of_node, const AxisSetup& setup)
        : node(of_node), id_(setup.id), place_(static_cast<std::size_t>(setup.channel - 1)), limits_(limits_of(setup)) {}

    using Limits = std::array<std::optional<std::int64_t>, 2>;  ///< of the site: lowest and highest position, increments
    /// True: the limits have changed; they are written with the next set-up.
    bool set_limits(const AxisSetup& setup) {
        const Limits before = std::exchange(limits_, limits_of(setup));
        return limits_ != before;
    }
    [[nodiscard]] bool limited() const noexcept { return limits_[0] || limits_[1]; }

    // start.cpp
    void first_reads(std::vector<Step>& steps) const;
    void first_read(const Step& step, const canopen::SdoEnd& end);
    void set_up(std::vector<Step>& steps);
    void want_pdos(std::vector<PdoSetUp::Wanted>& wanted);
    void made_ready(Instant now);
    void begin_anew() noexcept { new_ = true; }
    [[nodiscard]] bool is_new() const noexcept { return new_; }  ///< must be read and set up before commands are carried out
    /// The axis is gone, or starts again: all orders are forgotten. The caller answers their tickets.
    void forget();
    void forget_stops() noexcept { stops_.clear(); }
    /// Another NMT master has stopped the node: the command in progress cannot continue.
    void node_stopped(Turn& t);
    /// To be called with each status word that arrives.
    void saw_status(unsigned statusword) noexcept;

    /// The drive has left "operation enabled" by itself while the control word still enables it: writes a control word without the enable
    /// bits, so that only a new Enable switches the power on again.
    void withdraw();
    /// An Enable is in progress.
    [[nodiscard]] bool enabling() const noexcept { return job_ && std::holds_alternative<Enable>(job_->command.body); }

    /// False: the command was answered, or waits. True: it was a stop, and the transfer in progress is not repeated.
    bool submit(const Command& command, Turn& t);
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant wish() const noexcept;
    /// The transfer that the axis needs now; empty: none any more.
    [[nodiscard]] std::optional<Ask> next(Turn& t);
    enum class News : std::uint8_t { none, deaf, node_resets };
    News answered(const Ask& ask, const canopen::SdoEnd& end, Turn& t);
    void unanswered(const Ask& ask, Turn& t);

    [[nodiscard]] AxisId id() const noexcept { return id_; }
    [[nodiscard]] std::size_t place() const noexcept { return place_; }  ///< among the axes of the node, from 0
    /// The axis has the objects of the profile, so that its PDOs are expected.
    [[nodiscard]] bool listens() const noexcept { return node.presence.is(Presence::Phase::ready) && known.profile; }
    /// It has power in a cyclic mode: the drive may monitor the SYNC, also between two streams.
    [[nodiscard]] bool needs_even_syncs() const noexcept {
        return listens() && known.fb.power == AxisFeedback::Power::on && known.mode >= 7 && known.mode <= 10;
    }
    [[nodiscard]] bool quick() const noexcept { return listens() && (known.fb.moving || stream.on() || job_ || !stops_.empty()); }

    Node& node;
    AxisKnown known;
    Feedback feedback{*this};
    Polled polled{*this};
    PdoTurns turns{*this};
    Rates rates{*this};
    SetPointStream stream{*this};

private:
    struct Stop {
        Command command;
        std::optional<Job> job;
    };

    [[nodiscard]] static Limits limits_of(const AxisSetup& setup) { return {setup.position_min, setup.position_max}; }
    void begin(Command command, Turn& t);
    [[nodiscard]] std::optional<Ask> next_of_its_own(Turn& t);
    /// A stop by the gateway itself: `planned` makes its steps; nullptr: the steps of `body` are planned when the stop is sent.
    void take_back(CommandBody body, void (*planned)(const AxisKnown&, Job&));
    News step_done(Job& job, const canopen::SdoEnd& end, Turn& t);
    void drop(const Job& job) noexcept;
    [[nodiscard]] bool still_waits(Job& job, const Step& step, const canopen::SdoEnd& end, Turn& t);
    News finish(Job& job, Turn& t);
    void moves_now(const CommandBody& body, std::int64_t here, Turn& t);
    [[nodiscard]] static Step here(const Job& job);
    [[nodiscard]] bool read_value(const Job& job, const ReadParameter& read, Value& value, Turn& t);
    [[nodiscard]] std::string native_text(const Job& job) const;
    void written(const WriteParameter& to);

    AxisId id_;
    std::size_t place_;
    Limits limits_;
    drive::CommandQueue queue_;
    drive::StopLane<Stop, 8> stops_;
    std::optional<Job> job_;
    bool new_ = true, change_quick_stop_ = false;
};

}  // namespace axisgate::cia402_drive
