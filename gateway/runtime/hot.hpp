// Hot is the thread with real-time requirements: lines, twins, engine and the cyclic doors run on one io_context, so that no message
// between them passes to another thread. It never waits for a disk, a lock or another thread; results, events and reports go to the other
// threads through mailboxes.
#pragma once

#include <algorithm>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "gateway/core/histogram.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/engine/engine.hpp"
#include "gateway/lines/clock.hpp"
#include "gateway/lines/pair_line.hpp"
#include "gateway/lines/pty_line.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/cold.hpp"
#include "gateway/runtime/event_outlet.hpp"
#include "gateway/runtime/hot_turns.hpp"
#include "gateway/runtime/mailbox.hpp"
#include "gateway/runtime/set_point_slots.hpp"

namespace axisgate {

/// The newest reports of lines and drives, at most 200 ms old, which the warm thread may read at any time.
struct Reports {
    std::vector<LineReport> lines;                      ///< by LineId
    std::vector<DriveStatus> drives;                    ///< by DriveId
    std::vector<std::shared_ptr<const FrameLog>> logs;  ///< by LineId
    std::vector<std::string> complaints;
    bool settled = false;
    std::array<std::uint64_t, most_loss_causes> losses{};  ///< fail-safe actions since the start, by LossCause
};

struct HotSettings {
    std::int64_t spin_us = 0;
    int cpu = -1;
    std::size_t trace_frames = 4096;
    Instant (*clock)() noexcept = monotonic_now;  ///< monotonic; tests use their own clock
    PairEnd fleet{};                              ///< takes the other ends of mirror lines; empty: there is no DDS fleet
    PtyPlaces ptys{};                             ///< where lines of the site may place links to pseudo-terminals
};

class Hot final : public EngineHost, public DoorPort {
public:
    using Job = std::function<void(Engine&, Instant)>;
    struct Outlets {
        Mailbox<Result>* results = nullptr;  ///< to the warm thread: results of its own commands
        Mailbox<Sample>* samples = nullptr;  ///< to the warm thread
        Mailbox<ColdJob>* cold = nullptr;
        std::function<void()> changed{};  ///< hot thread: an axis' picture has changed since want_change
        /// Another thread must be woken. Hot thread.
        [[nodiscard]] bool unannounced() const noexcept {
            return (results && results->unannounced()) || (samples && samples->unannounced()) || (cold && cold->unannounced());
        }
    };

    Hot(Families families, HotSettings settings);
    ~Hot() override;

    void connect(Outlets outlets) {
        events_.connect(outlets.cold);
        out_ = std::move(outlets);
    }
    [[nodiscard]] boost::asio::io_context& context() noexcept { return io_; }
    [[nodiscard]] Mailbox<Command>& commands() noexcept { return commands_; }
    [[nodiscard]] SetPointSlots& set_points() noexcept { return set_points_; }
    [[nodiscard]] Mailbox<Job>& jobs() noexcept { return jobs_; }
    [[nodiscard]] Mailbox<Stored>& stored() noexcept { return stored_; }
    /// Any thread: cells of the image; axis pictures by AxisCell.
    [[nodiscard]] const Image& image_for_readers() const noexcept { return image_; }
    /// Any thread: requests one call of Outlets::changed, after the next change of an axis' picture.
    void want_change() noexcept { change_wanted_.store(true, std::memory_order_release); }
    [[nodiscard]] std::shared_ptr<const Reports> reports() const {
        const std::lock_guard hold(reports_mutex_);
        return reports_;
    }
    [[nodiscard]] Engine& engine() noexcept { return engine_; }  ///< before start(), or on the hot thread

    /// A site is in force: all doors take it over. Hot thread, or before start().
    void publish_site(const SiteState& site);
    /// The attached doors of this thread; before start(), or while no door is attached or detached.
    [[nodiscard]] std::vector<HotDoor*> doors() const;

    /// Returns the real-time priority of its thread; 0: it has none.
    int start();
    /// Stops moving axes, waits a short time for them, closes the lines and ends the thread.
    void stop();
    /// Measurements of its turns. Any thread may read them.
    [[nodiscard]] const HotTurns& turns() const noexcept { return turns_; }
    [[nodiscard]] const Histogram& write_to_frame() const noexcept { return engine_.write_to_frame(); }
    [[nodiscard]] std::uint64_t lost_events() const noexcept { return events_.lost(); }

    // DoorPort (hot thread)
    [[nodiscard]] Instant now() const override;
    [[nodiscard]] const Image& image() const override { return image_; }
    [[nodiscard]] const Catalogue* catalogue(AxisId axis) const override { return engine_.catalogue(axis); }
    void submit(Command command) override;
    std::optional<Refusal> set_point(const SetPoint& set_point) override { return engine_.on_set_point(set_point, now()); }
    void client_lost(const AuthorityClient& who, LossCause cause) override { engine_.on_client_lost(who, cause, now()); }
    void note(Event&& event, AxisId axis) override;
    [[nodiscard]] DoorNumber attach(HotDoor& door) override;
    void detach(HotDoor& door) override { std::ranges::replace(doors_, &door, nullptr); }

    // EngineHost (hot thread)
    std::unique_ptr<Line> make_line(const LineSpec& spec, const LineSetup& setup) override;
    void on_result(const Result& result) override { results_.push_back(result); }
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient& who) const override;
    void on_event(Event event, Instant at) override;
    void on_sample(const Sample& sample) override;
    void on_store(StoreOrder order) override;
    void on_twin_memory(const std::string& drive, NonVolatile memory) override;

private:
    void run();
    void end_turn();
    bool serve_doors();
    void announce();
    void publish_reports(Instant now);

    /// Lines read the loop's time, so that a frame that wakes the loop begins a turn.
    struct LineClock final : Clock {
        explicit LineClock(const Hot& of) : hot(of) {}
        [[nodiscard]] Instant now() const override { return hot.now(); }
        [[nodiscard]] std::int64_t unix_ns() const override { return machine_clock().unix_ns(); }
        const Hot& hot;
    };

    HotSettings settings_;
    boost::asio::io_context io_{1};
    boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
    Doorbell bell_{io_};
    HotTurns turns_{io_, settings_.clock};
    LineClock line_clock_{*this};
    Image image_;
    Engine engine_;
    Outlets out_;
    Mailbox<Command> commands_;
    SetPointSlots set_points_;
    Mailbox<Job> jobs_;
    Mailbox<Stored> stored_;
    std::vector<Command> submitted_;  // by doors of this thread, during the present turn
    std::vector<Result> results_;
    std::vector<Command> turn_commands_;  // the two above while they are processed; kept to reuse their memory
    std::vector<Result> turn_results_;
    std::vector<HotDoor*> doors_;  // by number - 1; nullptr: detached
    EventOutlet events_;
    mutable std::mutex reports_mutex_;  ///< held only while a pointer is copied; the hot thread never waits for it
    std::shared_ptr<const Reports> reports_ = std::make_shared<const Reports>();
    Instant next_reports_{};
    std::atomic<bool> stopping_{false};
    bool finished_ = false;
    bool settled_ = false;
    int turns_unannounced_ = 0;
    std::atomic<bool> change_wanted_{false};
    std::uint64_t changes_published_ = 0;
    std::thread thread_;
};

}  // namespace axisgate
