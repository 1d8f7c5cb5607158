// The hot thread and the owners of the service's ports when the rings between the threads are full, a thread is blocked, the clock jumps or
// the disk fails. Every request is answered exactly once, and losses are counted and reported. The test's clock and file layer are its own;
// it never waits for time to pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <map>
#include <mutex>
#include <thread>

#include "gateway/doors/http/words.hpp"
#include "gateway/runtime/warm_ports.hpp"
#include "tests/unit/store/fault_vfs.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;
constexpr std::size_t command_places = 1024, job_places = 256, service_places = 1024;

std::atomic<std::int64_t> test_time{0};
Instant test_clock() noexcept { return at_ns(test_time.load()); }

HotSettings with_test_clock() {
    HotSettings s;
    s.clock = test_clock;
    return s;
}

template <class Condition>
bool until(Condition condition) {
    for (const auto end = std::chrono::steady_clock::now() + 20s; std::chrono::steady_clock::now() < end; std::this_thread::yield()) {
        if (condition()) return true;
    }
    return false;
}

/// A hot thread that does not run unless a test starts it, a storage thread likewise, and the gateway between them.
struct RingBench {
    TempDir dir;
    FaultVfs vfs;
    std::unique_ptr<Store> store;
    std::mutex mutex;
    std::vector<Stored> stored;
    std::vector<Event> events;
    std::vector<std::string> faults;
    std::unique_ptr<Cold> cold;
    std::unique_ptr<Hot> hot = std::make_unique<Hot>(Families{}, with_test_clock());
    boost::asio::io_context warm;
    std::unique_ptr<WarmPorts> ports;

    RingBench() {
        test_time = ns_of(monotonic_now()) + 3'600'000'000'000;  // no timer of the real clock expires meanwhile
        StoreOptions options = options_for(dir.path());
        options.vfs = vfs.name();
        store = open_store(options);
        Cold::Answers answers;
        answers.stored = [this](std::vector<Stored> list) {
            const std::lock_guard hold(mutex);
            stored.insert(stored.end(), list.begin(), list.end());
        };
        answers.events = [this](std::vector<Event> list) {
            const std::lock_guard hold(mutex);
            events.insert(events.end(), list.begin(), list.end());
        };
        answers.fault = [this](std::string text) {
            const std::lock_guard hold(mutex);
            faults.push_back(std::move(text));
        };
        cold = std::make_unique<Cold>(*store, std::move(answers));
        ports = std::make_unique<WarmPorts>(warm, *hot, *cold, Families{}, must(StoreReader::open(options)));
        hot->connect(ports->outlets());
    }
    ~RingBench() {
        hot->stop();
        cold->stop();
    }
    template <class Get>
    auto locked(Get get) {
        const std::lock_guard hold(mutex);
        return get();
    }
    void run_warm() {
        warm.restart();
        warm.poll();
    }
    void fill_jobs() {
        for (std::size_t i = 0; i < job_places; ++i)
            ASSERT_TRUE(hot->jobs().push([](Engine&, Instant) {}));
    }
    /// Carries out the jobs of the hot thread.
    void empty_jobs() { hot->jobs().empty(); }
};

Event numbered(std::int32_t code, Severity severity = Severity::info) {
    Event e;
    e.kind = "command";
    e.code = code;
    e.severity = severity;
    return e;
}

TEST(FullRings, EventsThatFindNoPlaceAreCountedAndToldOnce) {
    boost::asio::io_context disk;
    Doorbell bell(disk);
    std::vector<Event> taken;
    Mailbox<ColdJob> ring(3, bell, [&](ColdJob&& job) { taken.push_back(std::get<EventAt>(std::move(job)).event); });
    Hot hot(Families{}, with_test_clock());
    hot.connect({nullptr, nullptr, &ring});
    for (int i = 1; i <= 3; ++i)
        hot.on_event(numbered(i), time_zero);
    EXPECT_EQ(hot.lost_events(), 0u);
    for (int i = 4; i <= 8; ++i)
        hot.on_event(numbered(i), time_zero);
    EXPECT_EQ(hot.lost_events(), 5u);
    ring.empty();
    hot.on_event(numbered(9), time_zero);
    hot.on_event(numbered(10), time_zero);
    ring.empty();
    ASSERT_EQ(taken.size(), 6u);
    EXPECT_EQ(taken[2].code, 3);
    EXPECT_EQ(taken[3].kind, "gap");
    EXPECT_EQ(taken[3].text, "5 events could not be taken: more came than can be written");
    EXPECT_EQ(taken[4].code, 9);
    EXPECT_EQ(taken[5].code, 10) << "the gap is told once";
    EXPECT_EQ(hot.lost_events(), 5u);
}

