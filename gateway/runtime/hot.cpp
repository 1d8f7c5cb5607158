// One turn of the loop: all ready handlers are called, their effects are passed on, and the loop sleeps until the next deadline. The work
// between two readings of the clock is bounded.
#include "gateway/runtime/hot.hpp"

#include <fmt/core.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <future>
#include <utility>

#include "gateway/lines/make_line.hpp"
#include "gateway/runtime/threads.hpp"

namespace axisgate {
namespace {
constexpr std::size_t command_ring = 1024;
constexpr std::size_t job_ring = 256;
constexpr std::size_t stored_ring = 8192;
constexpr int handlers_per_turn = 128;
constexpr int turns_unannounced_limit = 8;
constexpr Duration reports_period = std::chrono::milliseconds(100), reports_again = std::chrono::milliseconds(1);
/// At standstill no client waits for periodic work: it is combined with work that is due slightly later, because a wake-up costs more than
/// the work.
constexpr Duration rest_gathers = std::chrono::milliseconds(5);
constexpr Duration stop_limit = std::chrono::milliseconds(1500);
}  // namespace

Hot::Hot(Families families, HotSettings settings)
    : settings_(settings),
      engine_(std::move(families), *this, image_, settings.trace_frames),
      commands_(command_ring, bell_, [this](Command&& c) { engine_.on_command(std::move(c), now()); }),
      set_points_(bell_, [this](const SetPoint& p) { engine_.on_set_point(p, now()); }),
      jobs_(job_ring, bell_, [this](Job&& j) { j(engine_, now()); }),
      stored_(stored_ring, bell_, [this](Stored&& s) { engine_.on_stored(s.order, s.fault, now()); }) {}

Hot::~Hot() { stop(); }

Instant Hot::now() const { return turns_.now(); }

int Hot::start() {
    turns_.live(now());
    std::promise<int> first;
    auto ranked = first.get_future();
    thread_ = std::thread([this, first = std::move(first)]() mutable {
        enter_thread("axisgate-hot", hot_stands_back);
        int rank = 0;
        if (settings_.spin_us == 0) rank = ranked_from_outside() ? 1 : go_first(hot_rank) ? hot_rank : go_first() ? 1 : 0;
        if (rank == 0) take_short_turns(hot_turn_ns);
        if (settings_.cpu >= 0) {
            cpu_set_t set;
            CPU_ZERO(&set);
            CPU_SET(static_cast<unsigned>(settings_.cpu), &set);
            (void)pthread_setaffinity_np(pthread_self(), sizeof set, &set);  // optional: if the processor is not available, the thread runs
                                                                             // on any
        }
        first.set_value(rank);
        run();
    });
    return ranked.get();
}

void Hot::stop() {
    if (!thread_.joinable()) return;
    stopping_.store(true);
    boost::asio::post(io_, [] {});
    thread_.join();
}

void Hot::run() {
    const auto spin = std::chrono::microseconds(settings_.spin_us);
    Instant stop_by = never;
    bool stopping = false, all_done = false;
    turns_.begin(now());
    while (!finished_) {
        end_turn();
        turns_.end(now());
        // If no handler was ready before the end of this turn, and nothing must be announced, later arrivals are found by the sleep.
        std::size_t ran = all_done && !out_.unannounced() ? 0 : io_.poll_one();
        // The other threads are woken after this one has sent everything: otherwise a system call, and on a busy processor the work of
        // those threads, would come between a command and its frame.
        if (ran == 0 || ++turns_unannounced_ >= turns_unannounced_limit) announce();
        if (ran == 0 && settings_.spin_us > 0) {
            const Instant until = now() + spin;
            // A door's own poll is the shortest way to its clients; the whole loop is polled every fourth time.
            for (unsigned i = 0; ran == 0; ++i) {
                const Instant t = now();
                if (t >= until || t >= turns_.armed()) break;
                turns_.begin(t);
                ran = serve_doors() ? 1 : (i % 4 == 3 || doors_.empty()) ? io_.poll_one() : 0;
            }
        }
        if (ran == 0) turns_.sleep();
        all_done = false;
        for (int n = 0; n < handlers_per_turn && !all_done; ++n)
            all_done = io_.poll_one() == 0;
        if (stopping_.load(std::memory_order_relaxed)) {
            if (!stopping) {
                stopping = true;
                stop_by = now() + stop_limit;
                engine_.shut_down(now());
            }
            bool moving = false;
            for (std::size_t i = 0; i < image_.size(); ++i)
                moving = moving || (image_.picture(AxisId{static_cast<std::uint16_t>(i)}).flags & flag_moving);
            turns_.arm(now() + std::chrono::milliseconds(5));
            finished_ = !moving || now() >= stop_by;
        }
    }
    end_turn();
    announce();
}

void Hot::announce() {
    turns_unannounced_ = 0;
    if (out_.results) out_.results->announce();
    if (out_.samples) out_.samples->announce();
    if (out_.cold) out_.cold->announce();
    if (out_.changed && image_.changes() != changes_published_ && change_wanted_.exchange(false, std::memory_order_acq_rel)) {
        changes_published_ = image_.changes();
        out_.changed();
    }
}

void Hot::end_turn() {
    Instant t = now();
    for (int round = 0; round < 8; ++round) {  // commands that doors submit because of a result belong to the same turn, up to a bound
        if (engine_.deadline() <= t) engine_.on_deadline(t);
        turn_commands_.clear();
        turn_commands_.swap(submitted_);
        for (auto& c : turn_commands_)
            engine_.on_command(std::move(c), t);
        turn_results_.clear();
        turn_results_.swap(results_);
        for (auto& r : turn_results_) {
            const DoorNumber number = door_of(r.ticket);
            if (number > 0 && number <= doors_.size()) {
                if (HotDoor* door = doors_[number - 1u]) door->on_result(r);
            } else if (number >= first_service_door && number != engine_itself && out_.results) {
                (void)out_.results->push(std::move(r));  // never full: it has as many places as tickets that can be outstanding
            }
        }
        if (submitted_.empty() && results_.empty()) break;
    }
    if (!settled_ && engine_.settled()) {  // reported at once, because `ready` waits for it
        settled_ = true;
        next_reports_ = t;
    }
    if (t >= next_reports_) publish_reports(t);
    turns_.count(t);
    Instant next = std::min(engine_.wake_at(), next_reports_);
    if (engine_.at_rest(t)) next = std::max(next, t + rest_gathers);
    turns_.arm(submitted_.empty() && results_.empty() ? next : t);
}

void Hot::submit(Command command) { submitted_.push_back(std::move(command)); }

void Hot::note(Event&& event, AxisId axis) {
    const SiteState& site = *engine_.site();
    if (const auto it = std::ranges::find(site.axis_ids, axis); axis != no_axis && it != site.axis_ids.end()) {
        event.axis = site.site.axes[static_cast<std::size_t>(it - site.axis_ids.begin())].name;
    }
    on_event(std::move(event), now());
}

void Hot::on_event(Event event, Instant at) { events_.send(std::move(event), at); }

DoorNumber Hot::attach(HotDoor& door) {
    doors_.push_back(&door);  // a number is not used again, so late results of a detached door find no door
    return static_cast<DoorNumber>(doors_.size());
}

std::vector<HotDoor*> Hot::doors() const {
    std::vector<HotDoor*> list;
    for (HotDoor* door : doors_) {
        if (door) list.push_back(door);
    }
    return list;
}

bool Hot::serve_doors() {
    bool served = false;
    for (HotDoor* door : doors_)
        served = (door && door->serve_now()) || served;
    return served;
}

void Hot::publish_site(const SiteState& site) {
    for (HotDoor* door : doors_) {
        if (door) door->on_site(site);
    }
}

std::optional<Instant> Hot::last_received(const AuthorityClient& who) const {
    std::optional<Instant> newest;
    for (const HotDoor* door : doors_) {
        const auto at = door ? door->last_received(who) : std::nullopt;
        if (at && (!newest || *at > *newest)) newest = at;
    }
    return newest;
}

void Hot::on_sample(const Sample& sample) {
    for (HotDoor* door : doors_) {
        if (door) door->on_sample(sample);
    }
    if (out_.samples) (void)out_.samples->push(Sample(sample));  // a state: the next report replaces one that was lost
}

void Hot::on_store(StoreOrder order) {
    const Ticket ticket = order.ticket;
    if (!out_.cold || !out_.cold->push(std::move(order))) {
        // Reported in the next turn, not within a call of the engine.
        boost::asio::post(
            io_, [this, ticket] { engine_.on_stored(ticket, "the database cannot keep up: too many writes wait for the disk", now()); });
    }
}

void Hot::on_twin_memory(const std::string& drive, NonVolatile memory) {
    if (out_.cold) (void)out_.cold->push(TwinMemory{drive, std::move(memory)});  // the next change contains the whole memory again
}

std::unique_ptr<Line> Hot::make_line(const LineSpec& spec, const LineSetup& setup) {
    const Family* family = find_family(spec.family);  // none: a CAN line with several families
    return make_real_line(spec.uri, setup, io_, family ? family->default_format : "8N1", settings_.ptys, stale_send_limit, settings_.fleet,
                          line_clock_);
}

void Hot::publish_reports(Instant now) {
    next_reports_ = now + reports_period;
    auto r = std::make_shared<Reports>();
    const auto& site = *engine_.site();
    const auto room = [](auto& list, std::size_t index) {
        if (list.size() <= index) list.resize(index + 1);
    };
    for (const LineId id : site.line_ids) {
        room(r->lines, index_of(id));
        room(r->logs, index_of(id));
        r->lines[index_of(id)] = engine_.line_report(id, now);
        r->logs[index_of(id)] = engine_.frame_log(id);
    }
    for (const DriveId id : site.drive_ids) {
        room(r->drives, index_of(id));
        r->drives[index_of(id)] = engine_.drive_status(id);
    }
    r->complaints = engine_.complaints();
    r->settled = engine_.settled();
    for (const LossCause cause : loss_causes())
        r->losses[static_cast<std::size_t>(cause)] = engine_.losses(cause);
    std::shared_ptr<const Reports> made = std::move(r);
    if (const std::unique_lock hold(reports_mutex_, std::try_to_lock); hold) {
        reports_.swap(made);
    } else {
        next_reports_ = now + reports_again;  // they are being read at present
    }
}

}  // namespace axisgate
