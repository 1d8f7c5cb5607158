// Laws of the values that a drive keeps over a power cycle, and of scans: a search of a line finds every drive on it and no other. For
// every family and wire.
#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <set>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class MemoryLaws : public Laws {
protected:
    using Values = std::map<std::string, std::string>;

    /// Every value of the catalogue that this drive provides, as text, except those that count time or events, or are measured.
    [[nodiscard]] Values values() {
        Values all;
        for (std::uint16_t i = 0; i < e.catalogue->parameters().size(); ++i) {
            const Parameter& p = e.catalogue->parameters()[i];
            if (p.access != Access::read_write || p.addressing) continue;  // the gateway sets the form of its line itself
            const int last = p.count ? std::min<int>(p.count, 4) : 1;
            for (int n = 0; n < last; ++n) {
                Point point = first_point(i);
                point.element = static_cast<std::uint16_t>(point.element + n);
                const Result* r = ask(a1, ReadParameter{point}, false);
                if (r && good(*r)) all[e.catalogue->id_of(point)] = to_text(r->value);
            }
        }
        return all;
    }
    /// Writes another value to a parameter, if it accepts one.
    bool change(std::uint16_t i) {
        const Parameter& p = e.catalogue->parameters()[i];
        if (p.access != Access::read_write || p.addressing || p.live || p.type == ValueType::text) return false;
        const Result* before = ask(a1, ReadParameter{first_point(i)}, false);
        const auto was = before && good(*before) ? as_number(before->value) : std::nullopt;
        if (!was) return false;
        for (const double other : {*was + 1, *was - 1, p.min.value_or(0), p.max.value_or(1)}) {
            if (other == *was || !e.catalogue->check_write(first_point(i), Value{other}).fault.empty()) continue;
            const Result* r = ask(a1, WriteParameter{first_point(i), Value{other}}, false);
            if (r && good(*r)) return true;
        }
        return false;
    }
    [[nodiscard]] bool comes_up() {
        if (!world->run_until_true([&] { return online(a1); }, 20s)) return false;
        world->run_for(2s);
        return true;
    }
};

TEST_P(MemoryLaws, WhatADriveKeepsIsItsMemoryAndNothingElse) {
    // Values that the gateway itself sets in a new drive are not a matter of memory: they differ in a drive to which nothing was written.
    start();
    const Values met = values();
    ASSERT_EQ(hand("power", Value{false}), "");
    ASSERT_TRUE(world->run_until_true([&] { return !(now().flags & flag_online); }, 20s));
    ASSERT_EQ(hand("power", Value{true}), "");
    ASSERT_TRUE(comes_up());
    const Values met_again = values();
    const auto kept_values = [&](Values list) {
        std::erase_if(list, [&](const auto& entry) {
            return !met.contains(entry.first) || !met_again.contains(entry.first) || met.at(entry.first) != met_again.at(entry.first);
        });
        return list;
    };
    EXPECT_EQ(met_again, met) << "a drive that comes back is set up as one that is met for the first time";
    if (!has_settings()) {
        EXPECT_TRUE(world->engine.twin(d1)->non_volatile().empty());
        return;
    }
    // All parameters, eight at a time; if a group of eight takes the drive off its line, one by one.
    std::deque<std::vector<std::uint16_t>> groups;
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size(); ++i) {
        if (i % 8 == 0) groups.emplace_back();
        groups.back().push_back(i);
    }
    std::size_t changed = 0, came_back = 0;
    while (!groups.empty()) {
        const auto group = std::move(groups.front());
        groups.pop_front();
        world = fresh();
        start();
        std::vector<std::uint16_t> written;
        std::string ids;
        for (const std::uint16_t i : group) {
            if (!change(i)) continue;
            written.push_back(i);
            ids += e.catalogue->parameters()[i].id + " ";
        }
        if (written.empty()) continue;
        changed += written.size();
        world->run_for(1s);
        const NonVolatile memory = world->engine.twin(d1)->non_volatile();
        if (!memory.empty()) {
            EXPECT_TRUE(world->run_until_true([&] { return world->twin_memories["a1"] == memory; }, 2s))
                << ids << ": what a twin keeps is given to the store";
        }
        ASSERT_EQ(hand("power", Value{false}), "");
        ASSERT_TRUE(world->run_until_true([&] { return !(now().flags & flag_online); }, 20s));
        ASSERT_EQ(hand("power", Value{true}), "");
        const bool up = comes_up();
        EXPECT_EQ(world->engine.twin(d1)->non_volatile(), memory) << ids << ": it is changed by being switched off and on";
        const Values after_power = kept_values(values());
        // The same drive, made anew from the stored memory.
        SiteMemory kept;
        kept.twins["a1"] = memory;
        world = fresh();
        site = world->apply(world->twins(e), std::move(kept));
        EXPECT_EQ(comes_up(), up) << ids << ": some settings take a drive off its line, but then built anew as well as switched off and on";
        if (!up) {
            if (written.size() > 1) {
                for (const std::uint16_t i : written)
                    groups.push_back({i});
            }
            continue;
        }
        ++came_back;
        EXPECT_EQ(kept_values(values()), after_power)
            << ids << ": switched off and on, or built anew from its memory: a drive does not know the difference";
        EXPECT_GT(after_power.size(), 10u) << ids;
    }
    EXPECT_GT(changed, 0u) << "no parameter of this family can be changed";
    EXPECT_GT(came_back, 0u);
}

