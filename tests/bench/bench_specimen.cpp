// bench_specimen measures the cost of twins as specimens beside that of the drive of the manual: the processor time of a twin for the same
// questions at the same instants, which were recorded between an adapter and the twin of specimen 0 while the axis stands and moves. The
// limit is 1.1. Twins of both kinds are played in turn, and the smallest time of each counts, because other work on the machine only adds.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/specimen.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/wire/frame_log.hpp"
#include "gateway/wire/specimen_twin.hpp"
#include "tests/bench/report.hpp"
#include "tests/world/world.hpp"

namespace axisgate::bench {
namespace {
using namespace std::chrono_literals;
using test::families;

constexpr Duration recorded = 20s;
constexpr int specimens = 40, rounds = 5;
constexpr Instant begin = at_ns(1'000'000'000);

double processor_seconds() {
    timespec t{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

struct Host final : EngineHost {
    std::unique_ptr<Line> make_line(const LineSpec&, const LineSetup&) override { std::abort(); }  // twin lines alone
    void on_result(const Result&) override {}
    void on_event(Event, Instant) override {}
    void on_sample(const Sample&) override {}
    void on_store(StoreOrder) override {}
    void on_twin_memory(const std::string&, NonVolatile) override {}
};

Site one_axis(const FamilyEntry& e) {
    namespace json = boost::json;
    std::vector<SiteFault> faults;
    auto site = parse_site(
        json::object{
            {"lines", json::array{{{"name", "line"}, {"uri", "twin"}, {"family", e.family->name}}}},
            {"drives", json::array{{{"name", "a"}, {"line", "line"}, {"address", test::addresses(e, 1).front()}, {"presence", "twin"}}}},
            {"axes", json::array{{{"name", "a"}, {"drive", "a"}, {"number", 1}, {"unit", "u"}, {"increments_per_unit", 100}}}}},
        families(), faults);
    if (!site) std::abort();
    return std::move(*site);
}

/// The questions of an adapter to one drive: a motion of two seconds in each four, on which the drive is asked as the adapter does it.
std::vector<Frame> questions(const FamilyEntry& e) {
    Host host;
    Image image;
    Engine engine(families(), host, image, 1 << 16);
    Instant now = begin;
    const auto site = engine.apply_site(one_axis(e), {}, 1, now);
    const AxisId axis = site->axis_ids.front();
    std::uint64_t sequence = 0, seen = 1;
    std::vector<Frame> list;
    const auto command = [&](CommandBody body) {
        Command c;
        c.ticket = make_ticket(first_service_door, ++sequence);
        c.axis = axis;
        c.body = std::move(body);
        c.origin.door = http::clients;
        engine.on_command(std::move(c), now);
    };
    for (Duration t = 0s; t < recorded; t += 1s) {
        if (t == 2s || t == 3s) command(Enable{});
        if (t >= 4s && (t / 1s) % 4 == 0) {
            Move move;
            move.target = (t / 1s) % 8 == 0 ? 4000 : 0;
            move.velocity = 2000;
            command(move);
        }
        const Instant end = now + 1s;
        for (Instant due; (due = engine.wake_at()) <= end;) {
            now = std::max(now, due);
            engine.on_deadline(now);
        }
        now = end;
        const auto part = engine.frame_log(site->line_ids.front())->read(seen, 1 << 16, 0);
        seen = part.next;
        for (const TraceEntry& entry : part.entries) {
            if (!entry.to_drive) continue;
            list.push_back(entry.frame);
            list.back().at = at_ns(entry.at_unix_ns);
        }
    }
    return list;
}

/// Processor time of the twin for all questions, with its own events between them.
double play(const FamilyEntry& e, const std::vector<Frame>& list, const std::string& specimen) {
    TwinSetup setup;
    setup.address = test::addresses(e, 1).front();
    setup.kind = e.family->uses_can ? LineKind::can : LineKind::bytes;
    setup.bit_rate = e.family->uses_can ? e.family->default_can_bit_rate : e.family->default_bit_rate;
    setup.options["specimen"] = specimen;
    const auto twin = make_specimen(*e.family, *e.catalogue, setup);
    Out out;
    twin->power_on({}, begin, out);
    const double before = processor_seconds();
    Instant passed = begin;
    const auto pass_until = [&](Instant until) {
        for (Instant due; (due = std::max(twin->deadline(), passed + 1us)) <= until;) {
            passed = due;
            out = {};
            twin->on_deadline(due, out);
        }
    };
    for (const Frame& frame : list) {
        pass_until(frame.at);
        out = {};
        twin->on_frame(frame, frame.at, out);
    }
    return processor_seconds() - before;
}

double least(const FamilyEntry& e, const std::vector<Frame>& list, const std::string& specimen, double so_far) {
    return std::min(so_far, play(e, list, specimen));
}

bool compare(const FamilyEntry& e) {
    const auto list = questions(e);
    constexpr double none = 1e9;
    double manual = none, sum = 0, most = 0;
    std::vector<double> each(specimens, none);
    std::string dearest;
    for (int round = 0; round < rounds; ++round) {
        manual = least(e, list, "0", manual);
        for (int i = 0; i < specimens; ++i)
            each[static_cast<std::size_t>(i)] = least(e, list, std::to_string(i + 1), each[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; i < specimens; ++i) {
        const double one = each[static_cast<std::size_t>(i)];
        sum += one;
        if (one > most) most = one, dearest = std::to_string(i + 1);
    }
    const std::string what = std::string(e.family->name) + ", mean of the specimens";
    const bool kept =
        say(what.c_str(), sum / specimens / manual, "<=", 1.1, "specimen", sum / specimens * 1e3, "manual", manual * 1e3, "ms");
    std::printf("    %-34s ratio %10.3f  (specimen %s; %zu questions in %.0f s)\n", "  the dearest one", most / manual, dearest.c_str(),
                list.size(), std::chrono::duration<double>(recorded).count());
    return kept;
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    using namespace axisgate;
    bool kept = true;
    for (const FamilyEntry& e : test::families().entries) {
        if (argc > 1 && argv[1] != std::string(e.family->name)) continue;
        if (e.catalogue->freedoms().empty()) continue;
        kept = bench::compare(e) && kept;
    }
    return kept ? 0 : 1;
}
