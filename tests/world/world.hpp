// An engine with simulated lines in virtual time, without clock, thread or socket; and the subjects of the suites: every family on each of
// its wires. A world is repeatable from its seed. It never sleeps: run_for() goes from deadline to deadline.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/json.hpp>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/engine/engine.hpp"
#include "gateway/wire/fault_line.hpp"
#include "gateway/wire/specimen_twin.hpp"
#include "gateway/wire/twin_bus.hpp"
#include "gateway/wire/twin_bus_end.hpp"

namespace axisgate::test {

/// Every family with its embedded catalogue, read once. A family for DDS lines is on a byte line here, where its twin can be disconnected
/// and connected like any other; that a site refuses this is tested with the program.
inline const Families& families() {
    static std::vector<std::unique_ptr<Catalogue>> kept;
    static std::deque<Family> changed;
    static const Families all = [] {
        Families f;
        for (const Family* x : all_families()) {
            std::vector<std::string> faults;
            auto c = Catalogue::parse(asset("schema/families/" + std::string(x->name) + ".json"), faults);
            if (!c) std::abort();
            kept.push_back(std::make_unique<Catalogue>(std::move(*c)));
            if (x->uses_dds) {
                changed.push_back(*x);
                changed.back().uses_dds = false;
            }
            f.entries.push_back({x->uses_dds ? &changed.back() : x, kept.back().get()});
        }
        return f;
    }();
    return all;
}

inline bool has_option(const FamilyEntry& e, std::string_view name) {
    const auto* list = e.catalogue->document().if_contains("options");
    return list && std::ranges::any_of(list->as_array(), [&](const auto& o) { return o.at("name").as_string() == name; });
}

/// `n` different valid addresses of a family: from the catalogue's "address" (min..max, or "examples").
inline std::vector<std::string> addresses(const FamilyEntry& e, std::size_t n) {
    std::vector<std::string> out;
    const auto* a = e.catalogue->document().if_contains("address");
    const auto& o = a->get_object();
    if (const auto* list = o.if_contains("examples"); list && list->is_array()) {
        for (const auto& v : list->get_array()) {
            if (out.size() < n) out.push_back(v.is_string() ? std::string(v.get_string()) : boost::json::serialize(v));
        }
    } else if (const auto* low = o.if_contains("min"); low && low->is_int64()) {
        for (std::int64_t i = low->get_int64(); out.size() < n && i <= o.at("max").get_int64(); ++i)
            out.push_back(std::to_string(i));
    } else {
        out.emplace_back(e.family->factory_address);
    }
    return out;
}

/// The kind of line of a drive. `serial` has the family's own bit rate, `network` carries bytes without one.
enum class Wire : std::uint8_t { can, serial, network };

/// One family on one of its wires: the subject of the laws.
struct Subject : FamilyEntry {
    Wire wire = Wire::serial;
    std::string variant{};   ///< not empty: a family that was changed for the test, with this word
    std::string specimen{};  ///< of its twins; empty: the drive as its manual shows it

    [[nodiscard]] LineKind kind() const { return wire == Wire::can ? LineKind::can : LineKind::bytes; }
    [[nodiscard]] std::string text() const {
        static constexpr const char* wires[] = {"can", "serial", "network"};
        return std::string(family->name) + "_" + wires[static_cast<int>(wire)] + (variant.empty() ? "" : "_" + variant) +
               (specimen.empty() ? "" : "_" + specimen);
    }
    /// URI of a cable of this wire, with real drives behind it (World::plug_in), or none.
    [[nodiscard]] std::string cable() const {
        return wire == Wire::can ? "can:sim" : wire == Wire::serial ? "serial:/dev/sim" : "tcp:127.0.0.1:9";
    }
    friend void PrintTo(const Subject& s, std::ostream* out) { *out << s.text(); }
};

inline std::vector<Subject> wires_of(const FamilyEntry& e) {
    std::vector<Subject> list;
    if (e.family->uses_can) list.push_back({e, Wire::can});
    if (e.family->uses_bytes && e.family->default_bit_rate != 0) list.push_back({e, Wire::serial});
    if (e.family->uses_bytes) list.push_back({e, Wire::network});
    return list;
}
/// Every family on each wire that it has.
inline const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all = [] {
        std::vector<Subject> list;
        for (const auto& e : families().entries)
            std::ranges::copy(wires_of(e), std::back_inserter(list));
        return list;
    }();
    return all;
}
inline std::string name_of_subject(const testing::TestParamInfo<Subject>& i) { return i.param.text(); }

