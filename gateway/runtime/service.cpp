// The command `axisgate serve`: creates store, threads and doors, reports `ready`, and closes everything in reverse order. A door is opened
// only after the parts that it uses exist.
#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <future>
#include <map>
#include <thread>

#include "gateway/core/assets.hpp"
#include "gateway/runtime/access_service.hpp"
#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/config_host.hpp"
#include "gateway/runtime/descriptor_limits.hpp"
#include "gateway/runtime/doors.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/runtime/log.hpp"
#include "gateway/runtime/open_doors.hpp"
#include "gateway/runtime/restore_note.hpp"
#include "gateway/runtime/service_rank.hpp"
#include "gateway/runtime/site_file.hpp"
#include "gateway/runtime/site_names.hpp"
#include "gateway/runtime/site_trial.hpp"
#include "gateway/runtime/systemd.hpp"
#include "gateway/runtime/threads.hpp"
#include "gateway/runtime/waiting_backup.hpp"
#include "gateway/runtime/warm_ports.hpp"
#include "gateway/services/services.hpp"
#include "gateway/site/names.hpp"

namespace axisgate {
namespace {
/// The longest wait for lines and drives before `ready` is reported; missing ones are named in the report.
constexpr auto ready_limit = std::chrono::seconds(5);

/// All members live while the service runs, and are destroyed from the last to the first.
struct Service {
    const ServeOptions& options;
    Families families;
    registers::Languages languages{};
    std::unique_ptr<Store> store;
    boost::asio::io_context warm{1};
    std::unique_ptr<Hot> hot;
    std::unique_ptr<Cold> cold;
    std::unique_ptr<WarmPorts> ports;
    std::optional<Doorbell::Call> picture_changed;  // for the door that has requested it
    std::unique_ptr<registers::RegisterImage> image;
    std::shared_ptr<AccessService> access;
    std::unique_ptr<Services> services;
    std::unique_ptr<OpenDoors> doors;
    boost::asio::steady_timer services_timer{warm};
    LogListener log;
    boost::asio::signal_set signals{warm};
    boost::asio::steady_timer tick{warm};
    Instant started = monotonic_now();
    bool ready_reported = false;  ///< on standard output
    bool manager_ready = false;   ///< the manager has READY=1
    Instant watchdog_at{};        ///< of the next WATCHDOG=1
    std::string manager_status;   ///< as last reported
    std::string first_code;       ///< to be printed
    int code = exit_good;
    bool door_hangs = false;  ///< a thread of a door's library does not end (DDS with an interface that is down)

    explicit Service(const ServeOptions& o) : options(o) {}

