// Stream queue: what waits to be sent to one live-feed client.
// In: prepared frames: states by topic, events, control frames. Out: batches in order.
// Bounds: of a state only the newest waits, in the place of the older one (counted as coalesced); events are never dropped: one more than
// the bound is refused and the caller closes the client. Control frames go before everything else; at most 16 wait, further ones replace
// the last (a flood of pings is answered by its newest pong).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace axisgate::http {

/// A whole WebSocket frame, shared by every client that gets it.
using SharedFrame = std::shared_ptr<const std::string>;

class StreamQueue {
public:
    explicit StreamQueue(std::size_t max_events) : max_events_(max_events) {}

    /// `topic`: a number of the topic. True if an older state of it was waiting and is replaced.
    bool push_state(std::uint32_t topic, SharedFrame frame);
    /// False: the bound is reached, nothing was taken.
    [[nodiscard]] bool push_event(SharedFrame frame);
    /// Several states as one run of bytes, for a queue that is empty and emptied at once: none of them can be replaced by a newer one.
    void push_states(SharedFrame frames) { order_.push_back({Item::Kind::states, 0, std::move(frames)}); }
    void push_control(SharedFrame frame);
    /// Drops everything that waits.
    void clear();

    [[nodiscard]] bool empty() const noexcept { return order_.empty() && control_.empty(); }
    [[nodiscard]] bool state_waits(std::uint32_t topic) const { return states_.contains(topic); }
    [[nodiscard]] std::size_t events_waiting() const noexcept { return events_; }
    /// The next frames in order, of about `max_bytes` together; at least one if there is any.
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
