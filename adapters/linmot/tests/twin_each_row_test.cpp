// The cases of the command table for the test of each command: rows, waits, variables, branches.
#include "adapters/linmot/tests/effect_trial.hpp"

namespace axisgate::linmot::test {
namespace {
void table_cases(EffectCases& all) {
    all["200xh"] = {[](Trial& t) {
        t.mark_row(1, 7);
        t.say("200xh", {1});
        t.run(10ms);
        t.is(t.marked(), 7, "the entry was carried out");
    }};
    for (const bool rising : {true, false}) {
        const std::string id = rising ? "201xh" : "202xh";
        all[id] = {[rising, id](Trial& t) {
            t.mark_row(1, 7);
            t.say(id, {1});
            if (rising)
                t.run(10ms);
            else
                t.edge(true);
            t.is(t.marked(), 100'000, "not before its edge");
            t.edge(rising);
            t.run(10ms);
            t.is(t.marked(), 7, "at its edge");
        }};
    }
    for (const auto& [id, value, wanted] : {std::tuple{"208xh", 9, 65'536 + 9}, {"209xh", 70'000, 70'000}}) {
        all[id] = {[id = id, value = value, wanted = wanted](Trial& t) {
            t.row(1, "240xh", {65'536 + 1}, 0xFFFF);
            t.say(id, {1, 6, value});
            t.motion("200xh", {1});
            t.run(10ms);
            t.is(t.drive().ram(0x1E72), wanted, "what the entry sets");
        }};
    }
    all["210xh"] = {[](Trial& t) { t.wait("210xh", {5000}, 490ms, [&] { t.run(20ms); }); }};
    for (const auto& [id, variable] : {std::pair{"218xh", "240xh"}, {"219xh", "242xh"}}) {
        all[id] = {[id = id, variable = variable](Trial& t) {
            t.motion(variable, {5000});
            t.wait(id, {}, 490ms, [&] { t.run(20ms); });
        }};
    }
    all["211xh"] = {[](Trial& t) {
        (void)t.hand("stall", Value{true});
        t.motion("010xh", {20'000, quick / 10, steep, steep});  // 30 ms
        t.wait("211xh", {}, 20ms, [&] { t.run(30ms); });
    }};
    all["212xh"] = {[](Trial& t) {
        (void)t.hand("stall", Value{true});
        t.motion("010xh", {20'000, quick / 10, steep, steep});
        t.wait("212xh", {}, 100ms, [&] {
            (void)t.hand("stall", Value{false});
            t.run(10ms);
        });
    }};
    for (const bool rising : {true, false}) {
        const std::string id = rising ? "213xh" : "214xh";
        all[id] = {[rising, id](Trial& t) {
            if (!rising) t.edge(true);
            t.wait(id, {}, 50ms, [&] {
                (void)t.hand("trigger", Value{rising});
                t.run(10ms);
            });
        }};
    }
}

/// Waits and branches: "greater" and "less" than the compared value in the situation.
void compare_cases(EffectCases& all) {
    struct Seen {
        char sub;  ///< of the wait "greater"; 0: there is none
        char less;
        const char* more_if;
        const char* less_if;
        std::int64_t value;
        int situation;  ///< 0 apart, 1 moving, 2 with a current
    };
    for (const Seen& s :
         {Seen{'0', '1', "259xh", "258xh", 10'000, 0}, Seen{'2', '3', "25Bxh", "25Axh", 30'000, 0},
          Seen{'4', '5', "25Dxh", "25Cxh", -20'000, 0}, Seen{'6', '7', nullptr, nullptr, 20'000, 0},
          Seen{'8', '9', nullptr, nullptr, 10'000, 1}, Seen{'A', 'B', nullptr, nullptr, 0, 1}, Seen{'E', 'F', "25Fxh", "25Exh", 500, 2}}) {
        const auto arrange = [s](Trial& t) {
            if (s.situation == 0) t.hold_apart();
            if (s.situation == 1) t.hold_moving();
            if (s.situation == 2) (void)t.hand("current", Value{s.value});
        };
        for (const bool greater : {true, false}) {
            const std::string id = fmt::format("22{}xh", greater ? s.sub : s.less);
            all[id] = {[s, arrange, greater, id](Trial& t) {
                arrange(t);
                const std::int64_t hold = s.value + (greater ? 100 : -100), pass = s.value - (greater ? 100 : -100);
                t.wait(id, {hold}, 20ms, [&] {
                    t.row(1, id, {pass}, 2);
                    t.motion("200xh", {1});
                    t.run(20ms);
                });
            }};
            if (const char* branch = greater ? s.more_if : s.less_if) {
                all[branch] = {[s, arrange, greater, branch](Trial& t) {
                    arrange(t);
                    const std::int64_t below = s.value - 100, above = s.value + 100;
                    t.branch(branch, {greater ? below : above}, {greater ? above : below});
                }};
            }
        }
    }
}

void variable_cases(EffectCases& all) {
    for (const auto& [id, upid, wanted] :
         {std::tuple{"240xh", 0x1E72, 5}, {"241xh", 0x1E72, 105}, {"242xh", 0x1E73, 5}, {"243xh", 0x1E73, 205}}) {
        all[id] = {[id = id, upid = upid, wanted = wanted](Trial& t) {
            t.drive().memory.set_ram(0x1E72, 100);
            t.drive().memory.set_ram(0x1E73, 200);
            t.say(id, {5});
            t.is(t.drive().ram(static_cast<std::uint16_t>(upid)), wanted, "the variable");
        }};
    }
    for (const auto& [id, wanted] : {std::pair{"248xh", 100}, {"249xh", 200}}) {
        all[id] = {[id = id, wanted = wanted](Trial& t) {
            t.drive().memory.set_ram(0x1E72, 100);
            t.drive().memory.set_ram(0x1E73, 200);
            t.say(id, {mark});
            t.is(t.marked(), wanted, "the variable's value in RAM");
        }};
    }
    for (const auto& [id, upid] : {std::pair{"24Cxh", 0x1E72}, {"24Dxh", 0x1E73}}) {
        all[id] = {[id = id, upid = upid](Trial& t) {
            t.say(id, {mark});
            t.is(t.drive().ram(static_cast<std::uint16_t>(upid)), 100'000, "the RAM value in the variable");
        }};
    }
    all["24Exh"] = {[](Trial& t) {
        t.motion("002xh", {mark, 77});
        t.say("24Exh", {mark});
        t.is(t.drive().memory.rom(mark), 77, "ROM");
    }};
    for (const auto& [id, value, greater] :
         {std::tuple{"250xh", 100, false}, {"251xh", 100, true}, {"252xh", 200, false}, {"253xh", 200, true}}) {
        all[id] = {[id = id, value = value, greater = greater](Trial& t) {
            t.drive().memory.set_ram(0x1E72, 100);
            t.drive().memory.set_ram(0x1E73, 200);
            t.branch(id, {greater ? value - 1 : value + 1}, {value});
        }};
    }
    for (const auto& [id, variable] : {std::pair{"256xh", 0x1E72}, {"257xh", 0x1E73}}) {
        all[id] = {[id = id, variable = variable](Trial& t) {
            t.drive().memory.set_ram(0x1E72, 1'000'000);
            t.drive().memory.set_ram(0x1E73, 1'000'000);
            t.drive().memory.set_ram(static_cast<std::uint16_t>(variable), 60'000);
            t.branch(id, {0x14C0}, {0x1473});  // 100000 and 50000
        }};
    }
    all["260xh"] = {[](Trial& t) {
        (void)t.hand("analog", Value{std::int64_t{300}});
        t.branch("260xh", {301}, {300});
    }};
    all["262xh"] = {[](Trial& t) {
        (void)t.hand("inputs", Value{std::int64_t{0x0106}});
        t.branch("262xh", {0x0F, 0x06}, {0x0F, 0x02});
    }};
    all["263xh"] = {[](Trial& t) { t.branch("263xh", {0x0F, 0}, {0x0F, 1}); }};  // the model has no inputs on X6: all are low
    all["264xh"] = {[](Trial& t) { t.branch("264xh", {0x0001, 0x0001}, {0x0001, 0x0000}); }};
    all["265xh"] = {[](Trial& t) {
        (void)t.hand("temperature", Value{75.0});
        t.branch("265xh", {0x0040, 0x0040}, {0x0040, 0x0000});
    }};
}

}  // namespace

void add_table_effects(EffectCases& all) {
    table_cases(all);
    compare_cases(all);
    variable_cases(all);
}

}  // namespace axisgate::linmot::test
