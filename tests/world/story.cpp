// One seeded day: commands of two clients, faults of the wire, of drives, store and gateway, then healing. Laws: one answer for each
// command, no fresh data from a silent drive, leases hold, motion only by order, everything heals. All randomness comes from the seed.
#include "tests/world/story.hpp"

#include <random>
#include <set>

#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/world/witness.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

constexpr Duration lease = 2s;
/// From the fastest speed of a story down the flattest ramp, and the longest wait for a drive's own reaction.
constexpr Duration stop_limit = 2500ms;
/// Data count as old after 3 s on a byte line, after 1 s on CAN; this is checked periodically.
constexpr Duration longest_fresh = 3500ms;

class Story {
public:
    Story(const Subject& subject, std::uint64_t seed) : seed_(seed), plan_(seed), random_(seed), subjects_{subject} {
        if (plan_.two_lines) {
            const auto& all = subjects();
            const auto here = std::ranges::find(all, subject.text(), &Subject::text) - all.begin();
            subjects_.push_back(all[(static_cast<std::size_t>(here) + 1 + seed / 7) % all.size()]);
        }
        for (std::size_t l = 0; l < subjects_.size(); ++l)
            add_line(l);
        world_ = std::make_unique<World>(seed);
        put_in_force();
        for (Machine& m : machines_) {
            const Subject& s = subjects_[m.line];
            if (m.channel == 1) world_->plug_in(line_name(m.line), m.key, s, m.address, s.kind(), {}, m.channels);
            m.shaft = witness_.watch(m.name, *world_->buses.at(line_name(m.line)), m.key, m.channel, world_->now);
            if (plan_.limits) witness_.limit(m.shaft, limit_increments + 300);
        }
    }

    StoryEnd run(int turns) {
        EXPECT_TRUE(world_->run_until_true([&] { return all_back(); }, 30s)) << "not all come up";
        for (turn_ = 0; turn_ < turns && !testing::Test::HasFailure(); ++turn_) {
            faults();
            if (plan_.restart && turn_ == turns / 2) restart();
            give_command();
            pass(std::chrono::milliseconds(random_() % 250));
        }
        heal();
        return {mix_in(fingerprint_, *world_), std::move(went_wrong_)};
    }

private:
    static constexpr double limit_units = 40, limit_increments = limit_units * 100;

    /// One axis of a drive behind a cable.
    struct Machine {
        std::string name, address;
        std::size_t line = 0;
        DriveId key = no_drive;
        int channel = 1, channels = 1;
        std::size_t shaft = 0;
        AxisId axis = no_axis;
        bool present = true;  ///< in the site
        struct Lease {
            int client = -1;  ///< no holder is known
            Instant until{};
        } lease;
        Instant asked[2]{};  ///< the last request of each client
    };
    struct Given {
        Ticket ticket = no_ticket;
        std::size_t machine = 0;
        int client = 0;
        Instant at{};
        bool stop = false, off = false, motion = false, write = false;
        std::uint64_t motions = 0, powers = 0;
        Machine::Lease lease;   ///< as it was known when the command was given
        Instant other_asked{};  ///< and the last request of the other client
    };

    static std::string line_name(std::size_t l) { return l == 0 ? "bad" : "good"; }
    std::uint64_t pick(std::uint64_t n) { return random_() % n; }
    double rate(double most) { return most * static_cast<double>(pick(1000)) / 1000.0; }
    FaultLine& cable() { return *world_->cables.at("bad"); }

