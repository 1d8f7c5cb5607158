// A newer state replaces the waiting one, so the order of topics stays. An event is never dropped silently.
#include "gateway/doors/http/stream_queue.hpp"

namespace axisgate::http {

bool StreamQueue::push_state(std::uint32_t topic, SharedFrame frame) {
    const auto [it, fresh] = states_.insert_or_assign(topic, std::move(frame));
    if (fresh) order_.push_back({Item::Kind::state, topic, {}});
    return !fresh;
}

bool StreamQueue::push_event(SharedFrame frame) {
    if (events_ >= max_events_) return false;
    ++events_;
    order_.push_back({Item::Kind::event, 0, std::move(frame)});
    return true;
}

void StreamQueue::push_control(SharedFrame frame) {
    if (control_.size() >= most_control) control_.pop_back();
    control_.push_back(std::move(frame));
}

void StreamQueue::clear() {
    control_.clear();
    order_.clear();
    states_.clear();
    events_ = 0;
}

std::vector<SharedFrame> StreamQueue::take(std::size_t max_bytes) {
    std::vector<SharedFrame> out;
    std::size_t bytes = 0;
    const auto fits = [&](const SharedFrame& f) { return out.empty() || bytes + f->size() <= max_bytes; };
    const auto put = [&](SharedFrame f) {
        bytes += f->size();
        out.push_back(std::move(f));
    };
    while (!control_.empty() && fits(control_.front())) {
        put(std::move(control_.front()));
        control_.pop_front();
    }
    while (!order_.empty()) {
        Item& item = order_.front();
        const auto state = item.kind == Item::Kind::state ? states_.find(item.topic) : states_.end();
        SharedFrame& frame = state != states_.end() ? state->second : item.frame;
        if (!fits(frame)) break;
        put(std::move(frame));
        if (item.kind == Item::Kind::state) {
            states_.erase(state);
        } else if (item.kind == Item::Kind::event) {
            --events_;
        }
        order_.pop_front();
    }
    return out;
}

}  // namespace axisgate::http
