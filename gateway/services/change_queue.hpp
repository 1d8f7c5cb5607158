// Runs changes of one object (the site, the recipes, the users) one after the other, so that two clients that change it at once do not
// disturb each other. A job ends when it calls `done`, throws, or destroys `done` without calling it. Bound: 64 jobs wait; further ones are
// refused. Two jobs never run at a time, and many that end at once cause no recursion.
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
    /// Calls `done` once, at once or later. A job that keeps `done` and never calls it blocks all later ones.
    using Job = std::function<void(std::function<void()> done)>;
    /// Gets the text of an exception that a job threw, for the client that waits for its answer.
    using Failed = std::function<void(const std::string& what)>;

    /// Returns false if too many wait; the job is not accepted then.
    [[nodiscard]] bool run(Job job, Failed failed) {
        if (waiting_.size() >= most_waiting) return false;
        waiting_.emplace_back(std::move(job), std::move(failed));
        pump();
        return true;
    }

private:
    /// The turn of a job: it ends when `done` was called, or when no copy of it exists any more.
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
        } catch (...) {  // no client is left to be informed
        }
    }

    std::deque<std::pair<Job, Failed>> waiting_;
    bool busy_ = false, pumping_ = false;
};

}  // namespace axisgate
