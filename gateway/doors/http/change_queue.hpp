// Change queue: changes of one thing (the site, the recipes, the users) one after the other, so that two clients who change it at once do not hinder one another.
// In: jobs, each with its own end. Out: they are run in order, the next when the one before has ended.
// Bound: 64 wait; one more is refused. Never runs two at a time, and never recurses however many end at once.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>

namespace axisgate::http {

class ChangeQueue : public std::enable_shared_from_this<ChangeQueue> {
public:
    static constexpr std::size_t most_waiting = 64;
    /// Calls `done` once, at once or later. A job that never does holds up all that come after it.
    using Job = std::function<void(std::function<void()> done)>;

    /// False: too many wait already; the job is not taken.
    [[nodiscard]] bool run(Job job) {
        if (waiting_.size() >= most_waiting) return false;
        waiting_.push_back(std::move(job));
        pump();
        return true;
    }

private:
    void pump() {
        if (pumping_) return;
        pumping_ = true;
        while (!busy_ && !waiting_.empty()) {
            busy_ = true;
            const Job job = std::move(waiting_.front());
            waiting_.pop_front();
            job([self = shared_from_this()] {
                self->busy_ = false;
                self->pump();
            });
        }
        pumping_ = false;
    }

    std::deque<Job> waiting_;
    bool busy_ = false, pumping_ = false;
};

}  // namespace axisgate::http