    /// Adds a line of a subject with its drives to the document.
    void add_line(std::size_t l) {
        const Subject& s = subjects_[l];
        const int channels = std::min(s.catalogue->most_channels(), 1 + static_cast<int>(seed_ % 4));
        Site part = World(0).make_site(s, s.cable(), channels > 1 ? 1 : 3, "device", channels);
        const std::string prefix = line_name(l) + "-";
        part.lines[0].name = line_name(l);
        for (std::size_t i = 0; i < part.drives.size(); ++i) {
            part.drives[i].name = prefix + part.drives[i].name;
            part.drives[i].line = line_name(l);
        }
        for (auto& axis : part.axes) {
            Machine m;
            axis.drive = prefix + axis.drive;
            axis.name = m.name = prefix + axis.name;
            axis.number = static_cast<int>(machines_.size()) + 1;
            if (plan_.two_clients) axis.authority_mode = AuthorityMode::lease;
            if (plan_.limits) axis.position_min = -limit_units, axis.position_max = limit_units;
            const auto drive = std::ranges::find(part.drives, axis.drive, &DriveSpec::name) - part.drives.begin();
            m.line = l;
            m.address = part.drives[static_cast<std::size_t>(drive)].address;
            m.key = DriveId{static_cast<std::uint16_t>(drive)};
            m.channel = axis.channel;
            m.channels = channels;
            machines_.push_back(std::move(m));
        }
        std::ranges::move(part.lines, std::back_inserter(document_.lines));
        std::ranges::move(part.drives, std::back_inserter(document_.drives));
        std::ranges::move(part.axes, std::back_inserter(document_.axes));
    }
    void put_in_force() {
        world_->engine.set_lease(lease);
        const auto state = world_->change(document_);
        for (Machine& m : machines_) {
            const auto at = std::ranges::find(state->site.axes, m.name, &AxisSpec::name);
            m.present = at != state->site.axes.end();
            m.axis = m.present ? state->axis_ids[static_cast<std::size_t>(at - state->site.axes.begin())] : no_axis;
            m.lease = {};  // an axis that was built anew has no holder
        }
        good_line_was_up_ = false;
    }
    [[nodiscard]] bool back(const Machine& m) const {
        return !m.present || (world_->picture(m.axis).flags & (flag_online | flag_stale)) == flag_online;
    }
    [[nodiscard]] bool all_back() const {
        return std::ranges::all_of(machines_, [&](const Machine& m) { return back(m); });
    }

    // --- faults -----------------------------------------------------------------------------------------------------

    void faults() {
        const bool good_wire = !plan_.garbling && !plan_.faulty;
        if (!good_wire) wire_faults();
        if (plan_.bad_store) {
            world_->store_delay = std::chrono::milliseconds(pick(3) * 200);
            world_->store_fault = pick(4) == 0 ? "the disk is full" : "";
            went_wrong_["store late"] += world_->store_delay > Duration::zero();
        }
        if (plan_.site_changes && pick(8) == 0) change_site();
    }
    void wire_faults() {
        const bool can = subjects_[0].wire == Wire::can;
        if (turn_ % 10 == 3) {
            FaultRates to, from;
            to.loss = rate(0.2);
            from.loss = rate(0.2);
            from.delay = rate(0.2);
            from.delay_max = std::chrono::milliseconds(1 + pick(80));
            if (subjects_[0].wire != Wire::network) to.duplicate = rate(0.05);
            if (can) from.duplicate = rate(0.1), from.reorder = rate(0.2);
            if (pick(4) == 0) from.drift = 20ms, from.drift_max = std::chrono::milliseconds(pick(120));
            if (pick(4) == 0) (pick(2) ? to : from).loss = 1;  // one direction is cut: the line is up, but half of it does not work
            went_wrong_["slow drift"] += from.drift_max > Duration::zero();
            went_wrong_["not heard by the drives"] += to.loss == 1;
            went_wrong_["drives not heard"] += from.loss == 1;
            if (plan_.garbling) {
                to.flip = from.flip = rate(0.05);
                from.truncate = rate(0.05);
                from.insert = rate(0.05);
            }
            cable().set_rates(to, from);
        }
        if (turn_ % 10 == 9) cable().set_rates({}, {});
        if (pick(20) == 0) cable().cut(world_->now), ++went_wrong_["cable cut"];
        if (can && pick(20) == 0) {
            cable().bus_off(world_->now, std::chrono::milliseconds(20 + pick(500)));
            ++went_wrong_["bus-off"];
        }
        if (pick(5) == 0 && cable().is_cut()) cable().heal(world_->now);
        if (pick(15) == 0) drive_fault(machines_[pick(machines_.size())]);
    }
    void drive_fault(const Machine& m) {
        if (m.line != 0) return;
        if (pick(2)) {
            const bool silent = pick(2) == 0;
            went_wrong_["drive silent"] += silent;
            return (void)world_->buses.at("bad")->set_hand(m.key, "silent", Value{silent}, world_->now);
        }
        power(m.key, pick(2) == 0);
    }
    void power(DriveId key, bool on) {
        (void)world_->buses.at("bad")->set_hand(key, "power", Value{on}, world_->now);
        if (on ? without_power_.erase(key) == 0 : !without_power_.insert(key).second) return;  // unchanged: no order has ended by this
        if (!on) ++went_wrong_["drive without power"];
        for (const Machine& m : machines_) {
            if (m.line != 0 || m.key != key) continue;
            witness_.power_cycled(m.shaft);
            // Earlier orders are over, except those on their way.
            const bool waits =
                std::ranges::any_of(given_, [&](const Given& g) { return g.machine == static_cast<std::size_t>(&m - machines_.data()); });
            if (!waits) witness_.stopped(m.shaft, witness_.motions(m.shaft), world_->now + stop_limit);
        }
    }
    void change_site() {
        ++went_wrong_["site changed"];
        std::size_t first = machines_.size();  // of those that are removed or made anew, up to the last
        std::size_t behind = machines_.size();
        switch (pick(3)) {
            case 0:
                for (auto& a : document_.axes)
                    a.unit = a.unit == "u" ? "mm" : "u";
                break;
            case 1:  // its drives are at other addresses: the line is built anew
                document_.lines[0].timing.retries = document_.lines[0].timing.retries == 2 ? -1 : 2;
                first = 0;
                behind = static_cast<std::size_t>(std::ranges::count(machines_, std::size_t{0}, &Machine::line));
                break;
            default:  // the last axis is removed, or returns
                if (!removed_) {
                    removed_ = document_.axes.back();
                    document_.axes.pop_back();
                    first = machines_.size() - 1;
                } else {
                    document_.axes.push_back(*removed_);
                    removed_.reset();
                }
        }
        put_in_force();
        for (; first < behind; ++first) {  // on a wire that carries everything it stands by then
            const Machine& m = machines_[first];
            if (plan_.limits || m.line != 0) witness_.stopped(m.shaft, witness_.motions(m.shaft), world_->now);
        }
    }
    void restart() {
        Instant then = world_->now;
        ++went_wrong_["restart"];
        mix_in(fingerprint_, *world_);
        given_.clear();                     // no gateway is left to answer
        for (const Machine& m : machines_)  // and none to halt motions without an end, until the other gateway has found them
            if (witness_.speed(m.shaft, then) > 0) witness_.lift_limit(m.shaft);
        auto plant = world_->plant;
        world_.reset();
        then += std::chrono::milliseconds(pick(1500));
        world_ = std::make_unique<World>(seed_ + 1, plant);
        world_->now = then;
        put_in_force();
    }

