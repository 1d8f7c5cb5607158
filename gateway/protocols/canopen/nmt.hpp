// NMT and error control (CiA 301, 7.2.8): commands to nodes, their states, heartbeat and node guarding, each from both sides.
// Frames and time come in; frames, the next deadline, and the events of a node come out: it has started, has changed its state, or has
// fallen silent. No node is started or reset from here: the owner does that.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen {

enum class NmtCommand : std::uint8_t { start = 1, stop = 2, pre_operational = 128, reset_node = 129, reset_communication = 130 };
enum class NmtState : std::uint8_t { boot_up = 0, stopped = 4, operational = 5, pre_operational = 127 };
[[nodiscard]] std::string_view name_of(NmtCommand command) noexcept;  ///< "start", "reset communication"
[[nodiscard]] std::string_view name_of(NmtState state) noexcept;      ///< "operational"
[[nodiscard]] std::optional<NmtCommand> nmt_command_of(std::uint8_t byte) noexcept;
[[nodiscard]] std::optional<NmtState> nmt_state_of(std::uint8_t byte) noexcept;

/// `node` 0 addresses all nodes.
[[nodiscard]] Frame nmt_frame(NmtCommand command, std::uint8_t node) noexcept;
/// The command, if the frame addresses this node or all nodes.
[[nodiscard]] std::optional<NmtCommand> nmt_for(const Frame& frame, std::uint8_t node) noexcept;
/// A heartbeat; with the state boot_up, the message of a node that has started.
[[nodiscard]] Frame heartbeat_frame(std::uint8_t node, NmtState state) noexcept;

/// The events of a supervised node.
enum class NodeNews : std::uint8_t {
    nothing,
    started,  ///< its boot-up message: its configuration may be lost
    state,    ///< it has changed its state, or its state is known for the first time
    lost,     ///< silent for too long; reported once
    back      ///< it sends again; `state` is its state
};

/// Receives the heartbeats of one node. With a time of 0, a node never counts as lost.
class HeartbeatWatch {
public:
    explicit HeartbeatWatch(std::uint8_t node, Duration time = {}) noexcept : node_(node), time_(time) {}
    /// Supervision begins with the first message after the time is set, as the standard requires.
    void set_time(Duration time) noexcept {
        time_ = time;
        deadline_ = never;
    }
    [[nodiscard]] NodeNews on_frame(const Frame& frame, Instant now) noexcept;
    [[nodiscard]] NodeNews on_deadline(Instant now) noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return deadline_; }
    [[nodiscard]] std::optional<NmtState> state() const noexcept { return state_; }
    [[nodiscard]] bool lost() const noexcept { return lost_; }
    [[nodiscard]] std::uint64_t malformed() const noexcept { return malformed_; }  ///< messages with a wrong length or an unknown state

private:
    std::uint8_t node_;
    Duration time_;
    std::optional<NmtState> state_;
    bool lost_ = false;
    Instant deadline_ = never;
    std::uint64_t malformed_ = 0;
};

/// Sends a node's own heartbeat; a period of 0 switches it off.
class HeartbeatProducer {
public:
    void set_period(Duration period, Instant now) noexcept {
        period_ = period;
        next_ = period_ > Duration{} ? now + period_ : never;
    }
    [[nodiscard]] Instant deadline() const noexcept { return next_; }
    /// Returns a message when it is due; a late call returns one message and not the missed ones.
    [[nodiscard]] std::optional<Frame> on_deadline(Instant now, std::uint8_t node, NmtState state) noexcept;

private:
    Duration period_{};
    Instant next_ = never;
};

/// Requests the state of one node with remote frames, and checks that the toggle bit of its answers alternates.
class GuardMaster {
public:
    explicit GuardMaster(std::uint8_t node) noexcept : node_(node) {}
    /// `guard_time` 0: off. The node is lost after `life_factor` (at least 1) times that without a valid answer.
    void set(Duration guard_time, std::uint8_t life_factor, Instant now) noexcept;
    [[nodiscard]] NodeNews on_frame(const Frame& frame, Instant now) noexcept;
    struct Step {
        std::optional<Frame> ask;
        NodeNews news = NodeNews::nothing;
    };
    [[nodiscard]] Step on_deadline(Instant now) noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return next_; }
    [[nodiscard]] std::optional<NmtState> state() const noexcept { return state_; }
    [[nodiscard]] bool lost() const noexcept { return lost_; }
    /// answers with the wrong toggle bit; they do not count as valid
    [[nodiscard]] std::uint64_t wrong_toggles() const noexcept { return wrong_toggles_; }

private:
    std::uint8_t node_;
    Duration guard_time_{};
    std::uint8_t life_factor_ = 1;
    Instant next_ = never, silent_since_{};
    bool toggle_ = false;
    bool lost_ = false;
    std::optional<NmtState> state_;
    std::uint64_t wrong_toggles_ = 0;
};

/// The guarded node: answers requests, and detects when they stop (a life guarding event; reported once, after the first request).
class GuardSlave {
public:
    void set(Duration guard_time, std::uint8_t life_factor) noexcept {
        life_ = guard_time * life_factor;
        deadline_ = never;
    }
    /// After a communication reset the toggle bit is clear again.
    void reset() noexcept {
        toggle_ = false;
        deadline_ = never;
    }
    [[nodiscard]] std::optional<Frame> on_frame(const Frame& frame, Instant now, std::uint8_t node, NmtState state) noexcept;
    [[nodiscard]] bool on_deadline(Instant now) noexcept;  ///< true: no request has come for the life time
    [[nodiscard]] Instant deadline() const noexcept { return deadline_; }

private:
    Duration life_{};
    Instant deadline_ = never;
    bool toggle_ = false;
};

}  // namespace axisgate::canopen
