// Laws of motions, for each family, way of commanding and hazard: nothing moves without an owner or an end, a refusal changes nothing,
// after a stop nothing moves without a fresh edge, reports agree with the motion, no motion passes a limit. One test per cell, judged by
// the twin's mechanics. A way that a drive lacks is tried all the same, and nothing may move by it.
#include <gtest/gtest.h>

#include <set>

#include "gateway/axis/cia402.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "gateway/site/ways_in.hpp"
#include "tests/conformance/ways.hpp"

namespace axisgate::test {
namespace {
namespace json = boost::json;
using namespace std::chrono_literals;

class Motions;
struct Hazard {
    std::string_view name;
    void (Motions::*play)();
};
struct Cell {
    Subject subject;
    const WayKind* way;
    const Hazard* hazard;
    friend void PrintTo(const Cell& c, std::ostream* out) { *out << c.subject.text() << " " << c.way->name << " " << c.hazard->name; }
};

class Motions : public testing::TestWithParam<Cell> {
public:
    // Each hazard occurs while the motion runs.
    void limit();
    void client_lost();
    void refused_words_of_another();
    void accepted_words_of_another();
    void lease_taken_by_another();
    void quick_stop_by_another();
    void halt_by_another();
    void stop_at_every_instant();
    void order_behind_a_stop();
    void crowd_of_halts();
    void gateway_restart();
    void line_lost();
    void tighter_limit();
    void other_unit();
    void axis_removed();
    void twin_and_device();
    void safe_input();
    void ends_of_numbers();

    const Subject& e = GetParam().subject;
    std::unique_ptr<Way> way = GetParam().way->make();
    std::shared_ptr<Plant> plant = std::make_shared<Plant>();
    std::unique_ptr<Bench> b;
    const Origin bert{http::clients, std::make_shared<const std::string>("bert"), {}};
    static constexpr std::int64_t wide = 1'000'000;  ///< limits in units that are never reached here
    static constexpr Duration watchdog = 400ms, tick = 10ms;

    // --- data of the judge
    DriveId drive{0};
    bool behind_a_cable = false;
    double farthest = 0, nearest = 0, fastest = 0;  ///< of the shaft, since the cell began or from_here()
    Duration unsaid{}, unrecorded{}, unowned{};

    [[nodiscard]] TwinMechanics shaft() const {
        const Twin* t = behind_a_cable ? plant->buses.at("line")->twin(drive) : b->world.engine.twin(b->site->drive_ids.at(0));
        return t ? t->mechanics(1, b->world.now) : TwinMechanics{};
    }
    /// The report agrees with the motion: an axis that turns and answers is reported as moving, and not in a state without power.
    void judge() {
        const TwinMechanics m = shaft();
        farthest = std::max(farthest, m.position);
        nearest = std::min(nearest, m.position);
        fastest = std::max(fastest, std::fabs(m.velocity));
        const AxisPicture p = b->picture();
        const bool heard = (p.flags & (flag_online | flag_stale)) == flag_online;
        const bool said = (p.flags & flag_moving) != 0;
        unsaid = heard && !said && std::fabs(m.velocity) > 200 ? unsaid + tick : Duration{};
        EXPECT_LT(unsaid, 1s) << "it turns at " << m.velocity << " and is said to stand";
        records(heard && std::fabs(m.velocity) > 200);
    }
    /// Nothing moves without a record; and a record has an owner, or belongs to a motion without an owner, which the site's rule ends.
    void records(bool turns) {
        const engine::Axis* a = b->world.engine.parts().machine.axis(b->axis);
        if (!a) return;
        const engine::Motion& r = a->motion;
        unrecorded = turns && !r.runs() && !a->asked.runs() ? unrecorded + tick : Duration{};
        EXPECT_LT(unrecorded, 1s) << "it turns, and no record has it" << told();
        unowned = r.runs() && r.kind != engine::Motion::Kind::found && r.who.door == Door::none && r.keeper.door == Door::none && !r.over
                      ? unowned + tick
                      : Duration{};
        EXPECT_LT(unowned, 1s) << "a motion of kind " << static_cast<int>(r.kind) << " that was ordered has no owner" << told();
    }
    void from_here() { farthest = nearest = shaft().position; }
    /// Lets time pass while the client acts in each of its cycles.
    void pass(Duration time) {
        for (const Instant end = b->world.now + time; b->world.now < end;) {
            way->cycle(*b);
            b->run(std::min<Duration>(tick, end - b->world.now));
            judge();
        }
    }
    bool pass_until(const std::function<bool()>& condition, Duration limit) {
        for (const Instant end = b->world.now + limit; !condition();) {
            if (b->world.now >= end) return false;
            pass(tick);
        }
        return true;
    }
    bool turns(Duration limit = 5s) {
        return pass_until([&] { return std::fabs(shaft().velocity) > 800; }, limit);
    }
    bool stands(Duration limit) {
        return pass_until([&] { return std::fabs(shaft().velocity) < 1; }, limit);
    }
    /// It comes to rest, and stays there while its client continues with the same words.
    void rests_and_stays(Duration limit, const std::string& why) {
        ASSERT_TRUE(stands(limit)) << why << ": it goes on at " << shaft().velocity << ", at " << shaft().position;
        pass(300ms);
        const double place = shaft().position;
        pass(1200ms);
        EXPECT_LT(std::fabs(shaft().position - place), 60) << why << ": it has moved on without a fresh edge" << told();
    }

