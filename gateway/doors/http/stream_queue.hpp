// The waiting frames of one live-feed client: states by topic, events, control frames. Bounds: of a state only the newest waits, in the
// place of the older one (counted as coalesced); one event more than the bound is refused and the caller closes the client. Control frames
// go before everything else; at most 16 wait, further ones replace the last (a flood of pings is answered by its newest pong).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace axisgate::http {

/// A whole WebSocket frame, shared by all clients that get it.
using SharedFrame = std::shared_ptr<const std::string>;

class StreamQueue {
public:
    explicit StreamQueue(std::size_t max_events) : max_events_(max_events) {}

    /// `topic` is the number of the topic. Returns true if a waiting older state was replaced.
    bool push_state(std::uint32_t topic, SharedFrame frame);
    /// Returns false if the bound is reached; the frame is not queued then.
    [[nodiscard]] bool push_event(SharedFrame frame);
    /// Several states as one run of bytes, for a queue that is empty and emptied at once, so that none of them needs to be replaced.
    void push_states(SharedFrame frames) { order_.push_back({Item::Kind::states, 0, std::move(frames)}); }
    void push_control(SharedFrame frame);
    /// Drops everything that waits.
    void clear();

    [[nodiscard]] bool empty() const noexcept { return order_.empty() && control_.empty(); }
    [[nodiscard]] bool state_waits(std::uint32_t topic) const { return states_.contains(topic); }
    [[nodiscard]] std::size_t events_waiting() const noexcept { return events_; }
    /// The next frames in order, of about `max_bytes` together; at least one if there are any.
    [[nodiscard]] std::vector<SharedFrame> take(std::size_t max_bytes);

private:
    static constexpr std::size_t most_control = 16;
    struct Item {
        enum class Kind { state, event, states } kind = Kind::state;
        std::uint32_t topic = 0;  ///< of a state, whose frame is in states_
        SharedFrame frame;        ///< of the others
    };
    std::size_t max_events_;
    std::size_t events_ = 0;
    std::deque<SharedFrame> control_;
    std::deque<Item> order_;
    std::unordered_map<std::uint32_t, SharedFrame> states_;
};

}  // namespace axisgate::http
