// Change queue: changes of one thing (the site, the recipes, the users) one after the other, so that two clients who change it at once do
// not hinder one another. In: jobs, each with its own end. Out: they are run in order, the next when the one before has ended: has said so,
// has thrown, or has been let go without a word. Bound: 64 wait; one more is refused. Never runs two at a time, and never recurses however
// many end at once.
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace axisgate {

class ChangeQueue : public std::enable_shared_from_this<ChangeQueue> {
public:
    static constexpr std::size_t most_waiting = 64;
    /// Calls `done` once, at once or later. A job that keeps it and never does holds up all that come after it.
    using Job = std::function<void(std::function<void()> done)>;
    /// Told what a job threw, so that whoever waits for its answer hears of it.
    using Failed = std::function<void(const std::string& what)>;

    /// False: too many wait already; the job is not taken.
    [[nodiscard]] bool run(Job job, Failed failed) {
        if (waiting_.size() >= most_waiting) return false;
        waiting_.emplace_back(std::move(job), std::move(failed));
        pump();
        return true;
    }

private:
    /// A job's turn: over when `done` was called, or when nobody is left who could.
    struct Turn {
        std::shared_ptr<ChangeQueue> queue;
        explicit Turn(std::shared_ptr<ChangeQueue> q) : queue(std::move(q)) {}
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        ~Turn() { end(); }
        void end() {
            if (const auto q = std::exchange(queue, nullptr)) {
                q->busy_ = false;
                q->pump();
            }
        }
    };

    void pump() {
        if (pumping_) return;
        pumping_ = true;
        while (!busy_ && !waiting_.empty()) {
            busy_ = true;
            const auto [job, failed] = std::move(waiting_.front());
            waiting_.pop_front();
            auto turn = std::make_shared<Turn>(shared_from_this());
            try {
                job([turn] { turn->end(); });
            } catch (const std::exception& e) {
                turn->end();
                report(failed, e.what());
            } catch (...) {
                turn->end();
                report(failed, "unknown");
            }
        }
        pumping_ = false;
    }
    static void report(const Failed& failed, const std::string& what) noexcept {
        try {
            if (failed) failed(what);
        } catch (...) {  // nobody is left to be told
        }
    }

    std::deque<std::pair<Job, Failed>> waiting_;
    bool busy_ = false, pumping_ = false;
};

}  // namespace axisgate