/// The drives behind the cables, by line: they outlive the gateway.
struct Plant {
    std::map<std::string, std::unique_ptr<TwinBus>> buses;
};

class World final : public EngineHost {
public:
    /// A gateway that has just started; with `drives`, at those of a former one.
    explicit World(std::uint64_t seed_value = 1, std::shared_ptr<Plant> drives = std::make_shared<Plant>(), Families some = families())
        : seed(seed_value), plant(std::move(drives)), engine(std::move(some), *this, image) {}

    std::uint64_t seed;
    std::shared_ptr<Plant> plant;
    Image image;
    std::map<std::string, FaultLine*> cables;  ///< simulated real lines by name: cut, heal, rates
    std::map<std::string, TwinBus*> buses;     ///< the "real" drives behind those cables
    Engine engine;
    Instant now = at_ns(1'000'000'000);
    std::map<Ticket, std::vector<Result>> results;
    std::set<Ticket> on_disk;  ///< of those, the ones that were answered because the store had recorded them
    std::vector<Event> events;
    std::vector<Sample> samples;
    std::map<std::string, NonVolatile> twin_memories;
    std::optional<Instant> received_at;  ///< the last message of a client that commands; empty: clients are not monitored
    std::string store_fault;             ///< the store's answer to every order
    Duration store_delay{};              ///< and its delay
    std::uint64_t next_ticket = 1;
    std::uint64_t steps = 0;

    // --- EngineHost
    std::unique_ptr<Line> make_line(const LineSpec& spec, const LineSetup& setup) override {
        TwinBusOptions options;
        options.kind = setup.kind;
        options.bit_rate = setup.bit_rate;
        options.bits_per_byte = setup.bits_per_byte;
        options.converter = setup.kind == LineKind::bytes && families().find(spec.family).family->uses_can;
        auto& bus = plant->buses[spec.name];
        if (!bus) bus = std::make_unique<TwinBus>(options);
        buses[spec.name] = bus.get();
        FaultPlan plan;
        plan.seed = seed ^ std::hash<std::string>{}(spec.name);
        auto line = std::make_unique<FaultLine>(std::make_unique<TwinBusEnd>(*bus, plant), plan);
        cables[spec.name] = line.get();
        return line;
    }
    void on_result(const Result& result) override {
        results[result.ticket].push_back(result);
        if (stored_well_) on_disk.insert(result.ticket);
    }
    void on_event(Event event, Instant) override { events.push_back(std::move(event)); }
    void on_sample(const Sample& sample) override { samples.push_back(sample); }
    std::optional<Instant> last_received(const AuthorityClient&) const override { return received_at; }
    void on_store(StoreOrder order) override {
        to_store.emplace_back(std::max(now + store_delay, to_store.empty() ? now : to_store.back().first), order.ticket);
    }
    void on_twin_memory(const std::string& drive, NonVolatile memory) override { twin_memories[drive] = std::move(memory); }

    // --- actions of a test
    // One line "line" of this URI with this number of drives, as far as there are addresses, and an axis "a1", "a2"... for each of their
    // channels.
    Site make_site(const FamilyEntry& e, std::string_view uri, std::size_t drives, std::string_view presence = "auto", int channels = 1,
                   const boost::json::object& line_options = {}) {
        namespace json = boost::json;
        json::array ds, as;
        const auto list = addresses(e, drives);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string drive = "a" + std::to_string(i * static_cast<std::size_t>(channels) + 1);
            json::object d{{"name", drive}, {"line", "line"}, {"address", list[i]}, {"presence", presence}};
            // The laws look for quick stop active; specimens without 605Ah end off, and the laws know that, too.
            if (has_option(e, "quick_stop_stays")) d["options"] = json::object{{"quick_stop_stays", "yes"}};
            ds.push_back(std::move(d));
            for (int c = 1; c <= channels; ++c) {
                const std::size_t n = as.size() + 1;
                as.push_back({{"name", "a" + std::to_string(n)},
                              {"drive", drive},
                              {"channel", c},
                              {"number", n},
                              {"unit", "u"},
                              {"increments_per_unit", 100}});
            }
        }
        json::object line{{"name", "line"}, {"uri", uri}, {"family", e.family->name}};
        if (!line_options.empty()) line["options"] = line_options;
        const json::value doc{{"lines", {line}}, {"drives", ds}, {"axes", as}, {"mappings", json::array{}}};
        std::vector<SiteFault> faults;
        auto site = parse_site(doc, families(), faults);
        if (!site) {
            for (const auto& f : faults)
                fprintf(stderr, "%s: %s\n", f.pointer.c_str(), f.text.c_str());
            std::abort();
        }
        return std::move(*site);
    }
    /// Embedded drives on the subject's wire.
    Site twins(const Subject& s, std::size_t drives = 1, int channels = 1) {
        Site site = s.wire == Wire::network                        ? make_site(s, s.cable(), drives, "twin", channels)
                    : s.wire == Wire::serial && s.family->uses_can ? make_site(s, "twin", drives, "auto", channels, {{"kind", "bytes"}})
                                                                   : make_site(s, "twin", drives, "auto", channels);
        for (DriveSpec& d : site.drives) {
            if (!s.specimen.empty()) d.options["specimen"] = s.specimen;
        }
        return site;
    }
    std::shared_ptr<const SiteState> apply(Site site, SiteMemory memory = {}) {
        auto s = engine.apply_site(std::move(site), std::move(memory), ++revision, now);
        return s;
    }
    /// As a running gateway applies a changed site: moving axes that are removed are stopped first.
    std::shared_ptr<const SiteState> change(Site site) {
        std::shared_ptr<const SiteState> state;
        engine.change_site(std::move(site), {}, ++revision, now, [&](std::shared_ptr<const SiteState> s) { state = std::move(s); });
        EXPECT_TRUE(run_until_true([&] { return state != nullptr; }, std::chrono::seconds(6))) << "the site does not come into force";
        return state;
    }
    /// Puts a drive behind a simulated cable.
    void plug_in(const std::string& line, DriveId key, const FamilyEntry& e, const std::string& address, LineKind kind,
                 const NonVolatile& memory = {}, int channels = 1, const std::string& specimen = {}) {
        TwinSetup t;
        t.address = address;
        t.kind = kind;
        t.axes = channels;
        if (!specimen.empty()) t.options["specimen"] = specimen;
        buses.at(line)->add(key, make_specimen(*e.family, *e.catalogue, t), memory, now);
    }
    Ticket command(AxisId axis, CommandBody body, bool until_done = false) {
        Command c;
        c.ticket = make_ticket(first_service_door, next_ticket++);
        c.axis = axis;
        c.body = std::move(body);
        c.until_done = until_done;
        c.origin.door = http::clients;
        const Ticket t = c.ticket;
        engine.on_command(std::move(c), now);
        settle_store();
        return t;
    }
    /// The one result, if it has arrived.
    const Result* result(Ticket t) const {
        const auto it = results.find(t);
        return it == results.end() || it->second.empty() ? nullptr : &it->second.front();
    }
    AxisPicture picture(AxisId id) const { return image.picture(id); }

