// bench_specimen measures the cost of twins as specimens beside that of the drive of the manual: the processor time of a twin for the same
// questions at the same instants, which were recorded between an adapter and the twin of specimen 0 while the axis stands and moves. The
// limit is 1.1 for the mean of the plain ratios; the ratio for each frame that is received or sent is shown beside it, because some
// specimens send more. The smallest time of each counts, because other work on the machine only adds. Arguments: a family, for this family
// alone; --freedoms shows the cost of each freedom by itself instead.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <map>
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
constexpr int specimens = 40, rounds = 9;
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

/// What a twin has cost and done for all questions.
struct Played {
    double seconds = 1e9;      ///< of processor time, the smallest of all rounds
    std::size_t frames = 0;    ///< received and sent
    std::size_t wake_ups = 0;  ///< events of its own

    [[nodiscard]] double per_frame() const { return seconds / static_cast<double>(std::max<std::size_t>(1, frames)); }
};

using Options = std::map<std::string, std::string>;

/// The twin answers all questions, with its own events between them; a further round keeps the smaller time.
void play(const FamilyEntry& e, const std::vector<Frame>& list, const Options& options, Played& result) {
    TwinSetup setup;
    setup.address = test::addresses(e, 1).front();
    setup.kind = e.family->uses_can ? LineKind::can : LineKind::bytes;
    setup.bit_rate = e.family->uses_can ? e.family->default_can_bit_rate : e.family->default_bit_rate;
    setup.options = options;
    const auto twin = make_specimen(*e.family, *e.catalogue, setup);
    Out out;
    twin->power_on({}, begin, out);
    std::size_t frames = list.size(), wake_ups = 0;
    const double before = processor_seconds();
    Instant passed = begin;
    const auto pass_until = [&](Instant until) {
        for (Instant due; (due = std::max(twin->deadline(), passed + 1us)) <= until;) {
            passed = due;
            out.frames.clear();
            twin->on_deadline(due, out);
            frames += out.frames.size();
            ++wake_ups;
        }
    };
    for (const Frame& frame : list) {
        pass_until(frame.at);
        out.frames.clear();
        twin->on_frame(frame, frame.at, out);
        frames += out.frames.size();
    }
    result.seconds = std::min(result.seconds, processor_seconds() - before);
    result.frames = frames;
    result.wake_ups = wake_ups;
}

/// One drive beside the manual's, played in turn, so that both meet the same state of the machine.
struct Pair {
    Played manual, other;

    [[nodiscard]] double plain() const { return other.seconds / manual.seconds; }
    [[nodiscard]] double per_frame() const { return other.per_frame() / manual.per_frame(); }
};

void play(const FamilyEntry& e, const std::vector<Frame>& list, const Options& options, Pair& pair) {
    for (int round = 0; round < rounds; ++round) {
        play(e, list, {{"specimen", "0"}}, pair.manual);
        play(e, list, options, pair.other);
    }
}

bool compare(const FamilyEntry& e) {
    const auto list = questions(e);
    double plain = 0, per_frame = 0, most = 0, manual = 0, other = 0;
    int dearest = 0;
    for (int i = 1; i <= specimens; ++i) {
        Pair pair;
        play(e, list, {{"specimen", std::to_string(i)}}, pair);
        plain += pair.plain() / specimens;
        per_frame += pair.per_frame() / specimens;
        manual += pair.manual.seconds / specimens;
        other += pair.other.seconds / specimens;
        if (pair.plain() > most) most = pair.plain(), dearest = i;
    }
    const bool kept = say(std::string(e.family->name).c_str(), plain, "<=", 1.1, "specimen", other * 1e3, "manual", manual * 1e3, "ms");
    std::printf("    %-34s ratio %10.3f  (%zu questions in %.0f s)\n", "  per frame received or sent", per_frame, list.size(),
                std::chrono::duration<double>(recorded).count());
    std::printf("    %-34s ratio %10.3f  (specimen %d)\n", "  the dearest one", most, dearest);
    return kept;
}

/// Each freedom by itself, at the first value that a seed draws for it and that is not the manual's.
void compare_freedoms(const FamilyEntry& e) {
    const auto list = questions(e);
    std::printf("%s\n", std::string(e.family->name).c_str());
    for (const Freedom& f : e.catalogue->freedoms()) {
        std::int64_t value = f.fallback;
        for (std::uint32_t seed = 1; value == f.fallback && seed < 1000; ++seed)
            value = specimen_values(*e.catalogue, std::to_string(seed)).at(f.name);
        Pair pair;
        play(e, list, {{"specimen", "0"}, {f.name, std::to_string(value)}}, pair);
        std::printf("    %-30s %10lld  ratio %8.3f  per frame %8.3f  (%zu frames, %zu events of its own; manual %.4g ms, %zu, %zu)\n",
                    f.name.c_str(), static_cast<long long>(value), pair.plain(), pair.per_frame(), pair.other.frames, pair.other.wake_ups,
                    pair.manual.seconds * 1e3, pair.manual.frames, pair.manual.wake_ups);
    }
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    using namespace axisgate;
    bool kept = true, freedoms = false;
    std::string family;
    for (int i = 1; i < argc; ++i)
        (argv[i] == std::string("--freedoms") ? void(freedoms = true) : void(family = argv[i]));
    for (const FamilyEntry& e : test::families().entries) {
        if (!family.empty() && family != e.family->name) continue;
        if (e.catalogue->freedoms().empty()) continue;
        if (freedoms)
            bench::compare_freedoms(e);
        else
            kept = bench::compare(e) && kept;
    }
    return kept ? 0 : 1;
}