TEST(FullRings, ALargeCommitsEventsLetOthersInBetween) {
    RingBench bench;
    struct : EventListener {
        std::vector<std::int32_t> codes;
        void on_event(const Event& e) override { codes.push_back(e.code); }
    } listener;
    bench.ports->events.listen(&listener);
    const auto commit = [&](std::int32_t from, std::int32_t to) {
        std::vector<Event> list;
        for (std::int32_t i = from; i < to; ++i)
            list.push_back(numbered(i));
        bench.ports->events.written(std::move(list));
    };
    std::vector<std::size_t> told;  // whenever another thread runs
    const std::function<void()> other = [&] {
        told.push_back(listener.codes.size());
        if (told.back() < 120) boost::asio::post(bench.warm, other);
    };
    commit(0, 100);
    commit(100, 120);
    boost::asio::post(bench.warm, other);
    bench.run_warm();
    ASSERT_EQ(listener.codes.size(), 120u);
    for (std::int32_t i = 0; i < 120; ++i)
        EXPECT_EQ(listener.codes[static_cast<std::size_t>(i)], i);
    ASSERT_FALSE(told.empty());
    for (std::size_t before = 0; const std::size_t n : told) {
        EXPECT_LE(n - before, 4u) << "in one go, after " << before;
        before = n;
    }

    commit(120, 200);
    bench.warm.restart();
    while (listener.codes.size() == 120)
        ASSERT_EQ(bench.warm.poll_one(), 1u);
    EXPECT_LT(listener.codes.size(), 200u);
    bench.ports->events.tell_all();
    EXPECT_EQ(listener.codes.size(), 200u) << "at the end nothing is left out";
    bench.run_warm();
    EXPECT_EQ(listener.codes.size(), 200u);

    commit(200, 20'200);
    bench.warm.restart();
    int turns = 0;
    while (bench.warm.poll_one() == 1)
        ++turns;
    EXPECT_EQ(listener.codes.size(), 20'200u);
    EXPECT_LT(turns, 500) << "the more wait, the more are told in one go";
    bench.ports->events.unlisten(&listener);
}

TEST(FullRings, AGapThatCannotBeToldYetIsToldLaterWithAllThatIsMissing) {
    boost::asio::io_context disk;
    Doorbell bell(disk);
    std::vector<Event> taken;
    Mailbox<ColdJob> ring(1, bell, [&](ColdJob&& job) { taken.push_back(std::get<EventAt>(std::move(job)).event); });
    Hot hot(Families{}, with_test_clock());
    hot.connect({nullptr, nullptr, &ring});
    for (int i = 1; i <= 3; ++i)
        hot.on_event(numbered(i), time_zero);  // the first one has the place
    ring.empty();
    hot.on_event(numbered(4), time_zero);  // the gap takes the place of its own event
    ring.empty();
    hot.on_event(numbered(5), time_zero);
    ring.empty();
    ASSERT_EQ(taken.size(), 3u);
    EXPECT_NE(taken[1].text.find("2 events"), std::string::npos) << taken[1].text;
    EXPECT_NE(taken[2].text.find("1 events"), std::string::npos) << taken[2].text;
}

TEST(FullRings, NotesOfTheServiceGoStraightToTheDiskAndAreCountedWhenTheyFindNoPlace) {
    RingBench b;
    b.fill_jobs();  // the hot thread accepts nothing more, so it is not on its way
    for (std::int32_t i = 1; i <= static_cast<std::int32_t>(service_places) + 2; ++i)
        b.ports->events.note(numbered(i));
    EXPECT_EQ(b.ports->events.lost(), 2u);
    EXPECT_EQ(b.hot->lost_events(), 0u);
    b.cold->from_service().empty();
    b.ports->events.note(numbered(-1));
    b.cold->start();
    ASSERT_TRUE(until([&] { return b.locked([&] { return b.events.size() == service_places + 2u; }); }));
    EXPECT_EQ(b.events[service_places].kind, "gap");
    EXPECT_NE(b.events[service_places].text.find("2 events"), std::string::npos);
    EXPECT_EQ(b.events[service_places + 1u].code, -1);
}

TEST(AuditEvents, OfSitesAndLocksGoStraightToTheStorageAndNotByTheHotThread) {
    RingBench b;
    std::vector<std::string> by_hot;
    boost::asio::io_context other;
    Doorbell bell(other);
    Mailbox<ColdJob> ring(64, bell, [&](ColdJob&& job) {
        if (const auto* e = std::get_if<EventAt>(&job)) by_hot.push_back(e->event.kind);
    });
    auto outlets = b.ports->outlets();
    outlets.cold = &ring;
    b.hot->connect(outlets);
    bool locked = false;
    b.ports->modbus.use({[] { return ModbusReport{}; }, [&](bool on) { locked = on; }});
    b.cold->start();
    b.hot->start();
    const Origin anna{http::clients, std::make_shared<const std::string>("anna"), {}};
    int answers = 0;
    b.ports->site.apply_site(Site{}, 0, anna, [&](const SiteAnswer& a) { answers += a.good ? 1 : 100; });
    b.ports->modbus.set_modbus_read_only(true, anna, [&](const std::string& fault, bool) { answers += fault.empty() ? 1 : 100; });
    ASSERT_TRUE(until([&] {
        b.run_warm();
        return answers >= 2 && b.locked([&] { return b.events.size() >= 2; });
    }));
    EXPECT_EQ(answers, 2);
    b.hot->stop();
    EXPECT_TRUE(locked);
    ring.empty();
    EXPECT_EQ(std::ranges::count(by_hot, "site") + std::ranges::count(by_hot, "modbus"), 0);
    for (const auto* kind : {"site", "modbus"}) {
        const auto it = std::ranges::find(b.events, kind, &Event::kind);
        ASSERT_NE(it, b.events.end()) << kind;
        EXPECT_EQ(it->who, "anna");
        EXPECT_EQ(it->door, "http");
    }
}

TEST(FullRings, WhoeverAsksIsAnsweredOnceAlthoughNothingCanBeTaken) {
    RingBench b;
    b.ports->modbus.use({[] { return ModbusReport{}; }, [](bool) {}});
    registers::RegisterImage image(*b.hot, {});
    b.ports->registers.use(image);
    b.fill_jobs();
    std::map<std::string, int> answered;
    std::map<std::string, std::string> reported;
    const auto published = [&](const std::string& who, std::string text) {
        ++answered[who];
        reported[who] = std::move(text);
    };
    b.ports->drives.hand(DriveId{0}, [&](auto items) { published("hand", items ? "items" : "none"); });
    b.ports->drives.set_hand(DriveId{0}, {}, {}, [&](std::string fault) { published("set_hand", fault); });
    b.ports->lines.start_scan(LineId{0}, {}, {}, [&](std::string fault) { published("start_scan", fault); });
    b.ports->lines.cancel_scan(
        LineId{0}, [&](const ScanReport& r) { published("cancel_scan", r.state == ScanReport::State::failed ? r.text : "not failed"); });
    b.ports->lines.scan_report(
        LineId{0}, [&](const ScanReport& r) { published("scan_report", r.state == ScanReport::State::failed ? r.text : "not failed"); });
    b.ports->modbus.modbus_report([&](auto report) { published("modbus_report", report ? "report" : "none"); });
    b.ports->registers.read_registers(1, registers::Table::holding_registers, 0, 1,
                                      [&](auto read) { published("read_registers", read ? "answer" : "none"); });
    b.ports->events.events_settled([&] { published("events_settled", ""); });
    b.run_warm();
    b.empty_jobs();
    b.run_warm();
    const std::string later = "too much is asked at once; come again in a moment";
    const std::map<std::string, std::string> expected{{"hand", "none"},           {"set_hand", later},    {"start_scan", later},
                                                      {"cancel_scan", later},     {"scan_report", later}, {"modbus_report", "none"},
                                                      {"read_registers", "none"}, {"events_settled", ""}};
    EXPECT_EQ(reported, expected);
    for (const auto& [who, times] : answered)
        EXPECT_EQ(times, 1) << who;
}

TEST(FullRings, CommandsToAThreadThatIsHeldUpAreAnsweredExactlyOnceEach) {
    RingBench b;
    b.hot->start();
    std::promise<void> held, go;
    ASSERT_TRUE(b.hot->jobs().push([&](Engine&, Instant) {
        held.set_value();
        go.get_future().wait();
    }));
    b.hot->jobs().announce();
    ASSERT_EQ(held.get_future().wait_for(20s), std::future_status::ready);
    std::map<Ticket, std::vector<Reason>> answers;
    constexpr std::size_t asked = command_places + 476;
    for (std::size_t i = 0; i < asked; ++i) {
        Command c;
        c.axis = AxisId{7};  // of no site
        c.body = Halt{};
        const Ticket t = b.ports->axes.submit(std::move(c), [&](const Result& r) { answers[r.ticket].push_back(r.reason); });
        EXPECT_TRUE(answers.emplace(t, std::vector<Reason>{}).second) << "a ticket is given out once";
    }
    b.run_warm();
    const auto with = [&](auto holds) {
        return static_cast<std::size_t>(std::count_if(answers.begin(), answers.end(), [&](const auto& a) { return holds(a.second); }));
    };
    EXPECT_EQ(with([](const auto& list) { return list == std::vector{Reason::busy}; }), asked - command_places)
        << "who finds no place is told at once";
    EXPECT_EQ(with([](const auto& list) { return list.empty(); }), command_places);
    go.set_value();
    EXPECT_TRUE(until([&] {
        b.run_warm();
        return with([](const auto& list) { return list.empty(); }) == 0;
    }));
    for (const auto& [ticket, list] : answers)
        EXPECT_EQ(list.size(), 1u) << ticket;
    EXPECT_EQ(b.hot->commands().full(), 0u) << "the gateway takes no more than the ring holds";
    bool again = false;
    b.ports->axes.submit(Command{}, [&](const Result& r) { again = r.reason != Reason::busy; });
    EXPECT_TRUE(until([&] {
        b.run_warm();
        return again;
    })) << "and places are free again";
}

TEST(HotClock, AJumpOfAnHourCostsSomeTurnsAndNotOnePerPeriod) {
    RingBench b;
    b.hot->start();
    ASSERT_TRUE(until([&] { return b.hot->turns().counted() > 0; }));
    const auto before = b.hot->reports();
    const auto turns = b.hot->turns().counted();
    test_time += 3'600'000'000'000;
    std::promise<Instant> at;
    ASSERT_TRUE(b.hot->jobs().push([&](Engine&, Instant now) { at.set_value(now); }));
    b.hot->jobs().announce();
    EXPECT_EQ(at.get_future().get(), test_clock()) << "a job hears the time as it is now";
    ASSERT_TRUE(until([&] { return b.hot->turns().last() == test_clock() && b.hot->reports() != before; })) << "reports are made anew";
    EXPECT_LT(b.hot->turns().counted() - turns, 100u) << "36,000 periods were left out";
}

TEST(ColdDisk, AnOrderThatCannotBeSyncedIsReportedAndHealsWithTheDisk) {
    RingBench b;
    b.cold->start();
    const auto order = [&](Ticket t) {
        StoreOrder o;
        o.ticket = t;
        o.axis_name = "x";
        o.parameter = "AC";
        o.value = std::int64_t{5};
        b.hot->on_store(std::move(o));
        b.cold->from_hot().announce();
    };
    order(1);
    ASSERT_TRUE(until([&] { return b.locked([&] { return b.stored.size() == 1; }); }));
    EXPECT_EQ(b.stored[0].fault, "");
    EXPECT_TRUE(b.ports->status.not_ready().empty());
    std::promise<void> set;
    b.cold->run([&](Store&) {
        b.vfs.fail(FaultVfs::sync | FaultVfs::write, SQLITE_IOERR_FSYNC, EIO);
        set.set_value();
    });
    set.get_future().wait();
    b.hot->on_event(numbered(1, Severity::warning), test_clock());
    order(2);
    ASSERT_TRUE(until([&] { return b.locked([&] { return b.stored.size() == 2 && b.events.size() == 1; }); }));
    EXPECT_EQ(b.stored[1].order, Ticket{2});
    EXPECT_NE(b.stored[1].fault, "") << "never as written";
    EXPECT_EQ(b.events[0].id, 0u) << "told, but not kept";
    EXPECT_FALSE(b.cold->healthy());
    ASSERT_EQ(b.ports->status.not_ready().size(), 1u);
    EXPECT_NE(b.ports->status.not_ready()[0].find("cannot be written"), std::string::npos);
    EXPECT_FALSE(b.locked([&] { return b.faults.empty(); })) << "and it is for the log";
    std::promise<void> healed;
    b.cold->run([&](Store&) {
        b.vfs.heal();
        healed.set_value();
    });
    healed.get_future().wait();
    order(3);
    ASSERT_TRUE(until([&] { return b.locked([&] { return b.stored.size() == 3; }); }));
    EXPECT_EQ(b.stored[2].fault, "");
    EXPECT_TRUE(b.cold->healthy());
}

}  // namespace
}  // namespace axisgate::test