    // --- commands ---------------------------------------------------------------------------------------------------

    void give_command() {
        const std::size_t n = pick(machines_.size());
        Machine& m = machines_[n];
        const Subject& s = subjects_[m.line];
        Given g;
        g.machine = n;
        g.client = plan_.two_clients ? static_cast<int>(pick(2)) : 0;
        CommandBody body = any_body(s, g);
        if (!m.present) return;
        g.at = world_->now;
        g.write = std::holds_alternative<WriteParameter>(body);
        g.lease = m.lease;
        g.other_asked = m.asked[1 - g.client];
        m.asked[g.client] = g.at;
        if (g.motion) witness_.motion_ordered(m.shaft);
        if (std::holds_alternative<Enable>(body)) witness_.power_ordered(m.shaft);
        g.motions = witness_.motions(m.shaft);
        g.powers = witness_.powers(m.shaft);
        static const auto anna = std::make_shared<const std::string>("anna"), plc = std::make_shared<const std::string>("192.0.2.7");
        Command c;
        c.ticket = g.ticket = make_ticket(g.client ? DoorNumber{1} : first_service_door, world_->next_ticket++);
        c.axis = m.axis;
        c.until_done = pick(2) == 0 && !std::holds_alternative<Move>(body);
        c.origin = {g.client ? modbus::clients : http::clients, g.client ? plc : anna, g.client ? plc : anna};
        c.body = std::move(body);
        world_->engine.on_command(std::move(c), world_->now);
        given_.push_back(g);
    }
    CommandBody any_body(const Subject& s, Given& g) {
        Move m;
        m.target = static_cast<std::int64_t>(pick(20001)) - 10000;
        if (plan_.limits) m.target = m.target * 6 / 10;  // a third of them lead beyond the limit
        m.velocity = 1 + static_cast<std::int64_t>(pick(8000));
        m.acceleration = 10000 + static_cast<std::int64_t>(pick(30000));
        m.deceleration = m.acceleration;
        switch (pick(10)) {
            case 0:
            case 1:
            case 2:
                return Enable{};
            case 3:
            case 4:
                g.motion = true;
                return m;
            case 5:
                g.motion = true;
                m.kind = Move::Kind::velocity;
                m.target = static_cast<std::int64_t>(pick(10001)) - 5000;
                m.velocity.reset();
                return m;
            case 6:
                g.stop = true;
                return pick(2) ? CommandBody{Halt{}} : CommandBody{QuickStop{}};
            case 7:
                if (pick(2)) return ResetFault{};
                g.stop = g.off = true;
                return Disable{};
            case 8:
                return write_something(s);
            default: {
                const auto i = static_cast<std::uint16_t>(pick(s.catalogue->parameters().size()));
                const auto& p = s.catalogue->parameters()[i];
                return ReadParameter{{i, p.count ? p.first : std::uint16_t{0}}};
            }
        }
    }
    /// A stored value that moves nothing: its factory setting, if the catalogue knows it.
    CommandBody write_something(const Subject& s) {
        const auto all = s.catalogue->parameters();
        for (std::size_t tries = 0; tries < 20; ++tries) {
            const auto i = static_cast<std::uint16_t>(pick(all.size()));
            const Parameter& p = all[i];
            if (p.access == Access::read_write && !p.live && !p.addressing && !p.count && known(p.factory_default))
                return WriteParameter{{i, 0}, p.factory_default};
        }
        return ResetFault{};
    }

