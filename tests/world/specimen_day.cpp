#include "tests/world/specimen_day.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "gateway/axis/cia402.hpp"

namespace axisgate::test {
using namespace std::chrono_literals;
namespace {
std::string in_short(const Result* r) {
    return r ? std::string(name_of(r->outcome)) + " " + std::string(name_of(r->reason)) + ": " + r->text : "no result";
}
}  // namespace

Duration slowness_of(const Catalogue& family, const FreedomValues& values) {
    std::int64_t ms = 0;
    for (const Freedom& f : family.freedoms()) {
        if (f.unit == "ms") ms += freedom(values, f.name, f.fallback);
    }
    return std::chrono::milliseconds(ms);
}

void fit_line(Site& wanted, const FreedomValues& values) {
    const auto of = [&](std::string_view name) { return freedom(values, name); };
    constexpr std::int64_t longest_answer = 64;  // bytes
    const std::int64_t chunks = of("chunk_bytes") == 0 ? 0 : longest_answer / of("chunk_bytes");
    const std::int64_t late =
        of("reply_ms") + of("reply_spread_ms") + of("late_ms") + of("flash_silence_ms") + chunks * of("chunk_pause_ms");
    if (late > 50) wanted.lines.at(0).timing.reply_timeout = std::max<Duration>(600ms, std::chrono::milliseconds(late + 100));
}

bool told_as_not_served(const Subject& e, const FreedomValues& values, const std::vector<Event>& events) {
    namespace json = boost::json;
    std::ifstream file(std::string(AXISGATE_SOURCE_DIR "/adapters/") + std::string(e.family->name) + "/tests/facts.json");
    const json::object facts = json::parse(std::string(std::istreambuf_iterator<char>(file), {})).get_object();
    const auto* kinds = facts.if_contains("not_served");
    const bool known = kinds && std::ranges::any_of(kinds->get_array(), [&](const json::value& kind) {
                           return std::ranges::all_of(kind.get_object(), [&](const auto& f) {
                               return freedom(values, std::string_view(f.key())) == f.value().as_int64();
                           });
                       });
    return known &&
           std::ranges::any_of(events, [](const Event& v) { return v.kind == "not_served" && !v.text.empty() && !v.drive.empty(); });
}

TwinMechanics SpecimenDay::shaft() const {
    const Twin* twin = behind_a_cable ? plant->buses.at("line")->twin(DriveId{900}) : world->engine.twin(site->drive_ids.at(0));
    return twin->mechanics(1, world->now);
}

double SpecimenDay::looseness() const {
    double all = 20;
    for (const Freedom& f : e.catalogue->freedoms()) {
        if (f.unit == "increments") all += static_cast<double>(std::llabs(freedom(values, f.name, f.fallback)));
    }
    return all;
}

std::string SpecimenDay::in_words() const {
    std::string all = "\n  the drive:";
    for (const std::string& line : specimen_in_words(*e.catalogue, values))
        all += "\n    " + line;
    all += "\n  told:";
    for (std::size_t i = world->events.size() > 12 ? world->events.size() - 12 : 0; i < world->events.size(); ++i)
        all += "\n    " + world->events[i].kind + ": " + world->events[i].text;
    return all;
}

const Result* SpecimenDay::ask(CommandBody body, bool until_done, Duration limit) {
    told_before_ = world->events.size();
    return world->wait(world->command(axis, std::move(body), until_done), limit);
}

const Result* SpecimenDay::ask_with_remedy(const CommandBody& body, Duration limit, bool until_done) {
    constexpr int most_times = 5;
    const Result* r = ask(body, until_done, limit);
    for (int times = 1; r && !good(*r) && times < most_times; ++times) {
        EXPECT_FALSE(r->text.empty()) << "an answer that says no has a reason: " << in_short(r) << in_words();
        if (r->outcome == Outcome::failed && !std::holds_alternative<Enable>(body)) return r;  // it may have been carried out
        if (power_state_of(now().statusword) == PowerState::fault) (void)ask(ResetFault{}, true, limit);
        for (const CatalogueCommand& c : e.catalogue->commands()) {
            if (c.name.empty() || !c.arguments.empty() || r->text.find(c.name) == std::string::npos) continue;
            (void)ask(Action{c.name, "", {}}, true, limit);
            break;
        }
        world->run_for(500ms + slowness() / 4);
        r = ask(body, until_done, limit);
    }
    return r;
}

Move SpecimenDay::to(std::int64_t target, Move::Kind kind) {
    Move m;
    m.kind = kind;
    m.target = target;
    if (kind != Move::Kind::velocity) m.velocity = 4000;
    m.acceleration = m.deceleration = 20'000;
    return m;
}

std::int64_t SpecimenDay::gentle_ramp() const {
    const std::int64_t most = freedom(values, "most_acceleration");
    constexpr std::int64_t usual = 20'000;
    return most == 0 ? usual : std::min(usual, most / 2);
}

Move SpecimenDay::gently(std::int64_t target, Move::Kind kind) const {
    Move m = to(target, kind);
    m.acceleration = m.deceleration = gentle_ramp();
    return m;
}

bool SpecimenDay::gave_up() const {
    const auto told = [&](std::string_view kind) {
        return std::any_of(world->events.begin() + static_cast<std::ptrdiff_t>(std::min(told_before_, world->events.size())),
                           world->events.end(), [&](const Event& v) { return v.kind == kind && !v.text.empty(); });
    };
    const PowerState state = power_state_of(now().statusword);
    if (freedom(values, "most_acceleration") != 0 && state == PowerState::fault && told("fault")) return true;
    return freedom(values, "stopped_by_other_s") != 0 && state != PowerState::operation_enabled && told("nmt_stopped");
}

bool SpecimenDay::found() {
    return world->run_until_true([&] { return online(); }, 60s + 4 * slowness());
}

/// Returns true if the axis came up.
bool SpecimenDay::served() {
    Site wanted = world->twins(e);
    fit_line(wanted, values);
    site = world->apply(std::move(wanted));
    axis = site->axis_ids.at(0);
    const bool up = found();
    EXPECT_TRUE(up || refused_with_reason()) << "the drive is not found" << in_words();
    world->run_for(1s + slowness());
    return up;
}

bool SpecimenDay::off_or_told(const Result& disabled) const {
    if (good(disabled)) return true;
    return disabled.outcome == Outcome::failed && !disabled.text.empty() &&
           power_state_of(now().statusword) == PowerState::operation_enabled;
}

/// Returns true if it has power.
bool SpecimenDay::powered() {
    if (!served()) return false;
    const Result* r = ask_with_remedy(Enable{}, 60s);
    EXPECT_TRUE(r) << "an order has an answer" << in_words();
    if (!r) return false;
    EXPECT_TRUE(good(*r)) << "it is not enabled: " << in_short(r) << in_words();
    return good(*r);
}

bool SpecimenDay::rests(Duration limit) {
    return world->run_until_true([&] { return speed() < 1 && !moving(); }, limit);
}

/// An answer that says no has a text; nothing moves then, and nothing is said to move.
void SpecimenDay::told_as_not_done(const Result& r) {
    EXPECT_FALSE(r.text.empty()) << in_short(&r);
    EXPECT_TRUE(rests(10s + slowness())) << "it was answered with " << in_short(&r) << ", and it moves at " << speed()
                                         << (moving() ? ", and is said to move" : "") << in_words();
}

void SpecimenDay::is_found_and_stays_served() {
    if (!served()) return;
    // A specimen that restarts, or that another master stops, is lost once; it is told, and the drive is found again.
    const bool leaves = freedom(values, "restart_after_ms") != 0 || freedom(values, "stopped_by_other_s") != 0;
    for (int i = 0; i < 100; ++i) {
        world->run_for(100ms);
        if (online()) continue;
        ASSERT_TRUE(leaves) << "it was lost after " << i << " tenths of a second at rest" << in_words();
        ASSERT_TRUE(found()) << "it was lost and is not found again" << in_words();
    }
    for (const Event& v : world->events)
        EXPECT_EQ(v.text.find("two "), std::string::npos) << "a late or doubled answer is not another drive: " << v.text << in_words();
}

void SpecimenDay::a_motion_is_made_or_told_as_not_made() {
    if (!powered()) return;
    for (const int way : {20'000, -15'000}) {
        const double begin = shaft().position;
        const Result* r = ask(to(way, Move::Kind::relative), true, 90s + slowness());
        ASSERT_TRUE(r) << "it has an answer" << in_words();
        if (!good(*r)) {
            told_as_not_done(*r);
            continue;
        }
        EXPECT_TRUE(rests(2s + slowness())) << "it was done, and is said to move" << in_words();
        EXPECT_NEAR(shaft().position - begin, way, 2 * looseness()) << "done, but not made" << in_words();
    }
}

void SpecimenDay::an_accepted_motion_begins_within_its_bound() {
    if (!powered()) return;
    const Result* r = ask(to(40'000, Move::Kind::relative), false, 60s);
    ASSERT_TRUE(r) << in_words();
    if (!good(*r)) return told_as_not_done(*r);
    EXPECT_TRUE(world->run_until_true([&] { return speed() > 400 || gave_up(); }, 2s + slowness()))
        << "accepted, and it does not begin" << in_words();
    EXPECT_TRUE(rests(60s)) << "nothing moves for ever" << in_words();
}

void SpecimenDay::a_stop_ends_each_motion() {
    if (!powered()) return;
    int turned = 0;
    for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        const Result* on = ask_with_remedy(Enable{}, 60s);
        ASSERT_TRUE(on && good(*on)) << name_of(stop) << ": " << in_short(on) << in_words();
        const Result* r = ask_with_remedy(gently(4000, Move::Kind::velocity), 30s, false);
        ASSERT_TRUE(r) << in_words();
        if (!good(*r)) r = ask(gently(200'000, Move::Kind::relative), false, 30s);
        ASSERT_TRUE(r) << in_words();
        if (!good(*r)) {
            told_as_not_done(*r);
            continue;
        }
        ASSERT_TRUE(world->run_until_true([&] { return speed() > 1000 || gave_up(); }, 5s + slowness())) << in_words();
        if (speed() <= 1000) {
            EXPECT_TRUE(rests(5s + slowness())) << in_words();
            continue;
        }
        ++turned;
        const Result* stopped = ask(stop, false, 10s + slowness());
        ASSERT_TRUE(stopped) << name_of(stop) << " has no answer" << in_words();
        EXPECT_TRUE(good(*stopped) || (std::holds_alternative<Disable>(stop) && off_or_told(*stopped)))
            << name_of(stop) << ": " << in_short(stopped) << in_words();
        EXPECT_TRUE(rests(5s + slowness())) << name_of(stop) << ": it goes on at " << speed() << in_words();
    }
    EXPECT_GT(turned, 0) << "nothing was tried" << in_words();
}

void SpecimenDay::a_stream_begins_where_the_axis_is() {
    if (!e.catalogue->offers_mode(cia402::mode_of(SetPoint::Mode::position))) return;  // StreamLaws: it says so
    if (!powered()) return;
    const Result* r = ask(gently(8'000, Move::Kind::relative), true, 90s);
    ASSERT_TRUE(r) << in_words();
    const std::int64_t begin = now().position;
    double fastest = 0, last = shaft().position;
    const Origin plc{enip::clients, std::make_shared<const std::string>("192.0.2.9:50000"), {}};
    constexpr Duration cycle = 10ms;
    const std::int64_t cycles = 500 + slowness() / cycle;
    for (std::int64_t i = 1; i <= cycles; ++i) {
        SetPoint p;
        p.axis = axis;
        p.mode = SetPoint::Mode::position;
        p.value = begin + std::min<std::int64_t>(i * 20, 10'000);  // 2000 increments/s
        p.velocity = 4000;
        p.acceleration = p.deceleration = gentle_ramp();
        p.good_for = 200ms;
        p.at = world->now;
        p.origin = plc;
        (void)world->engine.on_set_point(p, world->now);
        world->run_for(cycle);
        const double place = shaft().position;
        fastest = std::max(fastest, std::fabs(place - last) / seconds(cycle));
        last = place;
    }
    EXPECT_LT(fastest, 6500) << "it jumps" << in_words();
    if (now().set_points == 0) EXPECT_NE(now().set_point_refusal, Reason::none) << "not followed, and nobody says why" << in_words();
    EXPECT_TRUE(rests(10s + slowness())) << in_words();
}

/// A gateway that starts with the drives behind the cable.
void SpecimenDay::gateway(std::uint64_t seed, Duration after) {
    const Instant at = world->now + after;
    world = std::make_unique<World>(seed, plant);
    world->now = at;
    behind_a_cable = true;
    Site wanted = world->make_site(e, e.cable(), 1, "device");
    fit_line(wanted, values);
    site = world->apply(std::move(wanted));
    axis = site->axis_ids.at(0);
}

void SpecimenDay::stops_and_serves() {
    const Result* stopped = ask(QuickStop{}, false, 10s + slowness());
    ASSERT_TRUE(stopped) << "a stop has an answer" << in_words();
    EXPECT_TRUE(good(*stopped)) << in_short(stopped) << in_words();
    EXPECT_TRUE(world->run_until_true([&] { return speed() < 1; }, 5s + slowness())) << in_words();
    world->run_for(1s + slowness());
    (void)ask(ResetFault{}, true, 20s);
    const Result* on = ask_with_remedy(Enable{}, 60s);
    ASSERT_TRUE(on) << in_words();
    EXPECT_TRUE(good(*on)) << "the next gateway cannot enable it: " << in_short(on) << in_words();
}

void SpecimenDay::the_next_gateway_finds_it() {
    gateway(1, 1s);
    world->plug_in("line", DriveId{900}, e, addresses(e, 1).at(0), e.kind(), {}, 1, e.specimen);
    if (!found()) {
        EXPECT_TRUE(refused_with_reason()) << in_words();
        return;
    }
    world->run_for(1s + slowness());
    for (const std::string_view state : {"at rest", "enabled", "moving"}) {
        SCOPED_TRACE(state);
        if (state != "at rest") {
            const Result* on = ask_with_remedy(Enable{}, 60s);
            ASSERT_TRUE(on && good(*on)) << in_short(on) << in_words();
        }
        if (state == "moving") {
            const Result* r = ask(gently(200'000, Move::Kind::relative), false, 30s);
            ASSERT_TRUE(r) << in_words();
            if (!good(*r)) return told_as_not_done(*r);
            ASSERT_TRUE(world->run_until_true([&] { return speed() > 1000; }, 5s + slowness())) << in_words();
        }
        gateway(2, 300ms);
        ASSERT_TRUE(found()) << "the next gateway does not find it" << in_words();
        stops_and_serves();
        if (testing::Test::HasFatalFailure()) return;
        const Result* off = ask(Disable{}, false, 20s);
        ASSERT_TRUE(off && off_or_told(*off)) << in_short(off) << in_words();
        world->run_for(1s + slowness());
    }
}

}  // namespace axisgate::test
