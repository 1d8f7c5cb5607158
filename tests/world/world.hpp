// World: an engine with simulated lines in virtual time: the whole round without a clock, thread or socket.
// In: a site, a seed, what shall go wrong. Out: results by ticket, events, the image; everything repeatable from the seed.
// Never sleeps: run_for() goes from deadline to deadline.
#pragma once

#include <gtest/gtest.h>

#include <boost/json.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/core/engine.hpp"
#include "gateway/core/fault_line.hpp"
#include "gateway/core/twin_bus.hpp"

namespace axisgate::test {

/// Every family with its embedded catalogue, read once.
inline const Families& families() {
    static std::vector<std::unique_ptr<Catalogue>> kept;
    static const Families all = [] {
        Families f;
        for (const Family* x : all_families()) {
            std::vector<std::string> faults;
            auto c = Catalogue::parse(asset("schema/families/" + std::string(x->name) + ".json"), faults);
            if (!c) std::abort();
            kept.push_back(std::make_unique<Catalogue>(std::move(*c)));
            f.entries.push_back({x, kept.back().get()});
        }
        return f;
    }();
    return all;
}

/// `n` different good addresses of a family: from the catalogue's "address" (min..max, or "examples").
inline std::vector<std::string> addresses(const FamilyEntry& e, std::size_t n) {
    std::vector<std::string> out;
    const auto* a = e.catalogue->document().if_contains("address");
    const auto& o = a->get_object();
    if (const auto* list = o.if_contains("examples"); list && list->is_array()) {
        for (const auto& v : list->get_array()) {
            if (out.size() < n) out.push_back(v.is_string() ? std::string(v.get_string()) : boost::json::serialize(v));
        }
    } else if (const auto* low = o.if_contains("min"); low && low->is_int64()) {
        for (std::int64_t i = low->get_int64(); out.size() < n && i <= o.at("max").get_int64(); ++i) out.push_back(std::to_string(i));
    } else {
        out.emplace_back(e.family->factory_address);
    }
    return out;
}

class World final : public EngineHost {
public:
    explicit World(std::uint64_t seed_value = 1) : seed(seed_value), engine(families(), *this, image) {}