    /// The instant of the next event.
    [[nodiscard]] Instant next() const { return std::min(engine.deadline(), to_store.empty() ? never : to_store.front().first); }
    void step(Instant at) {
        now = std::max(now, at);
        engine.on_deadline(now);
        settle_store();
        ++steps;
    }
    void run_until(Instant end) {
        (void)run_until_true([] { return false; }, end - now);
    }
    void run_for(Duration d) { run_until(now + d); }
    /// Runs until `condition` is true, at most for `limit`. Returns false if it never was.
    template <class F>
    bool run_until_true(F&& condition, Duration limit) {
        const Instant end = now + limit;
        for (std::uint64_t n = 0; !condition(); ++n) {
            const Instant d = next();
            if (d > end) {
                now = end;
                return condition();
            }
            step(d);
            if (n > most_steps) {
                ADD_FAILURE() << "a storm: " << n << " steps in one run, and time stands at " << ns_of(now) << " ns";
                std::abort();
            }
        }
        return true;
    }
    const Result* wait(Ticket t, Duration limit) {
        (void)run_until_true([&] { return result(t) != nullptr; }, limit);
        return result(t);
    }

    static constexpr std::uint64_t most_steps = 5'000'000;  ///< of one run: frames that cause frames end a test instead of an endless loop

private:
    void settle_store() {
        while (!to_store.empty() && to_store.front().first <= now) {
            const Ticket ticket = to_store.front().second;
            to_store.pop_front();
            stored_well_ = store_fault.empty();
            engine.on_stored(ticket, store_fault, now);
            stored_well_ = false;
        }
    }
    std::deque<std::pair<Instant, Ticket>> to_store;  // one writer: later orders are stored later
    std::uint64_t revision = 0;
    bool stored_well_ = false;  // the store has just reported a success
};

}  // namespace axisgate::test
