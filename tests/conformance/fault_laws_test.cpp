// Laws of faults, for every family: every fault that a twin can raise has a number and a text in its catalogue; one fault is one alarm,
// raised once and cleared once.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>

#include "gateway/services/alarms/alarm.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

/// One condition of the hand, with its former value.
struct Condition {
    std::string name;
    Value value, before;
};

class FaultLaws : public Laws {
protected:
    std::unique_ptr<World>& w = world;

    /// A drive in a world of its own.
    void begin() {
        world = fresh();
        start();
    }
    bool fault() { return (now().flags & flag_fault) != 0; }
    std::string set(const std::string& name, const Value& v) { return hand(name, v); }

    /// Every condition of the hand with its possible values, except those that cut the drive off or are the number of a fault.
    std::vector<Condition> conditions() {
        std::vector<Condition> list;
        for (const HandItem& item : w->engine.twin(d1)->hand()) {
            if (!item.writable || item.name == "power" || item.name == "silent" || item.name.find("inject_error") != std::string::npos)
                continue;
            if (const auto* on = std::get_if<bool>(&item.value)) {
                list.push_back({item.name, Value{!*on}, item.value});
            } else if (const auto number = as_number(item.value)) {
                for (const double v : {0.0, 1.0, 3.0, 75.0, 90.0, 150.0, 200.0, -40.0, 1e6}) {
                    if (v != *number) list.push_back({item.name, Value{v}, item.value});
                }
            }
        }
        return list;
    }
    void expect_published(std::int32_t code, const std::string& by) {
        EXPECT_NE(code, 0) << by << ": a fault without a number";
        const ErrorCode* known = e.catalogue->error(code);
        ASSERT_TRUE(known) << by << ": " << code << " is not in the catalogue";
        EXPECT_GT(known->text.size(), 3u) << by << ": " << code;
        EXPECT_NE(known->kind, "command") << by << ": " << code << " is shown as the answer to a command";
    }
    /// The alarms of this drive, as they follow from the events.
    AlarmList alarms() {
        AlarmList list;
        std::uint64_t id = 0;
        for (Event ev : w->events) {
            ev.id = ++id;
            ev.at_unix_ns = static_cast<std::int64_t>(id);
            (void)list.on_event(ev);
        }
        return list;
    }
};

TEST_P(FaultLaws, WhatAHandCanRaiseHasANumberAndAText) {
    begin();
    std::set<std::string> injectors;
    for (const HandItem& item : w->engine.twin(d1)->hand()) {
        if (item.writable && item.name.find("inject_error") != std::string::npos) injectors.insert(item.name);
    }
    EXPECT_FALSE(injectors.empty());
    for (const auto& name : injectors) {
        int taken = 0;
        std::set<std::int64_t> codes;
        for (std::int64_t code = 1; code <= 1100; ++code)
            codes.insert(code);
        for (const ErrorCode& known : e.catalogue->errors())
            codes.insert(known.code);  // CiA 402 numbers them from 1000h on
        for (const std::int64_t code : codes) {
            if (!set(name, Value{code}).empty()) continue;  // the drive has no such error: it refuses with its possible ones
            ++taken;
            expect_published(static_cast<std::int32_t>(code), name);
            w->run_for(5ms);
        }
        EXPECT_GT(taken, 0) << name;
        (void)set(name, Value{std::int64_t{0}});
    }
}

TEST_P(FaultLaws, OneFaultIsOneAlarmRaisedOnceAndClearedOnce) {
    begin();
    auto list = conditions();
    for (const HandItem& item : w->engine.twin(d1)->hand()) {
        if (item.name != "inject_error") continue;
        for (const ErrorCode& known : e.catalogue->errors())
            list.push_back({item.name, Value{std::int64_t{known.code}}, Value{std::int64_t{0}}});
    }
    int faults = 0, resets = 0;
    for (const Condition& c : list) {
        const std::string by = c.name + " " + to_text(c.value);
        begin();
        ASSERT_NO_FATAL_FAILURE(order(a1, Enable{})) << by;
        ASSERT_NO_FATAL_FAILURE(turn(a1)) << by;
        w->events.clear();
        if (!set(c.name, c.value).empty()) continue;
        (void)w->run_until_true([&] { return fault(); }, 3s);
        w->run_for(500ms);
        if (!fault()) continue;
        ++faults;
        const auto raised = [&] { return std::ranges::count(w->events, std::string("fault"), &Event::kind); };
        const auto cleared = [&] { return std::ranges::count(w->events, std::string("fault_cleared"), &Event::kind); };
        EXPECT_EQ(raised(), 1) << by;
        const auto published = std::ranges::find(w->events, std::string("fault"), &Event::kind);
        ASSERT_NE(published, w->events.end()) << by;
        // A drive may have a fault without a number, such as an emergency stop: this must be reported, and no other fault.
        if (w->picture(a1).error_code != 0 || published->text.find("no number") == std::string::npos)
            expect_published(w->picture(a1).error_code, by);
        const auto before = alarms();
        EXPECT_EQ(before.all().size(), 1u) << by;
        for (const auto& [id, alarm] : before.all()) {
            EXPECT_TRUE(alarm.active) << by << ": " << alarm.text;
            EXPECT_EQ(alarm.kind, "fault") << by << ": " << alarm.text;
            EXPECT_EQ(alarm.code, w->picture(a1).error_code) << by;
        }
        (void)set(c.name, c.before);
        w->run_for(500ms);
        const Result* r = w->wait(w->command(a1, ResetFault{}, true), 10s);
        ASSERT_TRUE(r) << by;
        w->run_for(2s);
        EXPECT_EQ(raised(), 1) << by << ": raised anew by its reset";
        EXPECT_EQ(cleared(), fault() ? 0 : 1) << by;
        const auto after = alarms();
        EXPECT_EQ(after.all().size(), 1u) << by;
        for (const auto& [id, alarm] : after.all())
            EXPECT_EQ(alarm.active, fault()) << by << ": " << alarm.text;
        if (!fault()) ++resets;
        if (HasFailure()) {
            for (const auto& ev : w->events)
                ADD_FAILURE() << by << ": event " << ev.kind << " " << ev.code << " " << ev.text;
            return;
        }
    }
    EXPECT_GT(faults, 0) << "nothing that a hand does is a fault";
    EXPECT_GT(resets, 0) << "no fault of this family can be reset";
}

INSTANTIATE_TEST_SUITE_P(Families, FaultLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