    void make_hot();
    int open_store();
    int load_site(Site& site, std::uint64_t& revision);
    int open_access();
    void show_code();
    void begin_services();
    void arm_services();
    int open_doors();
    void watch();
    [[nodiscard]] bool tell_manager();
    void report_ready();
    void take_down();
};

void Service::make_hot() {
    HotSettings hs;
    hs.spin_us = options.config.spin_us;
    hs.cpu = static_cast<int>(options.config.hot_cpu);
    hs.trace_frames = static_cast<std::size_t>(options.config.trace_frames);
    hs.ptys = {options.config.lines_pty_dir, options.config.data_dir};
    const auto carries_mirrors = [this](const DoorDescriptor* door) { return door->carries_mirrors && door->wanted(options.config); };
    if (std::ranges::any_of(all_doors(), carries_mirrors)) {
        hs.fleet = [this](int fd) {
            boost::asio::post(warm, [this, fd] {
                if (doors) return doors->take_mirror(fd);
                ::close(fd);
            });
        };
    }
    hot = std::make_unique<Hot>(families, hs);
    hot->engine().set_watchdog(std::chrono::milliseconds(options.config.watchdog_ms));
    hot->engine().set_lease(std::chrono::seconds(options.config.authority_lease_s));
    registers::RegisterImage::Settings rs;
    rs.word_order = options.config.low_word_first ? MapWordOrder::low_first : MapWordOrder::high_first;
    rs.gaps = options.config.map_gaps;
    rs.languages = languages;
    image = std::make_unique<registers::RegisterImage>(*hot, rs);
}

int Service::open_store() {
    StoreOptions so;
    so.directory = options.config.data_dir;
    const auto migrations = migrations_among(all_assets());
    if (!migrations) {
        complain(migrations.error().text);
        return exit_failed;
    }
    so.migrations = *migrations;
    so.between = []() noexcept { give_way_after(cold_piece_ns); };
    if (const std::string fault = take_waiting_backup(so); !fault.empty()) {
        complain(fault);
        return exit_failed;
    }
    auto opened = Store::open(so);
    if (!opened) {
        complain(opened.error().text);
        return exit_failed;
    }
    store = std::move(*opened);
    remove_backup_leftovers(so.directory);
    if (const std::string fault = end_trial(*store, options.site_file.empty()); !fault.empty()) {
        complain(fault);
        return exit_failed;
    }
    auto reader = StoreReader::open(so);
    if (!reader) {
        complain(reader.error().text);
        return exit_failed;
    }
    families.descriptions = std::make_shared<DescriptionShelf>();
    std::string unread;
    fill_shelf(**reader, *families.descriptions, unread);
    if (!unread.empty()) {
        complain(unread);
        return exit_failed;
    }
    make_hot();
    Cold::Answers answers;
    answers.stored = [this](std::vector<Stored> list) {
        for (auto& s : list) {
            // The hot thread empties this ring in every turn; it has more places than orders can be outstanding.
            while (!hot->stored().push(std::move(s)))
                std::this_thread::yield();
        }
        hot->stored().announce();
    };
    answers.events = [this](std::vector<Event> list) { ports->events.written(std::move(list)); };
    answers.fault = [](std::string text) { spdlog::error("store: {}", text); };
    cold = std::make_unique<Cold>(*store, std::move(answers));
    ports = std::make_unique<WarmPorts>(warm, *hot, *cold, families, std::move(*reader));
    ports->registers.use(*image);
    ports->rehearsal.set_times(std::chrono::milliseconds(options.config.watchdog_ms),
                               std::chrono::seconds(options.config.authority_lease_s));
    ports->events.listen(&log);
    if (auto restored = take_restore_note(options.config.data_dir)) ports->events.note(std::move(*restored));
    ports->backup.use(backup_plan(options.config, options.config_file));
    ports->recorder.begin(recorder_settings(options.config));
    ports->captures.begin(recorder_settings(options.config));
    auto outlets = ports->outlets();
    picture_changed.emplace(ports->bell(), [this] {
        if (doors) doors->on_change();
    });
    outlets.changed = [this] { picture_changed->ring(); };
    hot->connect(std::move(outlets));
    return exit_good;
}

int Service::load_site(Site& site, std::uint64_t& revision) {
    if (!options.site_file.empty()) {
        auto read = read_site_file(options.site_file, families);
        for (const auto& f : read.faults)
            complain(f);
        if (!read.site) return exit_usage;
        for (const auto& d : read.descriptions) {
            if (const auto saved = store->save_description({d.name, d.text, d.who, d.at_unix_ns}); !saved) {
                complain(saved.error().text);
                return exit_failed;
            }
        }
        site = std::move(*read.site);
        for (const auto& f : names_to_change(site, nullptr))
            spdlog::warn("{}, {}: {}; {}", options.site_file, f.pointer, f.text, f.remedy);
        boost::system::error_code ec;
        boost::json::value before;
        if (const auto was = store->load_site(); was && *was) before = boost::json::parse((*was)->text, ec);
        const SiteChange change = names_between(before, to_json(site));
        const auto saved = store->save_site(boost::json::serialize(to_json(site)), "--site " + options.site_file, unix_now_ns(), change);
        if (!saved) {
            complain(saved.error().text);
            return exit_failed;
        }
        revision = *saved;
        return exit_good;
    }
    const auto stored = store->load_site();
    if (!stored) {
        complain(stored.error().text);
        return exit_failed;
    }
    if (!*stored) return exit_good;  // an empty site: it is set up with the page or the API
    revision = (*stored)->revision;
    std::vector<SiteFault> faults;
    boost::system::error_code ec;
    const auto document = boost::json::parse((*stored)->text, ec);
    auto parsed = ec ? std::nullopt : parse_site(document, families, faults);
    if (!parsed) {
        for (const auto& f : faults)
            complain(fmt::format("stored site, {}: {}; {}", f.pointer, f.text, f.remedy));
        complain("the stored site does not fit this program; start with --site FILE.json to replace it");
        return exit_failed;
    }
    site = std::move(*parsed);
    for (const auto& f : names_to_change(site, nullptr))
        spdlog::warn("site, {}: {}; {}", f.pointer, f.text, f.remedy);
    // The same text makes no new revision, but stores the family of each axis, which older versions of the program did not store.
    const auto named = store->save_site((*stored)->text, (*stored)->who, (*stored)->at_unix_ns, names_of(site));
    if (!named) spdlog::warn("store: {}", named.error().text);
    return exit_good;
}

/// Users, tokens and the first sign-in. The code is printed on standard output only.
int Service::open_access() {
    constexpr std::int64_t minute_ns = std::int64_t{60} * 1'000'000'000;
    AccessSettings as;
    as.cookie = session_cookie_of(options.config.data_dir);
    as.local_role = role_named(options.config.users_local_role).value_or(Role::none);
    as.idle_ns = options.config.users_session_idle_min * minute_ns;
    as.max_ns = options.config.users_session_max_h * 60 * minute_ns;
    access = std::make_shared<AccessService>(warm, *cold, as, [this](Event e) { ports->events.note(std::move(e)); });
    if (const std::string fault = access->load(*store, options.config.users_new_code, first_code); !fault.empty()) {
        complain(fault);
        return exit_failed;
    }
    return exit_good;
}

/// Called when every door could be opened, and before one answers: a start that fails prints no code, and the code is printed before it can
/// be used.
void Service::show_code() {
    if (!access) return;
    if (!first_code.empty()) {
        fmt::print("first sign-in: code {} (on the page, or POST /api/v1/session/first; shown this once)\n", first_code);
    } else if (!access->accounts().has_users()) {
        fmt::print("first sign-in: with the code that was shown at the first start; --set users.new_code=true makes another one\n");
    }
    std::fflush(stdout);
}

/// Alarms are raised and stored, and recipes can run, independent of the doors.
void Service::begin_services() {
    services = std::make_unique<Services>(ports->all(), monotonic_now, access);
    services->rearm = [this] { arm_services(); };
    arm_services();
}

void Service::arm_services() {
    const Instant due = services->deadline();
    if (due == never) {
        services_timer.cancel();
        return;
    }
    services_timer.expires_at(
        std::chrono::steady_clock::time_point(std::chrono::duration_cast<std::chrono::steady_clock::duration>(due.time_since_epoch())));
    services_timer.async_wait([this](const boost::system::error_code& moved) {
        if (moved) return;
        services->on_deadline(monotonic_now());
        arm_services();
    });
}

int Service::open_doors() {
    doors = std::make_unique<OpenDoors>(warm, *hot, *ports);
    const DoorHouse house{options.config, families, languages, *hot,   *image,
                          warm,           *ports,   *services, *store, [this] { return doors->page(); }};
    return doors->open(house, all_doors());
}

void Service::report_ready() {
    const auto reports = hot->reports();
    if ((!reports->settled || !doors->waiting().empty()) && monotonic_now() - started < ready_limit) return;
    if (access && !access->code_is_kept()) return;  // it must be on the disk: after `ready` it is valid, also for the next start
    ready_reported = true;
    std::string text = "ready";
    for (const auto& d : ports->status.doors())
        text += fmt::format(" {}={}", d.name, d.address);
    text += fmt::format(" axes={}", ports->site.site()->site.axes.size());
    for (const auto& c : reports->complaints)
        text += "; " + c;
    for (const auto& c : doors->waiting())
        text += "; " + c;
    fmt::print("{}\n", text);
    std::fflush(stdout);
    spdlog::info("{}", text);
}

/// Periodic work of the warm thread: reports `ready` when all parts are running, and triggers the watchdog as long as the hot loop runs.
void Service::watch() {
    if (!ready_reported) report_ready();
    const auto interval = watchdog_interval();
    if (ready_reported && !manager_ready) manager_ready = notify_manager("READY=1");
    bool delivered = manager_ready && tell_manager();
    const Instant now = monotonic_now();
    if (interval && now >= watchdog_at && now - hot->turns().last() < std::chrono::seconds(1)) {
        if (notify_manager("WATCHDOG=1"))
            watchdog_at = now + *interval - std::chrono::milliseconds(1);
        else
            delivered = false;
    }
    auto next = std::chrono::milliseconds(!ready_reported ? 2 : delivered ? 500 : 20);
    if (interval) next = std::min(next, std::chrono::duration_cast<std::chrono::milliseconds>(*interval));
    tick.expires_after(next);
    tick.async_wait([this](const boost::system::error_code& ec) {
        if (!ec) watch();
    });
}

/// The text of `systemctl status`, and the conditions for which an upgrade waits.
bool Service::tell_manager() {
    std::size_t online = 0, moving = 0;
    const auto site = ports->site.site();
    for (const AxisId id : site->axis_ids) {
        const AxisPicture p = hot->image().cell(id).read();
        online += (p.flags & flag_online) != 0;
        moving += (p.flags & flag_moving) != 0;
    }
    std::string status = fmt::format("STATUS={} axes, {} online, {} moving", site->axis_ids.size(), online, moving);
    if (status == manager_status) return true;
    if (!notify_manager(status)) return false;
    manager_status = std::move(status);
    return true;
}

void Service::take_down() {
    (void)notify_manager("STOPPING=1");
    doors->stop_waiting();
    hot->stop();  // stops moving axes first
    doors->stop();
    door_hangs = doors->hang();
    if (access) access->stop();
    cold->stop();
    ports->events.tell_all();
}
/// Like `context.run()`, with the priority that ServiceRank permits: a woken thread runs before others, but continuous work does not.
void run_ranked(boost::asio::io_context& context) {
    ServiceRank rank;
    bool first = false;
    while (!context.stopped()) {
        const bool worked = context.poll_one() > 0;
        if (context.stopped()) break;
        const bool may = (first || !worked) && rank.may_go_first(monotonic_now(), Duration(used_of_processor_ns()));
        if (first && !may) {
            go_with_others();
            take_short_turns(warm_turn_ns);
            first = false;
        } else if (!first && may) {
            first = go_first(warm_rank);
        }
        if (!worked) context.run_one();  // sleeps
    }
}
}  // namespace

/// `hangs` is set if a thread of a door's library is left that cannot be ended.
static int serve(const ServeOptions& given, bool& hangs) {
    ServeOptions options = given;
    // Same text and exit code as `axisgate check`.
    const auto wrong_here = check_host(options.config);
    for (const auto& f : wrong_here)
        complain(f);
    if (std::ranges::count(wrong_here, false, &ConfigFault::warning) > 0) return exit_usage;
    if (!open_log(options.config)) return exit_failed;
    // Before anything is opened: an invalid certificate is a fault of the configuration, as in `axisgate check`.
    if (const auto wrong = check_door_files(options.config, unix_now_ns() / 1'000'000'000); !wrong.empty()) {
        for (const auto& f : wrong)
            complain(fmt::format("{}: {}; {}", f.place, f.text, f.remedy));
        return exit_usage;
    }
    fit_doors(options.config);
    (void)std::signal(SIGPIPE, SIG_IGN);
    (void)std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is treated like a full disk and must not end the program
    std::vector<std::string> faults;
    Service s(options);
    s.families = load_families(faults);
    s.languages = load_languages(faults);
    for (const auto& f : faults)
        complain(f);
    if (!faults.empty()) return exit_failed;
    if (const int code = s.open_store(); code != exit_good) return code;
    Site site;
    std::uint64_t revision = 0;
    if (const int code = s.load_site(site, revision); code != exit_good) return code;
    auto memory = read_site_memory(*s.store, site);
    auto state = s.hot->engine().apply_site(std::move(site), std::move(memory), revision, monotonic_now());
    s.ports->site.set_site(state);
    const auto has_users_to_sign_in = [&](const DoorDescriptor* door) { return door->shows_page && door->wanted(options.config); };
    if (std::ranges::any_of(all_doors(), has_users_to_sign_in)) {
        if (const int code = s.open_access(); code != exit_good) return code;
    }
    s.begin_services();
    if (const int code = s.open_doors(); code != exit_good) return code;
    s.show_code();
    s.hot->publish_site(*state);

    s.signals.add(SIGINT);
    s.signals.add(SIGTERM);
    s.signals.async_wait([&s](const boost::system::error_code& ec, int) {
        if (!ec) s.warm.stop();
    });
    s.cold->start();
    const int rank_of_hot = s.hot->start();
    s.watch();
    // After the other threads have been started, because a new thread inherits the priority of its creator. If the hot thread has a higher
    // priority, this one need not lower its own.
    enter_thread("axisgate-warm", rank_of_hot > 0 ? 0 : warm_stands_back);
    take_short_turns(warm_turn_ns);
    // With a single processor the database would have to wait for it, too.
    if (rank_of_hot > warm_rank && !ranked_from_outside() && std::thread::hardware_concurrency() > 1)
        run_ranked(s.warm);
    else
        s.warm.run();
    s.warm.restart();
    s.take_down();
    hangs = s.door_hangs;
    spdlog::info("stopped");
    return s.code;
}

int command_serve(const ServeOptions& options) {
    bool hangs = false;
    const int code = serve(options, hangs);
    if (!hangs) return code;
    // All parts of this program are closed. A normal exit would wait for that thread.
    spdlog::default_logger()->flush();
    std::fflush(nullptr);
    std::_Exit(code);
}

}  // namespace axisgate