    std::uint64_t seed;
    Image image;
    Engine engine;
    Instant now = at_ns(1'000'000'000);
    std::map<Ticket, std::vector<Result>> results;
    std::vector<Event> events;
    std::vector<Sample> samples;
    std::map<std::string, FaultLine*> cables;   ///< simulated real lines by name: cut, heal, rates
    std::map<std::string, TwinBus*> buses;      ///< the "real" drives behind those cables
    std::map<std::string, NonVolatile> twin_memories;
    std::optional<Instant> heard_at;            ///< when a client that commands was heard last on its door; nothing: nobody watches
    std::string store_fault;                    ///< what the store says to every order
    std::uint64_t next_ticket = 1;
    std::uint64_t steps = 0;

    // --- EngineHost
    std::unique_ptr<Line> make_line(const LineSpec& spec, const LineSetup& setup) override {
        TwinBusOptions options;
        options.kind = setup.kind;
        options.bit_rate = setup.bit_rate;
        options.bits_per_byte = setup.bits_per_byte;
        auto bus = std::make_unique<TwinBus>(options);
        buses[spec.name] = bus.get();
        FaultPlan plan;
        plan.seed = seed ^ std::hash<std::string>{}(spec.name);
        auto line = std::make_unique<FaultLine>(std::move(bus), plan);
        cables[spec.name] = line.get();
        return line;
    }
    void on_result(const Result& result) override { results[result.ticket].push_back(result); }
    void on_event(Event event, Instant) override { events.push_back(std::move(event)); }
    void on_sample(const Sample& sample) override { samples.push_back(sample); }
    void on_store(StoreOrder order) override { to_store.push_back(std::move(order)); }
    std::optional<Instant> heard(const AuthorityClient&) const override { return heard_at; }
    void on_twin_memory(const std::string& drive, NonVolatile memory) override { twin_memories[drive] = std::move(memory); }

    // --- what a test does
    /// One line per entry of `lines` (uri "twin" or "can:x"/"tcp:x:1" for a simulated cable), `per_line` drives of one axis each.
    Site make_site(const FamilyEntry& e, std::string_view uri, std::size_t drives, std::string_view presence = "auto") {
        namespace json = boost::json;
        json::array ds, as;
        const auto list = addresses(e, drives);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string name = "a" + std::to_string(i + 1);
            ds.push_back({{"name", name}, {"line", "line"}, {"address", list[i]}, {"presence", presence}});
            as.push_back({{"name", name}, {"drive", name}, {"number", i + 1}, {"unit", "u"}, {"increments_per_unit", 100}});
        }
        const json::value doc{{"lines", {{{"name", "line"}, {"uri", uri}, {"family", e.family->name}}}}, {"drives", ds}, {"axes", as}, {"mappings", json::array{}}};
        std::vector<SiteFault> faults;
        auto site = parse_site(doc, families(), faults);
        if (!site) {
            for (const auto& f : faults) fprintf(stderr, "%s: %s\n", f.pointer.c_str(), f.text.c_str());
            std::abort();
        }
        return std::move(*site);
    }
    std::shared_ptr<const SiteState> apply(Site site, SiteMemory memory = {}) {
        auto s = engine.apply_site(std::move(site), std::move(memory), ++revision, now);
        return s;
    }
    /// Puts a drive behind a simulated cable.
    void plug_in(const std::string& line, DriveId key, const FamilyEntry& e, const std::string& address, LineKind kind, const NonVolatile& memory = {}) {
        TwinSetup t;
        t.address = address;
        t.kind = kind;
        buses.at(line)->add(key, e.family->make_twin(*e.catalogue, t), memory, now);
    }
    Ticket command(AxisId axis, CommandBody body, bool until_done = false) {
        Command c;
        c.ticket = make_ticket(Door::http, next_ticket++);
        c.axis = axis;
        c.body = std::move(body);
        c.until_done = until_done;
        c.origin.door = Door::http;
        const Ticket t = c.ticket;
        engine.on_command(std::move(c), now);
        settle_store();
        return t;
    }
    /// The one result, if it is there.
    const Result* result(Ticket t) const {
        const auto it = results.find(t);
        return it == results.end() || it->second.empty() ? nullptr : &it->second.front();
    }
    AxisPicture picture(AxisId id) const { return image.picture(id); }

    void run_until(Instant end) {
        for (std::uint64_t n = 0;; ++n) {
            const Instant d = engine.deadline();
            if (d > end) break;
            now = std::max(now, d);
            engine.on_deadline(now);
            settle_store();
            ++steps;
            if (n > most_steps) {
                ADD_FAILURE() << "a storm: " << n << " steps in one run, and time stands at " << ns_of(now) << " ns";
                std::abort();
            }
        }
        now = end;
    }
    void run_for(Duration d) { run_until(now + d); }
    /// Runs until `condition` holds, at most for `limit`. False: it never did.
    template <class F>
    bool run_until_true(F&& condition, Duration limit) {
        const Instant end = now + limit;
        while (!condition()) {
            const Instant d = engine.deadline();
            if (d > end) {
                now = end;
                return condition();
            }
            now = std::max(now, d);
            engine.on_deadline(now);
            settle_store();
            ++steps;
        }
        return true;
    }
    const Result* wait(Ticket t, Duration limit) {
        (void)run_until_true([&] { return result(t) != nullptr; }, limit);
        return result(t);
    }

    static constexpr std::uint64_t most_steps = 5'000'000;  ///< of one run: frames that breed frames end a test instead of hanging it

private:
    void settle_store() {
        while (!to_store.empty()) {
            auto list = std::move(to_store);
            to_store.clear();
            for (auto& o : list) engine.on_stored(o.ticket, store_fault, now);
        }
    }
    std::vector<StoreOrder> to_store;
    std::uint64_t revision = 0;
};

}  // namespace axisgate::test