    // --- the laws ---------------------------------------------------------------------------------------------------

    void pass(Duration d) {
        const Instant end = world_->now + d;
        while (world_->now < end) {
            world_->run_until(std::min(end, world_->now + 20ms));
            if (!plan_.garbling) witness_.look(world_->now);
            look();
        }
    }
    void look() {
        std::erase_if(given_, [&](const Given& g) {
            const auto& list = world_->results[g.ticket];
            if (list.empty()) return false;
            EXPECT_EQ(list.size(), 1u);
            judge(g, list.front());
            return true;
        });
        for (const Machine& m : machines_) {
            if (!m.present) continue;
            const auto p = world_->picture(m.axis);
            if (world_->now - p.at > longest_fresh)
                EXPECT_NE(p.flags & flag_stale, 0) << m.name << " is shown as fresh, and has said nothing";
            if (!(p.flags & flag_online)) EXPECT_NE(p.flags & flag_stale, 0) << m.name << " is shown as fresh, and nobody answers";
            if (m.line > 0 && good_line_was_up_ && !(p.flags & flag_online)) ADD_FAILURE() << m.name << " has no fault, and is offline";
        }
        good_line_was_up_ = std::ranges::all_of(machines_, [&](const Machine& m) { return m.line == 0 || back(m); });
    }
    void judge(const Given& g, const Result& r) {
        Machine& m = machines_[g.machine];
        if (!good(r)) EXPECT_FALSE(r.text.empty()) << m.name << ": " << name_of(r.reason);
        if (g.write && good(r)) EXPECT_TRUE(world_->on_disk.contains(g.ticket)) << m.name << ": a write is answered before it is stored";
        went_wrong_["store full"] += r.reason == Reason::not_stored;
        went_wrong_["refused for a lease"] += r.reason == Reason::authority;
        if (g.stop) {
            EXPECT_NE(r.reason, Reason::authority) << "a stop is open to everybody: " << r.text;
            if (good(r)) witness_.stopped(m.shaft, g.motions, world_->now + stop_limit);
            if (good(r) && g.off) witness_.switched_off(m.shaft, g.powers, world_->now + stop_limit);
            return;
        }
        if (!plan_.two_clients) return;
        const bool held_by_other = g.lease.client >= 0 && g.lease.client != g.client && g.at < g.lease.until;
        if (r.reason == Reason::authority) EXPECT_LT(g.at, g.other_asked + lease) << "nobody can hold it: " << r.text;
        if (!g.motion || !good(r)) return;
        EXPECT_FALSE(held_by_other) << m.name << " was moved by client " << g.client << " while client " << g.lease.client << " held it";
        if (g.at + lease > m.lease.until) m.lease = {g.client, g.at + lease};
    }

