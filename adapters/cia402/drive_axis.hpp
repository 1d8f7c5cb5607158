// Axis: one axis of a node: its queue and stops, what its PDOs tell, and what it is led with.
// In: commands, set-points, answers to what it asked for, PDOs, time. Out: what it asks for next; feedback, results.
// Never sends a request by itself: the drive has one transfer with the node at a time, and gives it to one axis after the other.
// Written in: drive_axis.cpp what it asks for next and what answers mean, feedback.cpp what it learns, demand.cpp the way of a streamed
// set-point. Its plans (motion.cpp, native.cpp) are functions of what it knows.
#pragma once

#include <array>
#include <optional>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_plans.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/lead.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {

class Axis {
public:
    Axis(Node& node, const AxisSetup& setup) : node_(node), id_(setup.id), place_(static_cast<std::size_t>(setup.channel - 1)) {}

    // start.cpp
    void first_reads(std::vector<Step>& steps) const;
    void first_read(const Step& step, const canopen::SdoEnd& end);
    void set_up(std::vector<Step>& steps) const;
    void made_ready(Instant now);
    void begin_anew() noexcept { new_ = true; }
    [[nodiscard]] bool is_new() const noexcept { return new_; }  ///< to be read and set up before it is served
    /// It is gone, or begins anew: nothing that was ordered holds any more. Its tickets are the caller's.
    void forget();
    void forget_stops() noexcept { stops_.clear(); }
    void restarted();

    /// False: the command is answered, or waits; true: it was a stop, and whatever is on the way is not repeated.
    bool submit(const Command& command, Turn& t);
    void follow(const SetPoint& set_point);
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant wish() const noexcept;
    /// What it asks for now; nothing: it has changed its mind.
    [[nodiscard]] std::optional<Ask> next(Turn& t);
    enum class News : std::uint8_t { none, deaf, node_resets };
    News answered(const Ask& ask, const canopen::SdoEnd& end, Turn& t);
    void unanswered(const Ask& ask);
    void look_soon(Instant now) noexcept { check_at_ = std::min(check_at_, now); }

    void on_status(std::span<const std::uint8_t> bytes, Turn& t);
    void on_motion(std::span<const std::uint8_t> bytes, Turn& t);
    /// Of an EMCY; 0: all errors are gone. The first one is the cause, what follows from it does not take its place.
    void on_error_code(std::uint16_t code) noexcept {
        if (code == 0 || known_.fb.error_code == 0) known_.fb.error_code = code;
    }
    void before_sync(Duration cycle, Turn& t);
    void after_sync() noexcept { status_new_ = motion_new_ = false; }

    [[nodiscard]] AxisId id() const noexcept { return id_; }
    [[nodiscard]] std::size_t place() const noexcept { return place_; }  ///< among the axes of the node, from 0
    /// It has the profile's objects, so that its PDOs are waited for.
    [[nodiscard]] bool listens() const noexcept { return node_.presence.is(Presence::Phase::ready) && known_.profile; }
    [[nodiscard]] bool quick() const noexcept { return listens() && (known_.fb.moving || streams() || job_ || !stops_.empty()); }
    [[nodiscard]] bool streams() const noexcept { return newest_ || stream_ != Stream::none; }
    [[nodiscard]] bool moving() const noexcept { return known_.fb.moving; }

private:
    struct Stop {
        Command command;
        std::optional<Job> job;
    };
    enum class Stream : std::uint8_t { none, starting, position, velocity, torque };

    void begin(Command command, Turn& t);
    News step_done(Job& job, const canopen::SdoEnd& end, Turn& t);
    News finish(Job& job, Turn& t);
    [[nodiscard]] static Step here(const Job& job);
    [[nodiscard]] Address asked(const Step& step) const;  ///< as the node has it
    [[nodiscard]] bool read_value(const Job& job, const ReadParameter& read, Value& value, Turn& t);
    [[nodiscard]] std::string native_text(const Job& job) const;
    void written(const WriteParameter& to);
    void end_stream() noexcept;
    void lead(Turn& t, Duration cycle);
    void learnt(Turn& t);
    void judge(Turn& t);
    void emit(Turn& t);

    Node& node_;
    AxisId id_;
    std::size_t place_;
    AxisKnown known_;
    drive::CommandQueue queue_;
    drive::StopLane<Stop, 8> stops_;
    std::optional<Job> job_;
    bool status_new_ = false, motion_new_ = false, need_code_ = false;
    int fresh_ = 0;  ///< status words since a new set-point that do not tell of it yet
    bool new_ = true, change_quick_stop_ = false;
    Instant check_at_ = never;
    int deaf_ = 0;  ///< answers by SDO in a row without a PDO between them

    Stream stream_ = Stream::none;
    std::optional<SetPoint> newest_;
    drive::Lead led_;
};

}  // namespace axisgate::cia402_drive
