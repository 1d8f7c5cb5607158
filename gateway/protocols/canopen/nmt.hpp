// NMT and error control (CiA 301, 7.2.8): commands to nodes, their states, heartbeat and node guarding, each from both sides.
// In: frames, time. Out: frames, the next deadline, and what became known of a node: it has started, its state is another, it has fallen
// silent. Never starts or resets a node by itself: that is its owner's.
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

/// `node` 0: all of them.
[[nodiscard]] Frame nmt_frame(NmtCommand command, std::uint8_t node) noexcept;
/// The command, if the frame is one for this node or for all.
[[nodiscard]] std::optional<NmtCommand> nmt_for(const Frame& frame, std::uint8_t node) noexcept;
/// A heartbeat, or with boot_up the message of a node that has started.
[[nodiscard]] Frame heartbeat_frame(std::uint8_t node, NmtState state) noexcept;

/// What a watcher has learnt.
enum class NodeNews : std::uint8_t {
    nothing,
    started,  ///< its boot-up message: whatever was configured may be gone
    state,    ///< it is in another state than before, or known for the first time
    lost,     ///< silent for too long; told once
    back      ///< it is heard again, in the state that `state` says
};

/// Listens for one node's heartbeats. With a time of 0 it only listens, and never calls a node lost.
class HeartbeatWatch {
public:
    explicit HeartbeatWatch(std::uint8_t node, Duration time = {}) noexcept : node_(node), time_(time) {}
    /// The watch begins with the first message after it is set, as the standard has it.
    void set_time(Duration time) noexcept {
        time_ = time;
        deadline_ = never;
    }
    [[nodiscard]] NodeNews on_frame(const Frame& frame, Instant now) noexcept;
    [[nodiscard]] NodeNews on_deadline(Instant now) noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return deadline_; }
    [[nodiscard]] std::optional<NmtState> state() const noexcept { return state_; }
    [[nodiscard]] bool lost() const noexcept { return lost_; }
    [[nodiscard]] std::uint64_t malformed() const noexcept { return malformed_; }  ///< wrong length, or no state

private:
    std::uint8_t node_;
    Duration time_;
    std::optional<NmtState> state_;
    bool lost_ = false;
    Instant deadline_ = never;
    std::uint64_t malformed_ = 0;
};

/// A node's own heartbeat. With a period of 0 there is none.
class HeartbeatProducer {
public:
    void set_period(Duration period, Instant now) noexcept {
        period_ = period;
        next_ = period_ > Duration{} ? now + period_ : never;
    }
    [[nodiscard]] Instant deadline() const noexcept { return next_; }
    /// One message when it is due; whoever comes late sends one and not those that were missed.
    [[nodiscard]] std::optional<Frame> on_deadline(Instant now, std::uint8_t node, NmtState state) noexcept;

private:
    Duration period_{};
    Instant next_ = never;
};

/// Asks one node for its state by remote frames, and checks that its answers alternate their toggle bit.
class GuardMaster {
public:
    explicit GuardMaster(std::uint8_t node) noexcept : node_(node) {}
    /// `guard_time` 0: off. Lost after `life_factor` (at least 1) times that without a good answer.
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
    [[nodiscard]] std::uint64_t wrong_toggles() const noexcept { return wrong_toggles_; }  ///< such an answer counts as none

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

/// The guarded node: answers, and notices when nobody asks any more (a life guarding event; told once, after the first question).
class GuardSlave {
public:
    void set(Duration guard_time, std::uint8_t life_factor) noexcept {
        life_ = guard_time * life_factor;
        deadline_ = never;
    }
    /// After a reset of the communication the toggle bit begins anew.
    void reset() noexcept {
        toggle_ = false;
        deadline_ = never;
    }
    [[nodiscard]] std::optional<Frame> on_frame(const Frame& frame, Instant now, std::uint8_t node, NmtState state) noexcept;
    [[nodiscard]] bool on_deadline(Instant now) noexcept;  ///< true: nobody has asked for the life time
    [[nodiscard]] Instant deadline() const noexcept { return deadline_; }

private:
    Duration life_{};
    Instant deadline_ = never;
    bool toggle_ = false;
};

}  // namespace axisgate::canopen