    void heal() {
        const FaultCounters& c = cable().counters();
        const std::pair<const char*, std::uint64_t> by_wire[] = {
            {"lost", c.lost},        {"doubled", c.duplicated}, {"bit turned over", c.flipped}, {"cut short", c.truncated},
            {"foreign", c.inserted}, {"late", c.delayed},       {"reordered", c.reordered},     {"swallowed", c.swallowed}};
        for (const auto& [name, n] : by_wire)
            went_wrong_[name] += n;
        world_->store_delay = {};
        world_->store_fault.clear();
        cable().set_rates({}, {});
        cable().heal(world_->now);
        for (const Machine& m : machines_) {
            if (m.line != 0 || m.channel != 1) continue;
            (void)world_->buses.at("bad")->set_hand(m.key, "silent", Value{false}, world_->now);
            power(m.key, true);
        }
        const Instant healed = world_->now;
        // Reported since then: a drive that restarted in the last moment is shown online until its silence is noticed.
        const auto received = [&](const Machine& m) { return !m.present || world_->picture(m.axis).at > healed; };
        EXPECT_TRUE(world_->run_until_true([&] { return all_back() && std::ranges::all_of(machines_, received); }, 15s))
            << "an axis is not back after " << seconds(world_->now - healed) << " s";
        for (std::size_t n = 0; n < machines_.size(); ++n) {
            if (!machines_[n].present) continue;
            Given g;
            g.ticket = world_->command(machines_[n].axis, QuickStop{});
            g.machine = n;
            g.at = world_->now;
            g.stop = true;
            g.motions = witness_.motions(machines_[n].shaft);
            given_.push_back(g);
        }
        const Instant asked = world_->now;
        while (!given_.empty() && world_->now < asked + 60s)
            pass(50ms);
        EXPECT_TRUE(given_.empty()) << given_.size() << " commands have no answer";
        for (const Machine& m : machines_) {
            if (!m.present) continue;
            const Result* r = world_->wait(world_->command(m.axis, Disable{}, true), 10s);
            EXPECT_TRUE(r && good(*r)) << m.name << ": " << (r ? r->text : "no result");
        }
        pass(stop_limit);
        for (const Machine& m : machines_) {
            if (m.present && !plan_.garbling) EXPECT_EQ(witness_.speed(m.shaft, world_->now), 0) << m.name;
        }
        for (const auto& [t, list] : world_->results)
            EXPECT_EQ(list.size(), 1u) << "ticket " << (t & 0xFFFFFF);
    }

    /// The events as one number.
    static std::uint64_t mix_in(std::uint64_t& h, const World& w) {
        const auto mix = [&h](std::uint64_t v) { h = (h ^ v) * 1099511628211ull; };
        for (const auto& [t, list] : w.results) {
            mix(t);
            for (const auto& r : list)
                mix(static_cast<std::uint64_t>(r.outcome) << 8 | static_cast<std::uint64_t>(r.reason));
        }
        for (std::size_t i = 0; i < w.image.size(); ++i) {
            const auto p = w.image.picture(AxisId{static_cast<std::uint16_t>(i)});
            mix(static_cast<std::uint64_t>(p.position));
            mix(p.statusword);
            mix(static_cast<std::uint64_t>(ns_of(p.at)));
        }
        mix(w.events.size());
        mix(w.steps);
        return h;
    }

    std::uint64_t seed_;
    StoryPlan plan_;
    std::mt19937_64 random_;
    std::vector<Subject> subjects_;
    Site document_;
    std::optional<AxisSpec> removed_;
    std::vector<Machine> machines_;
    std::set<DriveId> without_power_;  ///< of those on the bad line
    std::unique_ptr<World> world_;
    Witness witness_;
    std::vector<Given> given_;
    std::map<std::string, std::uint64_t> went_wrong_;
    int turn_ = 0;
    bool good_line_was_up_ = false;
    std::uint64_t fingerprint_ = 1469598103934665603ull;
};

}  // namespace

StoryPlan::StoryPlan(std::uint64_t seed)
    : garbling(seed % 4 == 0),
      faulty(seed % 4 == 1 || seed % 4 == 2),
      limits(seed % 4 == 3),
      two_lines(seed % 5 == 1),
      two_clients(seed % 3 == 1),
      restart(seed % 7 == 3),
      site_changes(seed % 5 == 2),
      bad_store(seed % 2 == 1) {}

StoryEnd run_story(const Subject& subject, std::uint64_t seed, int turns) { return Story(subject, seed).run(turns); }

}  // namespace axisgate::test