    [[nodiscard]] Site site_of(Bench& of, bool cable, std::string_view presence = "device") const {
        Site s = cable ? of.world.make_site(e, e.cable(), 1, presence) : of.world.twins(e);
        way->fit(s, e);
        AxisSpec& a = s.axes.at(0);
        a.position_min = -wide;
        a.position_max = wide;
        a.fail_safe.watchdog_ms = milliseconds_of(watchdog);
        // A motion to a target continues when its client is gone unless the site says otherwise: here it does, for every cause.
        if (!way->endless()) {
            for (const LossCause cause : loss_causes())
                a.fail_safe.of(cause) = FailSafeAction::quick_stop;
        }
        return s;
    }
    void put(Site s) {
        b->world.engine.set_lease(1s);
        b->use(b->world.apply(std::move(s)));
    }
    /// A gateway with one axis, online.
    void begin(const std::function<void(Site&)>& change = {}, bool cable = false, std::string_view presence = "device") {
        behind_a_cable = cable || way->unowned();
        way = GetParam().way->make();
        plant = std::make_shared<Plant>();
        b = std::make_unique<Bench>(e, 1, plant);
        Site s = site_of(*b, behind_a_cable, presence);
        if (change) change(s);
        put(s);
        if (behind_a_cable) b->world.plug_in("line", drive, e, addresses(e, 1).at(0), e.kind());
        ASSERT_TRUE(b->until([&] { return (b->picture().flags & flag_online) && b->picture().ever_seen; }, 60s));
        b->run(500ms);
        b->meanwhile = [this] { way->cycle(*b); };
        from_here();
        fastest = 0;
    }
    /// Returns false if the way does not exist, which was checked; the cell is finished then.
    [[nodiscard]] bool running() {
        std::string why;
        if (!way->offered(e, why)) {
            lacking(why);
            return false;
        }
        EXPECT_TRUE(way->prepare(*b)) << "the axis is not ready: " << way->refusal(*b) << ", status word " << std::hex
                                      << b->picture().statusword;
        if (HasFailure()) return false;
        way->set_off(*b);
        EXPECT_TRUE(turns()) << "it does not move: " << way->refusal(*b);
        if (HasFailure()) return false;
        if (!way->unowned()) return true;
        next_gateway();
        return !HasFailure();
    }
    void lacking(const std::string& why) {
        EXPECT_FALSE(why.empty()) << "what a drive lacks has a reason";
        (void)way->prepare(*b);
        way->set_off(*b);
        pass(500ms);
        EXPECT_NE(way->refusal(*b), "") << "it is not said that it cannot be done";
        EXPECT_EQ(fastest, 0) << "and yet it has moved";
    }
    /// The gateway is killed; the next one starts with the same drives.
    void next_gateway(Duration after = 300ms) {
        const Instant at = b->world.now + after;
        auto next = std::make_unique<Bench>(e, 2, plant);
        next->world.now = at;
        next->meanwhile = b->meanwhile;
        b = std::move(next);
        put(site_of(*b, true));
        EXPECT_TRUE(b->until([&] { return (b->picture().flags & flag_online) != 0; }, 15s)) << "the next gateway does not hear the drive";
    }
    /// The actions of its client when it is lost, and the time that the gateway may need to notice.
    void ends_with_its_client(LossCause cause) {
        way->lose(*b, cause);
        rests_and_stays(6s, "its client is lost (" + std::string(name_of(cause)) + ")");
        if (cause != LossCause::none) EXPECT_EQ(b->picture().fail_safe_cause, static_cast<std::uint16_t>(cause));
    }
    void moves_again(const std::string& why) {
        way->silent = false;
        ASSERT_TRUE(way->again(*b)) << why << ": " << way->refusal(*b) << ", status word " << std::hex << b->picture().statusword << told();
        EXPECT_TRUE(turns()) << why << ": a fresh edge does not move it: " << way->refusal(*b) << told();
    }
    /// The last reports of the gateway, for people.
    [[nodiscard]] std::string told() const {
        std::string all;
        const auto& list = b->world.events;
        for (std::size_t i = list.size() > 6 ? list.size() - 6 : 0; i < list.size(); ++i)
            all += "\n    " + list[i].kind + ": " + list[i].text;
        return all;
    }
    [[nodiscard]] std::ptrdiff_t events(std::string_view kind) const {
        return std::ranges::count_if(b->world.events, [&](const Event& v) { return v.kind == kind; });
    }
    /// Another client's stop; an answer comes, and it is not a refusal.
    void another_stops(CommandBody stop) {
        const Result* r = b->ask(std::move(stop), bert, 5s);
        ASSERT_TRUE(r) << "a stop has an answer";
        EXPECT_TRUE(good(*r)) << "a stop is not refused: " << r->text;
    }
};

// --- hazards ----------------------------------------------------------------------------------------------------------

void Motions::limit() {
    constexpr std::int64_t most = 10'000;
    begin([&](Site& s) {
        s.axes.at(0).position_min = -100;
        s.axes.at(0).position_max = 100;
    });
    std::string why;
    if (!way->offered(e, why)) return lacking(why);
    ASSERT_TRUE(way->prepare(*b)) << way->refusal(*b);
    way->set_off(*b);
    const bool went = turns(2s);
    if (way->endless()) {
        EXPECT_TRUE(went) << way->refusal(*b);
    } else {
        EXPECT_NE(way->refusal(*b), "") << "a place beyond the limit is refused";
    }
    if (way->unowned()) {
        const auto narrow = [&](Site s) {
            s.axes.at(0).position_min = -100;
            s.axes.at(0).position_max = 100;
            s.axes.at(0).fail_safe.of(LossCause::motion_unowned) = FailSafeAction::nothing;
            return s;
        };
        const Instant at = b->world.now + 300ms;
        auto next = std::make_unique<Bench>(e, 2, plant);
        next->world.now = at;
        next->meanwhile = b->meanwhile;
        b = std::move(next);
        put(narrow(site_of(*b, true)));
    }
    pass(8s);
    EXPECT_LE(farthest, most + 300) << "beyond its limit";
    EXPECT_LT(std::fabs(shaft().velocity), 1) << "and it is at rest there";
}

void Motions::client_lost() {
    for (const LossCause cause : way->losses()) {
        SCOPED_TRACE(name_of(cause));
        begin();
        if (!running()) return;
        ends_with_its_client(cause);
        if (HasFailure() || way->unowned()) return;
        if (cause != LossCause::none) EXPECT_EQ(events("fail_safe"), 1) << "told once";
        moves_again("after the fail-safe");
        if (HasFailure()) return;
        ends_with_its_client(cause);
    }
}

void Motions::refused_words_of_another() {
    begin();
    if (!running()) return;
    if (way->unowned()) return rests_and_stays(8s, "nobody owns it");
    Move beyond;
    beyond.target = 200 * wide;
    Move prepared = beyond;
    prepared.prepare_only = true;
    Home home;
    home.method = 99;
    ProcessData word;
    word.mode = 99;
    for (const CommandBody& body : {CommandBody{home}, CommandBody{beyond}, CommandBody{prepared}, CommandBody{SetPosition{5}},
                                    CommandBody{Action{"no such action", "", {}}}, CommandBody{word}}) {
        const Result* r = b->ask(body, bert);
        ASSERT_TRUE(r);
        EXPECT_FALSE(good(*r)) << name_of(body) << " is taken";
        pass(30ms);
    }
    pass(200ms);
    EXPECT_GT(std::fabs(shaft().velocity), 500) << "a refusal changes nothing";
    if (way->takes_speeds()) {
        way->set_off_to(*b, Way::speed / 2);
        const auto followed = [&] { return std::fabs(shaft().velocity - Way::speed / 2.0) < Way::speed / 8.0; };
        (void)pass_until(followed, 5s);
        pass(1s);  // some drives stop first
        EXPECT_TRUE(followed()) << "its client's next speed is not followed: it turns at " << shaft().velocity << told();
    }
    ends_with_its_client(way->losses().front());
}

void Motions::accepted_words_of_another() {
    begin();
    if (!running()) return;
    if (way->unowned()) return rests_and_stays(8s, "nobody owns it");
    const auto& list = e.catalogue->parameters();
    int asked = 0;
    for (std::size_t i = 0; i < list.size() && asked < 3; ++i) {
        if (list[i].count) continue;
        ReadParameter read;
        read.point = Point{static_cast<std::uint16_t>(i), 0};
        (void)b->ask(read, bert);
        ++asked;
    }
    (void)b->ask(ResetFault{}, bert);
    HoldAxis release;
    release.kind = HoldAxis::Kind::release;
    (void)b->ask(release, bert);
    pass(300ms);
    EXPECT_GT(std::fabs(shaft().velocity), 500) << "questions change nothing";
    ends_with_its_client(way->losses().front());
}

void Motions::lease_taken_by_another() {
    begin();
    if (!running()) return;
    if (way->unowned()) return rests_and_stays(8s, "nobody owns it");
    HoldAxis take;
    take.lease_s = 1;
    take.take_over = true;
    (void)b->ask(take, bert);
    pass(200ms);
    way->lose(*b, way->losses().front());  // a lease: that of the client that has taken the axis over ends now
    rests_and_stays(6s, "whose motion it is has gone, whoever holds the axis");
}

void Motions::quick_stop_by_another() {
    begin();
    if (!running()) return;
    another_stops(QuickStop{});
    rests_and_stays(5s, "another has stopped it");
    if (HasFailure()) return;
    EXPECT_NE(b->picture().stop_latch & 1, 0) << "register 23 says that it waits for a fresh edge";
    if (way->unowned()) return;
    moves_again("after a quick stop");
}

void Motions::halt_by_another() {
    begin();
    if (!running()) return;
    another_stops(Halt{});
    rests_and_stays(5s, "another has halted it");
    if (HasFailure() || way->unowned()) return;
    moves_again("after a halt");
}

void Motions::stop_at_every_instant() {
    begin();
    std::string why;
    if (!way->offered(e, why)) return lacking(why);
    for (const Duration after : {0ms, 1ms, 3ms, 10ms, 30ms, 100ms}) {
        SCOPED_TRACE(std::to_string(milliseconds_of(after)) + " ms behind the order, or behind the first sight of it");
        if (way->unowned()) {
            begin();
            ASSERT_TRUE(running());
        } else {
            ASSERT_TRUE(way->prepare(*b)) << way->refusal(*b);
            way->set_off(*b);
        }
        if (after > Duration{}) b->run(after);
        another_stops(QuickStop{});
        rests_and_stays(3s, "stopped");
        if (HasFailure()) return;
    }
    if (!way->unowned()) moves_again("after all of them");
}

void Motions::order_behind_a_stop() {
    begin();
    std::string why;
    if (!way->offered(e, why)) return lacking(why);
    if (way->unowned()) {
        // It is stopped; an order behind that stop belongs to a client of this gateway.
        ASSERT_TRUE(running());
        const Ticket stop = b->give(QuickStop{}, bert);
        const Result* r = b->ask(Home{}, way->origin());
        ASSERT_TRUE(r);
        EXPECT_FALSE(good(*r)) << "behind a quick stop that is on its way nothing begins";
        rests_and_stays(5s, "stopped");
        r = b->world.result(stop);
        EXPECT_TRUE(r && good(*r)) << "the stop has an answer";
        return;
    }
    ASSERT_TRUE(way->prepare(*b)) << way->refusal(*b);
    b->run(200ms);
    const Ticket stop = b->give(QuickStop{}, bert);
    way->set_off(*b);
    pass(2s);
    const Result* r = b->world.result(stop);
    ASSERT_TRUE(r && good(*r)) << "the stop has an answer";
    EXPECT_LT(fastest, 200) << "behind a quick stop that is on its way nothing begins";
    moves_again("when the stop is over");
}

void Motions::crowd_of_halts() {
    begin();
    if (!running()) return;
    for (int i = 0; i < 300; ++i)
        (void)b->give(Halt{}, {http::clients, std::make_shared<const std::string>("viewer " + std::to_string(i)), {}});
    another_stops(QuickStop{});
    rests_and_stays(5s, "stopped among 300 halts");
    EXPECT_NE(power_state_of(b->picture().statusword), PowerState::operation_enabled) << "the quick stop is the one that counts";
}

void Motions::gateway_restart() {
    begin({}, true);
    if (!running()) return;
    if (!way->unowned()) {
        next_gateway();
        if (HasFailure()) return;
        way->returned(*b);  // with its former image, which it sends in each cycle
        if (!way->endless()) another_stops(QuickStop{});
    }
    rests_and_stays(15s, "the gateway that had ordered it is gone");
    if (HasFailure() || way->unowned()) return;
    moves_again("by the next gateway");
}

void Motions::line_lost() {
    begin([](Site& s) { s.axes.at(0).fail_safe.of(LossCause::line_lost) = FailSafeAction::quick_stop; }, true, "auto");
    if (!running()) return;
    auto* cable = b->world.cables.at("line");
    cable->cut(b->world.now);
    pass(4s);
    cable->heal(b->world.now);
    ASSERT_TRUE(pass_until([&] { return (b->picture().flags & (flag_online | flag_simulated)) == flag_online; }, 30s))
        << "the drive is not found again";
    rests_and_stays(8s, "the line was away");
    if (HasFailure() || way->unowned()) return;
    moves_again("when the line is back");
}

void Motions::tighter_limit() {
    begin();
    if (!running()) return;
    if (way->unowned()) return rests_and_stays(8s, "nobody owns it");
    const double here = shaft().position;
    Site s = b->site->site;
    s.axes.at(0).position_max = std::ceil(here / 100) + 60;
    s.axes.at(0).position_min = std::floor(here / 100) - 60;
    const double most = *s.axes.at(0).position_max * 100;
    b->use(b->world.change(std::move(s)));
    pass(6s);
    EXPECT_LE(farthest, most + 300) << "the limit reaches the motion that runs";
    EXPECT_LT(std::fabs(shaft().velocity), 1);
}

void Motions::other_unit() {
    begin();
    if (!running()) return;
    Site s = b->site->site;
    s.axes.at(0).increments_per_unit = 50;
    b->use(b->world.change(std::move(s)));
    pass(300ms);
    if (way->unowned()) return rests_and_stays(8s, "nobody owns it");
    way->lose(*b, way->losses().front());
    rests_and_stays(6s, "its client is lost behind a change of the unit");
}

void Motions::axis_removed() {
    begin();
    if (!running()) return;
    Site s = b->site->site;
    s.axes.clear();
    s.profiles.clear();
    s.mappings = nullptr;
    const auto bus = b->world.change(std::move(s));
    (void)bus;
    if (behind_a_cable) {
        EXPECT_TRUE(b->until([&] { return std::fabs(shaft().velocity) < 1; }, 6s)) << "what nobody can reach any more goes on";
    } else {
        const Twin* t = b->world.engine.twin(b->site->drive_ids.at(0));
        if (t) EXPECT_LT(std::fabs(t->mechanics(1, b->world.now).velocity), 1) << "what nobody can reach any more goes on";
    }
}

/// The twin replaces the drive, and the drive returns: neither continues the motion of the other.
void Motions::twin_and_device() {
    begin({}, true);
    if (!running()) return;
    const auto served_by = [&](PresenceRule rule, std::uint16_t simulated) {
        Site s = b->site->site;
        s.drives.at(0).presence = rule;
        b->use(b->world.change(std::move(s)));
        EXPECT_LT(std::fabs(shaft().velocity), 1) << "the drive is let go, or taken, while it turns";
        ASSERT_TRUE(pass_until([&] { return (b->picture().flags & (flag_online | flag_simulated)) == (flag_online | simulated); }, 30s));
        pass(2s);
    };
    served_by(PresenceRule::twin, flag_simulated);
    if (HasFatalFailure()) return;
    EXPECT_LT(std::fabs(b->world.engine.twin(b->site->drive_ids.at(0))->mechanics(1, b->world.now).velocity), 1)
        << "the words that moved the drive move the twin" << told();
    rests_and_stays(1s, "the twin has taken its place");
    served_by(PresenceRule::device, 0);
    if (HasFatalFailure()) return;
    rests_and_stays(1s, "it is there again");
    if (HasFailure() || way->unowned()) return;
    moves_again("by the drive again");
}

void Motions::safe_input() {
    const json::object& input = facts_of(e).at("safe_input").as_object();
    begin();
    if (const auto* before = input.if_contains("before")) {  // a setting of the drive makes this input a safe one
        const std::string_view line = before->as_object().at("send").as_string();
        const Result* r = b->ask(Native{{line.begin(), line.end()}, true}, bert);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no answer");
        b->run(1500ms);
    }
    if (!running()) return;
    if (const auto* lacks = input.if_contains("lacks")) {
        EXPECT_FALSE(lacks->as_string().empty());
        EXPECT_TRUE(e.catalogue->document().at("safe_inputs").as_array().empty())
            << "its page names safe inputs: one of them is tried here";
        way->lose(*b, way->losses().front());
        return rests_and_stays(8s, "its client is lost where there is no such input");
    }
    const auto hand = [&](const char* which) {
        const json::object& h = input.at(which).as_object();
        Twin* t = behind_a_cable ? plant->buses.at("line")->twin(drive) : nullptr;
        const Value v = h.at("value").is_bool() ? Value{h.at("value").as_bool()} : Value{h.at("value").as_int64()};
        const std::string name(h.at("hand").as_string());
        if (!t) {
            EXPECT_EQ(b->world.engine.set_hand(b->site->drive_ids.at(0), {{name, v}}, {}, b->world.now), "");
            return;
        }
        Out out;
        EXPECT_EQ(t->set_hand(name, v, b->world.now, out), "");
    };
    hand("take");
    rests_and_stays(5s, "the input has taken its power or its motion");
    hand("give");
    rests_and_stays(1s, "the input was given back");
    if (HasFailure() || way->unowned()) return;
    moves_again("after the input");
}

void Motions::ends_of_numbers() {
    std::string why;
    begin();
    if (!way->offered(e, why)) return lacking(why);
    if (way->unowned()) {
        // The numbers are those of the site of the gateway that finds the axis: a unit and limits that no counter reaches.
        ASSERT_TRUE(running());
        Site s = b->site->site;
        s.axes.at(0).increments_per_unit = 1e12;
        s.axes.at(0).position_min = -1e300;
        s.axes.at(0).position_max = 1e300;
        b->use(b->world.change(std::move(s)));
        return rests_and_stays(8s, "nobody owns it");
    }
    for (const std::int64_t target : way->ends(e)) {
        SCOPED_TRACE(target);
        begin([](Site& s) {
            s.axes.at(0).position_min = -100;
            s.axes.at(0).position_max = 100;
            s.axes.at(0).velocity_max = 50;
        });
        ASSERT_TRUE(way->prepare(*b)) << way->refusal(*b);
        way->set_off_to(*b, target);
        pass(6s);
        EXPECT_LE(farthest, 10'300);
        EXPECT_GE(nearest, -10'300);
        EXPECT_LE(fastest, 5'600) << "beyond velocity_max";
        EXPECT_LT(std::fabs(shaft().velocity), 1);
    }
}

constexpr Hazard hazards[]{
    {"limit", &Motions::limit},
    {"client_lost", &Motions::client_lost},
    {"refused_words_of_another", &Motions::refused_words_of_another},
    {"accepted_words_of_another", &Motions::accepted_words_of_another},
    {"lease_taken_by_another", &Motions::lease_taken_by_another},
    {"quick_stop_by_another", &Motions::quick_stop_by_another},
    {"halt_by_another", &Motions::halt_by_another},
    {"stop_at_every_instant", &Motions::stop_at_every_instant},
    {"order_behind_a_stop", &Motions::order_behind_a_stop},
    {"crowd_of_halts", &Motions::crowd_of_halts},
    {"gateway_restart", &Motions::gateway_restart},
    {"line_lost", &Motions::line_lost},
    {"tighter_limit", &Motions::tighter_limit},
    {"other_unit", &Motions::other_unit},
    {"axis_removed", &Motions::axis_removed},
    {"twin_and_device", &Motions::twin_and_device},
    {"safe_input", &Motions::safe_input},
    {"ends_of_numbers", &Motions::ends_of_numbers},
};

/// One wire of each family; differences between wires have laws of their own.
std::vector<Cell> cells() {
    std::vector<Cell> all;
    for (const auto& entry : families().entries) {
        const Subject subject = wires_of(entry).front();
        for (const WayKind& way : ways_in()) {
            for (const Hazard& hazard : hazards)
                all.push_back({subject, &way, &hazard});
        }
    }
    return all;
}

/// From the doors' own descriptors: a way that they name and that is not tried here fails, and so does a cause by which no way is lost.
TEST(MotionCells, EachWayOfADoorIsTriedWithEachOfItsLosses) {
    ASSERT_EQ(known_doors().size(), 4U);
    for (const DoorWords* door : known_doors()) {
        for (const WayIn& of_door : door->ways) {
            std::set<LossCause> tried;
            for (const WayKind& kind : ways_in()) {
                if (kind.of_door != of_door.name) continue;
                const auto losses = kind.make()->losses();
                tried.insert(losses.begin(), losses.end());
            }
            if (of_door.name == "recipes") tried.insert(LossCause::lease_ended);  // its commands belong to its starter: "http"
            for (const LossCause cause : of_door.losses)
                EXPECT_TRUE(tried.contains(cause)) << of_door.name << " is not tried with " << name_of(cause);
        }
    }
}

TEST_P(Motions, Hold) { (this->*GetParam().hazard->play)(); }

INSTANTIATE_TEST_SUITE_P(Cells, Motions, testing::ValuesIn(cells()), [](const testing::TestParamInfo<Cell>& i) {
    return i.param.subject.text() + "_" + std::string(i.param.way->name) + "_" + std::string(i.param.hazard->name);
});

}  // namespace
}  // namespace axisgate::test
