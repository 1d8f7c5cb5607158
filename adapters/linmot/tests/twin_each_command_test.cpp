// The twin: each motion command of the catalogue has a case that shows its effect, and that the effect is missing if the command is
// omitted. The commands of the interpolator are tested in twin_effects_test.cpp. A command without a case is a failure.
#include "adapters/linmot/tests/effect_trial.hpp"

namespace axisgate::linmot::test {
namespace {
void general_cases(EffectCases& all) {
    all["001xh"] = {[](Trial& t) {
        t.say("001xh", {0x3E});
        t.is(t.state(), 2, "OFF1");
    }};
    all["002xh"] = {[](Trial& t) {
        t.say("002xh", {mark, 77});
        t.is(t.marked(), 77, "RAM");
        t.is(t.drive().memory.rom(mark), 100'000, "ROM");
    }};
    all["003xh"] = {[](Trial& t) {
        t.say("003xh", {5, 7});
        t.is(t.drive().outputs_x4(), 5, "the masked bits");
    }};
    all["004xh"] = {[](Trial& t) {
        t.say("004xh", {3, 2});
        t.is(t.drive().outputs_x6(), 2, "the masked bits");
    }};
    all["008xh"] = {[](Trial& t) {
        t.motion("01Axh", {30'000, quick, steep, steep});
        t.say("008xh");
        t.edge(true);
        t.run(1s);
        t.is(t.position(), 0, "nothing is armed");
    }};
    all["009xh"] = {[](Trial& t) {
        t.to(5000);
        t.say("009xh", {70'000});
        t.is(t.position(), 70'000, "the place has the new name");
        t.is(t.drive().status_word() >> 11 & 1, 1, "homed");
    }};
    all["0D0xh"] = {[](Trial& t) {
        t.to(50'000);
        (void)t.hand("capture", Value{true});
        t.to(0);
        t.say("0D0xh", {1000, quick, steep, steep});
        t.run(2s);
        t.is(t.position(), 51'000, "the captured place and 0.1 mm");
    }};
    all["0D1xh"] = {[](Trial& t) {
        t.say("0D1xh", {2500, 50'000, 60'000});
        t.run(2s);
        t.is(t.position(), 2500, "16 bits");
    }};
    for (const auto& [id, from_actual] : {std::pair{"0D4xh", false}, {"0D5xh", false}, {"0D6xh", true}, {"0D7xh", true}}) {
        all[id] = {[id = id, from_actual = from_actual](Trial& t) {
            t.motion("240xh", {7000});
            t.motion("242xh", {-9000});
            (void)t.hand("lag_ms", Value{5.0});
            t.motion("010xh", {200'000, quick / 10, steep, steep});
            t.run(50ms);
            const double behind = t.position(), ahead = t.demand();
            t.say(id, {quick / 10, steep, steep});
            t.is(t.demand(), from_actual ? behind : ahead, "from where it begins");
            t.run(3s);
            t.is(t.position(), id[2] == '4' || id[2] == '6' ? 7000 : -9000, "the variable");
        }};
    }
    for (const auto& [id, place] : {std::pair{"0DExh", 30'000.0}, {"0DFxh", -20'000.0}}) {
        all[id] = {[id = id, place = place](Trial& t) {
                       t.say(id);
                       t.run(2s);
                       t.is(t.position(), place, "what the run mode has for this edge");
                   },
                   {{"trig_rise", "30000"}, {"trig_fall", "-20000"}}};
    }
}

void stream_cases(EffectCases& all) {
    for (const char* id : {"030xh", "031xh", "032xh"}) {
        all[id] = {[id](Trial& t) {
            t.motion("002xh", {0x14E6, 4});
            const bool own_period = id[2] == '2';
            // 0.4 mm every 4 ms; 032xh takes its period from 14E6h, independent of the intervals of the first set-points.
            for (int i = 1; i <= 20; ++i) {
                t.say(id, {i * 4000, id[2] == '1' ? 200'000 : 0});
                t.run(own_period && i == 1 ? 6ms : 4ms);
            }
            t.is(t.state(), 8, "no error");
            t.is(t.position(), 80'000 - 2000, "1.5 periods behind", 2500);
            // 031xh passes its set-points with their velocity (here twice that of the way), the others move at constant speed.
            double least = 1e9, most = 0;
            for (int i = 0; i < 16; ++i) {
                t.run(std::chrono::microseconds(250));
                const double v = std::fabs(t.drive().mechanics().velocity);
                if (v == 0) continue;
                least = std::min(least, v);
                most = std::max(most, v);
            }
            t.is(most / least, id[2] == '1' ? 4 : 1, "how the velocity runs between two set-points", id[2] == '1' ? 2 : 0.01);
        }};
    }
    all["03Fxh"] = {[](Trial& t) {
        for (int i = 1; i <= 10; ++i) {
            t.motion("030xh", {i * 3000});
            t.run(3ms);
        }
        t.say("03Fxh");
        t.run(100ms);
        t.is(t.state(), 8, "no set-point is missed");
        t.is(t.sub() & 0x20, 0, "it stands");
    }};
}

void curve_cases(EffectCases& all) {
    struct Row {
        const char* id;
        Numbers values;  ///< behind the curve's number
        double middle, end;
        int edge;  ///< 1 rising, -1 falling, 0 none
    };
    // The curve: 10 mm in 0.5 s, half of it in half the time; started at 2 mm. Checked after 0.25 s and at the end.
    for (const Row& r :
         {Row{"040xh", {}, 50'000, 100'000, 0}, Row{"041xh", {}, 70'000, 120'000, 0}, Row{"042xh", {220'000}, 120'000, 220'000, 0},
          Row{"043xh", {220'000, 100'000}, 70'000, 220'000, 0}, Row{"044xh", {5000, 20'000, 500}, 5000 + 12'500, 55'000, 0},
          Row{"045xh", {5000, 100'000, 500}, 5000 + 12'500, 55'000, 0}, Row{"046xh", {5000, 100'000, 500}, 5000 + 12'500, 55'000, 1},
          Row{"047xh", {5000, 100'000, 500}, 5000 + 12'500, 55'000, -1}, Row{"04Axh", {220'000}, 120'000, 220'000, 1},
          Row{"04Cxh", {220'000}, 120'000, 220'000, -1}, Row{"04Exh", {220'000, 100'000}, 70'000, 220'000, 1},
          Row{"04Fxh", {220'000, 100'000}, 70'000, 220'000, -1}}) {
        all[r.id] = {[r](Trial& t) {
            t.draw(3, {0, 25'000, 50'000, 100'000 - 25'000, 100'000}, 50'000);
            t.to(20'000);
            Numbers v{3};
            v.insert(v.end(), r.values.begin(), r.values.end());
            t.say(r.id, v);
            if (r.edge != 0) {
                t.run(100ms);
                t.is(t.position(), 20'000, "armed");
                t.edge(r.edge < 0);
                if (r.edge > 0) t.edge(true);
                t.is(t.position(), 20'000, "the other edge", 1e9);
                if (r.edge < 0) t.edge(false);
            }
            t.run(250ms);
            t.is(t.position(), r.middle, "after a quarter of a second", 200);
            t.run(2s);
            t.is(t.position(), r.end, "at its end");
        }};
    }
    all["050xh"] = {[](Trial& t) {
        t.draw(3, {0, 1}, 100);
        t.say("050xh", {3, 0x0FFF});
        t.is(static_cast<double>(t.drive().curves.count(3)), 0, "0FFFh: not defined");
    }};
    for (const auto& [id, value, length] : {std::tuple{"051xh", 5000, 5000.0}, {"052xh", 200'000, 200'000.0}}) {
        all[id] = {[id = id, value = value, length = length](Trial& t) {
            t.draw(3, {0, 1}, 100);
            t.say(id, {3, 32, value});
            t.is(t.drive().curves[3].x_length(), length, "the x length of the info block");
        }};
    }
    for (const auto& [id, n] : {std::pair{"054xh", 1}, {"055xh", 2}, {"056xh", 3}}) {
        all[id] = {[id = id, n = n](Trial& t) {
            t.draw(3, {0, 1, 2, 3, 4}, 100);
            t.say(id, {3, 4, 500, 600, 700});
            const auto& c = t.drive().curves[3];
            for (int i = 0; i < 4; ++i)
                t.is(c.point(static_cast<std::size_t>(i + 1)), i < n ? 500 + 100 * i : i + 1, "a point");
        }};
    }
}

void encoder_cases(EffectCases& all) {
    struct Row {
        const char* id;
        Numbers values;  ///< behind curve and delay
        std::int64_t count;
        double place;
        int edge;
    };
    for (const Row& r : {Row{"064xh", {}, 600, 5000, 0}, Row{"069xh", {}, 600, 5000, 1}, Row{"06Axh", {40'000, 500}, 350, 30'000, 1},
                         Row{"06Bxh", {}, 600, 5000, -1}, Row{"06Cxh", {40'000, 500}, 350, 30'000, -1},
                         Row{"06Dxh", {2000, 500}, 350, 10'000, 1}, Row{"06Exh", {2000, 500}, 350, 10'000, -1}}) {
        all[r.id] = {[r](Trial& t) {
            t.draw(1, {0, 10'000}, 1000);
            t.to(20'000);
            Numbers v{1, 100};
            v.insert(v.end(), r.values.begin(), r.values.end());
            t.say(r.id, v);
            if (r.edge != 0) t.edge(r.edge > 0);
            t.turn_to(99);
            t.is(t.position(), 20'000, "the delay");
            t.turn_to(r.count);
            t.is(t.position(), r.place, "where the count leads");
        }};
    }
    for (const char* id : {"070xh", "071xh"}) {
        all[id] = {[id](Trial& t) {
            t.say(id, {20'000, quick, steep, steep});
            t.run(3s);
            t.is(t.position(), 20'000, "to the position");
            t.turn_to(3000);
            t.run(1s);
            t.is(t.position(), 23'000, "and on with the encoder");
        }};
    }
    for (const char* id : {"07Exh", "07Fxh"}) {
        all[id] = {[id](Trial& t) {
            t.motion("070xh", {20'000, quick, steep, steep});
            t.run(1s);
            t.say(id, {5000, quick, steep, steep});
            t.run(3s);
            t.turn_to(3000);
            t.run(1s);
            t.is(t.position(), 5000, "the encoder has no say any more");
        }};
    }
    all["100xh"] = {[](Trial& t) {
        t.draw(1, {0, 10'000}, 1000);
        t.motion("110xh", {1, 0});
        t.say("100xh");
        t.turn_to(500);
        t.is(t.position(), 5000, "coupled");
    }};
    all["101xh"] = {[](Trial& t) {
        t.draw(1, {0, 10'000}, 1000);
        t.motion("110xh", {1, 0});
        t.motion("100xh");
        t.turn_to(500);
        t.say("101xh");
        t.turn_to(800);
        t.is(t.position(), 5000, "uncoupled");
    }};
    all["102xh"] = {[](Trial& t) {
        t.draw(1, {0, 10'000}, 1000);
        t.motion("110xh", {1, 0});
        t.turn_to(500);
        t.say("102xh");
        t.run(2s);
        t.is(t.position(), 5000, "at the place of the present count");
    }};
    all["104xh"] = {[](Trial& t) {
        t.turn_to(500);
        t.say("104xh", {40});
        t.is(t.drive().master(), 40, "the count");
    }};
}

/// Both cams by the same cases.
void cam_cases(EffectCases& all, char cam) {
    const auto id = [cam](char sub) { return fmt::format("1{}{}xh", cam, sub); };
    struct Row {
        char sub;
        Numbers values;  ///< behind curve and start
        std::int64_t count;
        double place;
    };
    for (const Row& r :
         {Row{'0', {}, 600, 5000}, Row{'1', {}, 600, 25'000}, Row{'2', {40'000}, 600, 30'000}, Row{'3', {10'000, 34'000, 500}, 350, 22'000},
          Row{'4', {40'000, 500}, 350, 30'000}, Row{'5', {2000, 500}, 350, 10'000}}) {
        all[id(r.sub)] = {[r, name = id(r.sub)](Trial& t) {
            t.draw(1, {0, 10'000}, 1000);
            t.to(20'000);
            Numbers v{1, 100};
            v.insert(v.end(), r.values.begin(), r.values.end());
            t.say(name, v);
            t.motion("100xh");
            t.turn_to(r.count);
            t.is(t.position(), r.place, "where the count leads");
        }};
    }
    for (const char sub : {'6', '7'}) {
        all[id(sub)] = {[sub, name = id(sub), define = id('0'), disable = id('7')](Trial& t) {
            t.draw(1, {0, 10'000}, 1000);
            t.motion(define, {1, 0});
            t.motion("100xh");
            t.turn_to(500);
            if (sub == '6') t.motion(disable);
            t.say(name);
            t.turn_to(800);
            t.is(t.position(), sub == '6' ? 8000 : 5000, sub == '6' ? "it leads again" : "it leads no more");
        }};
    }
    all[id('8')] = {[name = id('8'), define = id('0')](Trial& t) {
        t.motion("002xh", {0x1527, 1});
        t.draw(1, {0, 10'000, 0}, 1000);
        t.motion(define, {1, 0});
        t.motion("100xh");
        t.turn_to(500);
        t.say(name, {500, 1000});
        t.is(t.position(), 10'000, "not yet");
        t.turn_to(1500);
        t.is(t.position(), 5000, "from its next start on");
    }};
}

void winding_cases(EffectCases& all) {
    for (const auto& [id, curve, later] :
         {std::tuple{"300xh", false, false}, {"301xh", false, true}, {"310xh", true, false}, {"311xh", true, true}}) {
        all[id] = {[id = id, curve = curve, later = later](Trial& t) {
                       t.motion("002xh", {0x1291, 1000});
                       t.draw(7, {0, 0, 100}, 1000);
                       Numbers v;
                       if (curve) v.push_back(7);
                       if (later) v.push_back(2);
                       t.say(id, v);
                       const std::int64_t begin = later ? 2000 : 0;
                       t.turn_to(begin);
                       t.is(t.position(), 0, "at its beginning");
                       t.turn_to(begin + 750);
                       t.is(t.position(), curve ? 20'000 : 30'000, "three quarters of a stroke, straight or by the curve");
                   },
                   {{"winding", "0,40000,0,40000,1000,1000,100,0,0"}}};
    }
    for (const char* id : {"304xh", "305xh"}) {
        all[id] = {[id](Trial& t) {
                       const bool on = id[2] == '5';
                       t.motion("002xh", {0x1291, 1000});
                       t.motion("300xh");
                       t.turn_to(1000);
                       if (on) t.motion("304xh");
                       t.turn_to(on ? 2000 : 1000);
                       t.say(id);
                       t.turn_to(2000);
                       t.is(t.position(), 5000, "left has come a quarter of its way");
                       t.turn_to(4000);
                       t.is(t.position(), on ? 15'000 : 5000, on ? "it goes on" : "it stays");
                   },
                   {{"winding", "0,40000,20000,20000,1000,1000,4,0,0"}}};
    }
}

void force_cases(EffectCases& all) {
    for (const auto& [id, higher, own] :
         {std::tuple{"380xh", true, false}, {"383xh", true, true}, {"384xh", false, false}, {"385xh", false, true}}) {
        all[id] = {[id = id, higher = higher, own = own](Trial& t) {
            (void)t.hand("force", Value{std::int64_t{higher ? 40 : 60}});
            t.say(id, {500'000, quick / 10, steep, 50, 80});
            t.run(100ms);
            t.is(t.drive().held_force().value_or(-1), -1, "the position is controlled");
            (void)t.hand("force", Value{std::int64_t{50}});
            const double here = t.position();
            t.is(here, 100'000, "on its way", 10'000);
            t.run(1s);
            t.is(t.position(), here, "it goes no further");
            t.is(t.drive().held_force().value_or(-1), own ? 80 : 50, "the force that is held");
        }};
    }
    all["381xh"] = {[](Trial& t) {
        (void)t.hand("force", Value{std::int64_t{60}});
        t.motion("380xh", {500'000, quick / 10, steep, 50});
        t.is(t.drive().held_force().value_or(-1), 50, "in force control");
        t.say("381xh", {20'000, quick, steep, steep});
        t.run(2s);
        t.is(t.position(), 20'000, "the position is controlled again");
        t.is(t.drive().held_force().value_or(-1), -1, "and no force");
    }};
    all["382xh"] = {[](Trial& t) {
        (void)t.hand("force", Value{std::int64_t{60}});
        t.motion("380xh", {500'000, quick / 10, steep, 50});
        t.say("382xh", {90});
        t.is(t.drive().held_force().value_or(-1), 90, "the force that is held");
    }};
}

const EffectCases& effect_cases() {
    static const EffectCases all = [] {
        EffectCases c;
        general_cases(c);
        stream_cases(c);
        curve_cases(c);
        encoder_cases(c);
        cam_cases(c, '1');
        cam_cases(c, '2');
        winding_cases(c);
        add_table_effects(c);
        force_cases(c);
        return c;
    }();
    return all;
}

/// The first unexpected result; empty: none.
std::string trial(const EffectCase& c, const std::string& left_out) {
    Trial t(c.options, left_out);
    t.enable();
    c.run(t);
    return t.fault;
}

TEST(LinmotEffects, EveryCommandOfTheCatalogueHasItsEffect) {
    std::size_t by_rule = 0, by_case = 0;
    for (const auto& command : page().commands()) {
        if (command.id.size() != 5 || !command.id.ends_with("xh")) continue;
        SCOPED_TRACE(command.id + " " + command.name);
        const int master = std::stoi(command.id.substr(0, 2), nullptr, 16);
        if (master == 1 || master == 2 || (master >= 9 && master <= 12)) {
            ++by_rule;  // these are counted and tested by EveryInterpolatorCommandByTheRuleOfItsSubId
            continue;
        }
        if (command.id == "000xh") {  // its only effect is its count
            Trial t({});
            t.enable();
            t.motion("000xh");
            EXPECT_EQ(t.sub() & 15, t.count);
            ++by_case;
            continue;
        }
        const auto it = effect_cases().find(command.id);
        if (it == effect_cases().end()) {
            ADD_FAILURE() << "no case shows what it does";
            continue;
        }
        EXPECT_EQ(trial(it->second, {}), "");
        EXPECT_NE(trial(it->second, command.id), "") << "its case does not notice that the command is missing";
        ++by_case;
    }
    EXPECT_EQ(by_rule, 80u);
    EXPECT_EQ(by_case, 136u);
}

}  // namespace
}  // namespace axisgate::linmot::test
