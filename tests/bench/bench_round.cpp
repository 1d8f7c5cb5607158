// The round benchmark measures how much faster than real time engine, adapters and twins run in virtual time. For each point it prints the
// ratio, its limit and both figures; exit 1 if a limit is exceeded. Processor time is counted, and wall-clock time only where a ratio says
// so.
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gateway/doors/http/words.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "tests/bench/report.hpp"
#include "tests/world/world.hpp"

namespace axisgate::bench {
namespace {
using namespace std::chrono_literals;
using test::families;

double processor_seconds() {
    timespec t{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}
double wall_seconds() {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

/// Valid addresses of drives that share a line. A group address to which new drives listen is left out, because all the others would answer
/// for a drive there, on a real line as well.
std::vector<std::string> addresses_for(const FamilyEntry& e, std::size_t n) {
    auto list = test::addresses(e, n + 16);
    std::erase(list, "10");
    list.resize(std::min(list.size(), n));
    return list;
}

Site make_site(const FamilyEntry& e, std::string_view uri, std::size_t axes, std::size_t per_line, std::string_view presence,
               int poll_period_ms, bool limited = false) {
    namespace json = boost::json;
    json::array lines, drives, places;
    const auto addresses = addresses_for(e, per_line);
    for (std::size_t i = 0; i < axes; ++i) {
        const std::string line = "line" + std::to_string(i / addresses.size());
        if (i % addresses.size() == 0) {
            lines.push_back({{"name", line},
                             {"uri", uri},
                             {"family", e.family->name},
                             {"bitrate", 1'000'000},
                             {"timing", {{"poll_period_ms", poll_period_ms}}}});
        }
        const std::string name = "a" + std::to_string(i + 1);
        drives.push_back({{"name", name}, {"line", line}, {"address", addresses[i % addresses.size()]}, {"presence", presence}});
        places.push_back({{"name", name}, {"drive", name}, {"number", i + 1}, {"unit", "u"}, {"increments_per_unit", 100}});
        if (limited) {
            auto& axis = places.back().as_object();
            axis["position_min"] = -1'000'000;
            axis["position_max"] = 1'000'000;
            axis["velocity_max"] = 1'000;
        }
    }
    std::vector<SiteFault> faults;
    auto site = parse_site(json::object{{"lines", lines}, {"drives", drives}, {"axes", places}}, families(), faults);
    if (!site) std::abort();
    return std::move(*site);
}

/// The host of an engine, without storage.
struct Host final : EngineHost {
    std::uint64_t bad = 0, results = 0, events = 0, samples = 0;
    std::string first_bad;
    std::unique_ptr<Line> make_line(const LineSpec&, const LineSetup&) override { std::abort(); }  // twin lines alone
    void on_result(const Result& r) override {
        ++results;
        if (!good(r) && bad++ == 0) first_bad = r.text;
    }
    void on_event(Event, Instant) override { ++events; }
    void on_sample(const Sample&) override { ++samples; }
    void on_store(StoreOrder) override {}
    void on_twin_memory(const std::string&, NonVolatile) override {}
};

struct Plant {
    Host host;
    Image image;
    Engine engine{families(), host, image};
    Instant now = at_ns(1'000'000'000);
    std::shared_ptr<const SiteState> site;
    std::uint64_t turns = 0;
    std::uint64_t sequence = 0;

    Plant(const FamilyEntry& e, std::size_t axes, std::size_t per_line, int poll_period_ms, bool limited = false) {
        site = engine.apply_site(make_site(e, "twin", axes, per_line, "twin", poll_period_ms, limited), {}, 1, now);
    }
    void command(AxisId axis, CommandBody body) {
        Command c;
        c.ticket = make_ticket(first_service_door, ++sequence);
        c.axis = axis;
        c.body = std::move(body);
        c.origin.door = http::clients;
        engine.on_command(std::move(c), now);
    }
    /// As the hot thread does.
    void run_for(Duration d) {
        const Instant end = now + d;
        for (Instant due; (due = engine.wake_at()) <= end;) {
            now = std::max(now, due);
            engine.on_deadline(now);
            ++turns;
        }
        now = end;
    }
    std::uint64_t exchanges() {
        std::uint64_t n = 0;
        for (const auto id : site->line_ids)
            n += engine.line_report(id, now).counters.exchanges;
        return n;
    }
    std::size_t count(std::uint16_t flag) const {
        std::size_t n = 0;
        for (const auto id : site->axis_ids)
            n += (image.picture(id).flags & flag) != 0;
        return n;
    }
};

/// Axes that move, each polled a hundred times a second, in gateways of a thousand axes (their register map ends at 1,024), which run in
/// turn for a second each, because they are independent: all of them in the time of one processor.
bool run_polled(const FamilyEntry& e, std::size_t gateways) {
    constexpr std::size_t axes = 1000;
    constexpr double rate = 100;
    const auto all = static_cast<double>(gateways * axes);
    std::printf("%.0f moving axes of %s, polled at %.0f Hz, engine, adapters and twins\n", all, std::string(e.family->name).c_str(), rate);
    // The number of drives on a line that its bit rate can carry: 40 * 100 * (question + answer) fills 1 Mbit/s to about four fifths. A
    // moving drive is asked two questions in turn in each poll period, and each answer contains its position: 100 a second are a period of
    // 20 ms.
    std::vector<std::unique_ptr<Plant>> plants;
    for (std::size_t i = 0; i < gateways; ++i)
        plants.push_back(std::make_unique<Plant>(e, axes, 40, static_cast<int>(2000 / rate)));
    const auto run_for = [&](Duration d) {
        for (Duration t{}; t < d; t += 1s) {
            for (auto& p : plants)
                p->run_for(1s);
        }
    };
    const auto to_all = [&](auto body) {
        for (auto& p : plants) {
            for (std::size_t i = 0; i < p->site->axis_ids.size(); ++i)
                p->command(p->site->axis_ids[i], body(i));
        }
    };
    run_for(2s);
    to_all([](std::size_t) { return Enable{}; });
    run_for(1s);
    to_all([](std::size_t i) {
        Move m;
        m.kind = Move::Kind::velocity;
        m.target = (i % 2 ? 1 : -1) * static_cast<std::int64_t>(1000 + i);
        m.acceleration = 20000;
        m.deceleration = 20000;
        return m;
    });
    run_for(2s);
    std::vector<std::int64_t> before;
    std::uint64_t exchanges = 0, turns = 0;
    for (auto& p : plants) {
        for (const auto a : p->site->axis_ids)
            before.push_back(p->image.picture(a).position);
        exchanges -= p->exchanges();
        turns -= p->turns;
    }
    const double simulated = gateways > 1 ? 2 : 5;
    const double begun = processor_seconds();
    run_for(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(simulated)));
    const double used = processor_seconds() - begun;
    std::size_t moved = 0;
    std::uint64_t bad = 0;
    auto from = before.begin();
    for (auto& p : plants) {
        exchanges += p->exchanges();
        turns += p->turns;
        for (std::size_t i = 0; i < axes; ++i) {
            const double way = std::fabs(static_cast<double>(p->image.picture(p->site->axis_ids[i]).position - *from++));
            moved += std::fabs(way - static_cast<double>(1000 + i) * simulated) < static_cast<double>(1000 + i) * 0.05;
        }
        if (p->host.bad && bad == 0) std::printf("    commands went wrong; the first: %s\n", p->host.first_bad.c_str());
        bad += p->host.bad;
    }
    const double polls = static_cast<double>(exchanges), polled = polls / simulated / all;
    bool kept = say("simulated / processor time", simulated / used, ">=", 1.0, "simulated", simulated, "processor", used, "s");
    kept &= say("polled / wanted", polled / rate, ">=", 0.97, "polled", polled, "wanted", rate, "/s per axis");
    kept &= say("moving / all axes", static_cast<double>(moved) / all, ">=", 1.0, "where they should be", static_cast<double>(moved), "all",
                all, "axes");
    std::printf("    per poll: %.2f us of processor time, %.2f turns of the engine\n", used / polls * 1e6,
                static_cast<double>(turns) / polls);
    return kept && bad == 0;
}

/// Sixteen axes on a bad cable, commanded all the time.
bool run_world(const FamilyEntry& e, double simulated) {
    std::printf("the world of 16 axes of %s with faults\n", std::string(e.family->name).c_str());
    test::World w(7);
    std::mt19937_64 random(7);
    const auto site = w.apply(make_site(e, e.family->uses_can ? "can:sim" : "tcp:127.0.0.1:9", 16, 16, "device", 0));
    const auto list = addresses_for(e, site->drive_ids.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        w.plug_in("line0", site->drive_ids[i], e, list[i], e.family->uses_can ? LineKind::can : LineKind::bytes);
    }
    w.run_for(3s);
    const double begun = wall_seconds();
    const Instant start = w.now;
    std::uint64_t given = 0;
    const std::uint64_t steps = w.steps;
    while (seconds(w.now - start) < simulated) {
        // One fault and one command per second of the world, as on a machine with a bad cable.
        if (random() % 10 == 0) {
            FaultRates to, from;
            to.loss = static_cast<double>(random() % 100) / 1000.0;
            to.flip = static_cast<double>(random() % 20) / 1000.0;
            from.loss = to.loss;
            from.delay = static_cast<double>(random() % 100) / 1000.0;
            from.delay_max = std::chrono::milliseconds(1 + random() % 40);
            w.cables.at("line0")->set_rates(to, from);
        }
        if (random() % 60 == 0) w.cables.at("line0")->cut(w.now);
        if (w.cables.at("line0")->is_cut() && random() % 3 == 0) w.cables.at("line0")->heal(w.now);
        const AxisId axis = site->axis_ids[random() % site->axis_ids.size()];
        Move m;
        m.target = static_cast<std::int64_t>(random() % 20001) - 10000;
        m.velocity = 1 + static_cast<std::int64_t>(random() % 8000);
        m.acceleration = 20000;
        m.deceleration = 20000;
        switch (random() % 4) {
            case 0:
                (void)w.command(axis, Enable{}, true);
                break;
            case 1:
                (void)w.command(axis, random() % 4 == 0 ? CommandBody{QuickStop{}} : CommandBody{ResetFault{}});
                break;
            default:
                (void)w.command(axis, m, true);
        }
        ++given;
        w.run_for(1s);
        w.samples.clear();
    }
    const double passed = seconds(w.now - start);
    const double used = wall_seconds() - begun;
    std::size_t answered = 0;
    for (const auto& [t, r] : w.results)
        answered += r.size() == 1;
    const bool kept = say("simulated / real time", passed / used, ">=", 500, "simulated", passed, "real", used, "s");
    std::printf("    %llu commands, %zu answered by now, %zu events, %.0f turns of the engine per simulated second\n",
                static_cast<unsigned long long>(given), answered, w.events.size(), static_cast<double>(w.steps - steps) / passed);
    return kept;
}

/// A thousand twins that move without being asked.
bool run_unobserved(const FamilyEntry& e) {
    constexpr std::size_t twins = 1000;
    constexpr std::size_t per_bus = 100;
    std::printf("%zu moving twins of %s that nobody polls\n", twins, std::string(e.family->name).c_str());
    struct Quiet final : LineEvents {
        void on_frame(const Frame&) override {}
        void on_line_state(bool, const std::string&) override {}
        void on_sent(const Frame&) override {}
    } quiet;
    // The adapters set them in motion; then each twin is left alone on a bus of its own.
    Plant p(e, twins, per_bus, 1000);
    p.run_for(5s);
    for (const auto a : p.site->axis_ids)
        p.command(a, Enable{});
    p.run_for(3s);
    for (std::size_t i = 0; i < twins; ++i) {
        Move m;
        m.kind = i % 2 ? Move::Kind::velocity : Move::Kind::absolute;
        m.target = m.kind == Move::Kind::velocity ? static_cast<std::int64_t>(1000 + i) : 2'000'000'000;
        if (m.kind == Move::Kind::absolute) m.velocity = static_cast<std::int64_t>(1000 + i);
        m.acceleration = 20000;
        m.deceleration = 20000;
        p.command(p.site->axis_ids[i], m);
    }
    p.run_for(5s);
    std::vector<Twin*> all;
    for (const auto d : p.site->drive_ids)
        all.push_back(p.engine.twin(d));
    std::vector<double> before;
    for (auto* t : all)
        before.push_back(t->mechanics(1, p.now).position);
    // From here on nothing is asked: time passes, and only deadlines of the twins are met.
    constexpr double simulated = 3600;
    const Instant end = p.now + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(simulated));
    std::uint64_t wakes = 0;
    Out out;
    const double begun = processor_seconds();
    for (auto* t : all) {
        while (t->deadline() <= end) {
            t->on_deadline(t->deadline(), out);
            out.clear();
            ++wakes;
        }
    }
    const double used = processor_seconds() - begun;
    std::size_t moved = 0;
    for (std::size_t i = 0; i < twins; ++i) {
        const double way = all[i]->mechanics(1, end).position - before[i];
        moved += std::fabs(way - static_cast<double>(1000 + i) * simulated) < static_cast<double>(1000 + i) * 0.1 + 2;
    }
    bool kept =
        say("simulated / processor time", simulated / std::max(used, 1e-9), ">=", 100'000, "simulated", simulated, "processor", used, "s");
    kept &= say("wake-ups / twin and hour", static_cast<double>(wakes) / twins, "<=", 2, "wake-ups", static_cast<double>(wakes), "twins",
                twins, "");
    kept &= say("moved / all twins", static_cast<double>(moved) / twins, ">=", 1.0, "where they should be", static_cast<double>(moved),
                "all", twins, "");
    return kept && p.host.bad == 0;
}

/// The cost of comparing each feedback of a moving axis with its record of motion and with its limits, of all three kinds.
bool run_supervision(const FamilyEntry& e) {
    constexpr std::size_t axes = 1000;
    constexpr double rate = 100;
    constexpr std::size_t turns = 2000;
    std::printf("%zu moving axes of %s with limits: records of motion and the supervisor alone\n", axes,
                std::string(e.family->name).c_str());
    Plant p(e, axes, 40, 20, true);
    p.run_for(2s);
    for (const auto a : p.site->axis_ids)
        p.command(a, Enable{});
    p.run_for(1s);
    for (const auto a : p.site->axis_ids) {
        Move m;
        m.kind = Move::Kind::velocity;
        m.target = 1000;
        m.acceleration = 20000;
        m.deceleration = 20000;
        p.command(a, m);
    }
    p.run_for(2s);
    auto& parts = p.engine.parts();
    std::size_t moving = 0;
    for (const auto& a : parts.machine.axes)
        moving += a && a->motion.runs() && a->profile.feedback().moving && a->limits.position_max && a->limits.velocity_max;
    const auto events = p.host.events;
    const double begun = processor_seconds();
    for (std::size_t i = 0; i < turns; ++i) {
        for (const auto& a : parts.machine.axes) {
            if (!a) continue;
            parts.motions.look(*a, p.now);
            parts.supervisor.look(*a, p.now);
        }
    }
    const double look = (processor_seconds() - begun) / static_cast<double>(turns * axes);
    bool kept = say("share of a processor", look * rate * axes, "<=", 0.02, "each look", look * 1e9, "looks", rate * axes, "ns, a second");
    kept &= say("looked at / all axes", static_cast<double>(moving) / axes, ">=", 1.0, "moving with limits", static_cast<double>(moving),
                "all", axes, "axes");
    return kept && p.host.bad == 0 && p.host.events == events;
}

constexpr const char* usage =
    "bench_round [thousand|ten_thousand|supervision|world|unobserved]... [--seconds S] [--report-only]\n"
    "  --seconds S     simulated time of the world (default 3000)\n"
    "  --report-only   exit 0 even if a limit is not kept\n";
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    using namespace axisgate;
    double world = 3000;
    bool report_only = false;
    std::vector<std::string> wanted;
    for (int i = 1; i < argc; ++i) {
        const std::string a = argv[i];
        if (a == "--report-only") {
            report_only = true;
        } else if (a == "--seconds" && i + 1 < argc) {
            world = std::clamp(std::atof(argv[++i]), 1.0, 1e6);
        } else if (a == "thousand" || a == "ten_thousand" || a == "supervision" || a == "world" || a == "unobserved") {
            wanted.push_back(a);
        } else {
            std::fputs(bench::usage, stderr);
            return 2;
        }
    }
    const auto runs = [&](const char* name) { return wanted.empty() || std::ranges::find(wanted, name) != wanted.end(); };
    bool kept = true;
    for (const auto& e : test::families().entries) {
        // A serial line of one control carries some ten questions a second, so the figure is for buses whose drives are polled. CANopen
        // drives report by SYNC, and forty of them fill a bus at a third of that rate; their heartbeat wakes them even if nothing is asked.
        // bench_cia402 has their figures.
        const bool asked = e.family->name != "cia402" && e.family->name != "aposs";
        if (runs("thousand") && e.family->uses_can && asked) kept &= bench::run_polled(e, 1);
        if (runs("ten_thousand") && e.family->uses_can && asked) kept &= bench::run_polled(e, 10);
        if (runs("supervision") && e.family->uses_can && asked) kept &= bench::run_supervision(e);
        // A control that is alone on its line cannot be sixteen there.
        if (runs("world") && bench::addresses_for(e, 16).size() == 16) kept &= bench::run_world(e, world);
        // A hundred drives cannot be set in motion over one slow serial line in this time.
        if (runs("unobserved") && e.family->uses_can && asked) kept &= bench::run_unobserved(e);
    }
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept || report_only ? 0 : 1;
}