TEST_P(MemoryLaws, AScanFindsEveryDriveAndNoOther) {
    // Every second address of the family's list has a drive on a cable, and the site names one of them.
    const auto list = addresses(e, 9);
    const Site wanted = world->make_site(e, e.cable(), 1, "device");
    site = world->apply(wanted);
    a1 = site->axis_ids.at(0);
    std::set<std::string> there;
    for (std::size_t i = 0; i < list.size(); i += 2) {
        world->plug_in("line", DriveId{static_cast<std::uint16_t>(i)}, e, list[i], e.kind());
        there.insert(list[i]);
    }
    ASSERT_TRUE(world->run_until_true([&] { return online(a1); }, 20s));
    const auto line = [&] { return world->engine.line_report(site->line_ids[0], world->now); };
    const AdapterCounters before = line().counters;
    ScanWish wish;
    wish.limit = 300s;
    const std::string refused = world->engine.start_scan(site->line_ids[0], wish, world->now);
    if (e.family->scan == nullptr || list.size() == 1) {
        if (e.family->scan == nullptr) EXPECT_NE(refused, "") << "it cannot be searched for, and nobody is told";
        if (!refused.empty()) return;
    }
    ASSERT_EQ(refused, "");
    const auto report = [&] { return world->engine.scan_report(site->line_ids[0]); };
    ASSERT_TRUE(world->run_until_true([&] { return report().state != ScanReport::State::running; }, 300s));
    EXPECT_EQ(report().state, ScanReport::State::done) << report().text;
    std::set<std::string> found;
    for (const auto& f : report().found) {
        EXPECT_TRUE(found.insert(f.address).second) << f.address << " is found twice";
        EXPECT_EQ(f.family, e.family->name);
        EXPECT_EQ(f.known_as, f.address == list[0] ? "a1" : "") << f.address;
    }
    EXPECT_EQ(found, there);
    // Time-outs at empty addresses belong to the scan and are not counted for the line.
    EXPECT_EQ(line().counters.timeouts, before.timeouts);
    EXPECT_EQ(line().counters.retries, before.retries);
    EXPECT_EQ(line().counters.garbled, before.garbled);
    if (report().asked > 0) EXPECT_GT(line().scanned.exchanges + line().scanned.timeouts, 0u);
    const auto scanned = line().scanned.exchanges;
    const auto counted = line().counters.exchanges;
    world->run_for(2s);
    EXPECT_EQ(line().scanned.exchanges, scanned) << "what comes after the scan is the line's again";
    EXPECT_GT(line().counters.exchanges, counted);
    EXPECT_NE(now().flags & flag_online, 0) << "the site's own drive was served all the time";
}

INSTANTIATE_TEST_SUITE_P(Families, MemoryLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
