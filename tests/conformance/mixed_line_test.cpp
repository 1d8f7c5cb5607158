// Two families on one CAN line: uim342 with its 29-bit identifiers, and the example drive's text in frames of 11 bits. Both are homed,
// moved and found, and a fault of one does not affect the other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "gateway/services/frame_decoder.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;
namespace json = boost::json;

constexpr std::uint32_t to_drive = 0x200, from_drive = 0x280;

void in_frames(Out& out, std::size_t begin, std::uint32_t base, int address) {
    std::vector<Out::Tx> made;
    for (std::size_t i = begin; i < out.frames.size(); ++i) {
        const auto& tx = out.frames[i];
        const auto bytes = tx.frame.data();
        const int number = address ? address : (bytes[1] - '0') * 10 + bytes[2] - '0';
        for (std::size_t at = 0; at < bytes.size(); at += 8) {
            Frame f = Frame::can_extended(base + static_cast<std::uint32_t>(number),
                                          bytes.subspan(at, std::min<std::size_t>(8, bytes.size() - at)));
            f.extended = false;
            made.push_back({f, tx.priority});
        }
    }
    out.frames.resize(begin);
    out.frames.insert(out.frames.end(), made.begin(), made.end());
}

/// The example's adapter with its bytes in CAN frames.
class TextOnCan final : public Adapter {
public:
    explicit TextOnCan(std::unique_ptr<Adapter> inner) : inner_(std::move(inner)) {}
    void configure(const LineSetup& setup, Instant now, Out& out) override {
        call(out, [&] { inner_->configure(setup, now, out); });
    }
    void on_line(bool up, Instant now, Out& out) override {
        call(out, [&] { inner_->on_line(up, now, out); });
    }
    void on_command(const Command& command, Instant now, Out& out) override {
        call(out, [&] { inner_->on_command(command, now, out); });
    }
    void on_frame(const Frame& frame, Instant now, Out& out) override {
        if (frame.kind != Frame::Kind::can) return;
        EXPECT_FALSE(frame.extended) << "the other family's frame";
        call(out, [&] { inner_->on_frame(Frame::run(frame.data()), now, out); });
    }
    void on_deadline(Instant now, Out& out) override {
        call(out, [&] { inner_->on_deadline(now, out); });
    }
    [[nodiscard]] Instant deadline() const override { return inner_->deadline(); }
    [[nodiscard]] AdapterCounters counters() const override { return inner_->counters(); }

private:
    template <class F>
    void call(Out& out, F&& f) {
        const std::size_t begin = out.frames.size();
        f();
        in_frames(out, begin, to_drive, 0);
    }
    std::unique_ptr<Adapter> inner_;
};

class TextTwin final : public Twin {
public:
    TextTwin(std::unique_ptr<Twin> inner, int address) : inner_(std::move(inner)), address_(address) {}
    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (f.kind != Frame::Kind::can || f.extended || f.id != to_drive + static_cast<std::uint32_t>(address_)) return;
        call(out, [&] { inner_->on_frame(Frame::run(f.data()), now, out); });
    }
    void on_deadline(Instant now, Out& out) override {
        call(out, [&] { inner_->on_deadline(now, out); });
    }
    [[nodiscard]] Instant deadline() const override { return inner_->deadline(); }
    void power_on(const NonVolatile& memory, Instant now, Out& out) override {
        call(out, [&] { inner_->power_on(memory, now, out); });
    }
    [[nodiscard]] NonVolatile non_volatile() const override { return inner_->non_volatile(); }
    [[nodiscard]] bool fit_axes(int axes, Instant now) override { return inner_->fit_axes(axes, now); }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return inner_->non_volatile_revision(); }
    [[nodiscard]] std::vector<HandItem> hand() const override { return inner_->hand(); }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override {
        std::string wrong;
        call(out, [&] { wrong = inner_->set_hand(name, value, now, out); });
        return wrong;
    }
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override { return inner_->mechanics(channel, now); }

private:
    template <class F>
    void call(Out& out, F&& f) {
        const std::size_t begin = out.frames.size();
        f();
        in_frames(out, begin, from_drive, address_);
    }
    std::unique_ptr<Twin> inner_;
    int address_;
};

const Family& text_on_can() {
    static const Family& base = *families().find("example").family;
    static const Family family = [] {
        Family f = base;
        f.name = "text_on_can";
        f.uses_can = true;
        f.default_can_bit_rate = 500'000;
        f.make_adapter = [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> {
            return std::make_unique<TextOnCan>(base.make_adapter(c, kind));
        };
        f.make_twin = [](const Catalogue& c, const TwinSetup& t) -> std::unique_ptr<Twin> {
            return std::make_unique<TextTwin>(base.make_twin(c, t), std::stoi(t.address));
        };
        f.can_identifiers = [](std::span<const std::string> addresses) {
            std::vector<CanIdentifiers> list;
            for (const auto& a : addresses) {
                list.push_back({false, 0x7FF, to_drive + static_cast<std::uint32_t>(std::stoi(a))});
                list.push_back({false, 0x7FF, from_drive + static_cast<std::uint32_t>(std::stoi(a))});
            }
            return list;
        };
        return f;
    }();
    return family;
}

/// A node that is not in the site and sends something after each frame that it receives.
class Stranger final : public Twin {
public:
    void on_frame(const Frame& received, Instant, Out& out) override {
        if (received.id == 0x123) return;
        Frame f = Frame::can_extended(0x123, {});
        f.extended = false;
        out.send(f);
    }
    void on_deadline(Instant, Out&) override {}
    [[nodiscard]] Instant deadline() const override { return never; }
    void power_on(const NonVolatile&, Instant, Out&) override {}
    [[nodiscard]] NonVolatile non_volatile() const override { return {}; }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return 0; }
    [[nodiscard]] std::vector<HandItem> hand() const override { return {}; }
    [[nodiscard]] std::string set_hand(const std::string&, const Value&, Instant, Out&) override { return ""; }
    [[nodiscard]] TwinMechanics mechanics(int, Instant) const override { return {}; }
};

struct MixedLine : testing::Test {
    Families all = [] {
        Families f = families();
        f.entries.push_back({&text_on_can(), f.find("example").catalogue});
        return f;
    }();
    World world{1, std::make_shared<Plant>(), all};
    std::shared_ptr<const SiteState> site;
    AxisId uim = no_axis, text = no_axis;

    /// Both have the same number, which is no conflict on this line. `second`: with the drive of the other family.
    Site wanted(std::string_view uri, std::string_view presence, bool second = true) {
        json::array drives{{{"name", "uim"}, {"line", "line"}, {"family", "uim342"}, {"address", 5}, {"presence", presence}}};
        json::array axes{{{"name", "uim"}, {"drive", "uim"}, {"number", 1}, {"unit", "u"}, {"increments_per_unit", 100}}};
        if (second) {
            drives.push_back({{"name", "text"}, {"line", "line"}, {"family", "text_on_can"}, {"address", 5}, {"presence", presence}});
            axes.push_back({{"name", "text"}, {"drive", "text"}, {"number", 2}, {"unit", "u"}, {"increments_per_unit", 100}});
        }
        const json::value doc{{"lines", {{{"name", "line"}, {"uri", uri}, {"bitrate", 500000}}}},
                              {"drives", drives},
                              {"axes", axes},
                              {"mappings", json::array{}}};
        std::vector<SiteFault> faults;
        auto parsed = parse_site(doc, all, faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f.pointer << ": " << f.text;
        return parsed ? std::move(*parsed) : Site{};
    }
    void apply(Site wanted_site) {
        site = world.apply(std::move(wanted_site));
        uim = site->axis_ids.at(0);
        text = site->axis_ids.size() > 1 ? site->axis_ids[1] : no_axis;
    }
    void plug_in(int key, std::string_view family, const std::string& address) {
        world.plug_in("line", DriveId{static_cast<std::uint16_t>(key)}, all.find(family), address, LineKind::can);
    }
    /// Real drives behind one cable.
    void start() {
        apply(wanted("can:sim", "device"));
        plug_in(1, "uim342", "5");
        plug_in(2, "text_on_can", "5");
        ASSERT_TRUE(world.run_until_true([&] { return online(uim) && online(text); }, 20s));
        world.run_for(1s);
    }
    [[nodiscard]] bool online(AxisId a) const { return (world.picture(a).flags & flag_online) && world.picture(a).ever_seen; }
    [[nodiscard]] bool moving(AxisId a) const { return (world.picture(a).flags & flag_moving) != 0; }
    void order(AxisId a, CommandBody body) {
        const std::string what(name_of(body));
        const Result* r = world.wait(world.command(a, std::move(body), true), 120s);
        ASSERT_TRUE(r && good(*r)) << what << ": " << published(r);
    }
    static Move move_to(std::int64_t target, std::int64_t velocity = 4000) {
        Move m;
        m.target = target;
        m.velocity = velocity;
        m.acceleration = m.deceleration = 20000;
        return m;
    }
    void hand(int key, const std::string& name, bool on) {
        ASSERT_EQ(world.buses.at("line")->set_hand(DriveId{static_cast<std::uint16_t>(key)}, name, Value{on}, world.now), "");
    }
    [[nodiscard]] LineReport report() const { return world.engine.line_report(site->line_ids[0], world.now); }
    [[nodiscard]] std::ptrdiff_t events_of(std::string_view name) const {
        return std::ranges::count_if(world.events, [&](const Event& e) { return e.drive == name || e.axis == name; });
    }
    /// `a` is enabled and moves there and back, each time within the necessary time.
    void goes_there_and_back(AxisId a) {
        order(a, Enable{});
        for (const std::int64_t target : {std::int64_t{2000}, std::int64_t{-2000}}) {
            const Ticket t = world.command(a, move_to(target), true);
            const Result* r = world.wait(t, 5s);
            ASSERT_TRUE(r && good(*r)) << published(r);
            EXPECT_NEAR(static_cast<double>(world.picture(a).position), static_cast<double>(target), 20);
        }
    }
};

TEST_F(MixedLine, BothAreHomedAndMovedAndEachHasItsCounters) {
    start();
    for (const AxisId a : {uim, text}) {
        order(a, Enable{});
        order(a, Home{35});
        EXPECT_TRUE(world.picture(a).flags & flag_referenced);
    }
    const Ticket one = world.command(uim, move_to(5000), true), other = world.command(text, move_to(-7000), true);
    ASSERT_TRUE(world.run_until_true([&] { return moving(uim) && moving(text); }, 5s)) << "both at the same time";
    for (const Ticket t : {one, other}) {
        const Result* r = world.wait(t, 20s);
        ASSERT_TRUE(r) << t;
        EXPECT_EQ(r->outcome, Outcome::done) << published(r);
    }
    EXPECT_NEAR(static_cast<double>(world.picture(uim).position), 5000, 20);
    EXPECT_EQ(world.picture(text).position, -7000);
    const LineReport r = report();
    ASSERT_EQ(r.families.size(), 2u);
    EXPECT_EQ(r.families[0].family, "uim342");
    EXPECT_EQ(r.families[1].family, "text_on_can");
    for (const auto& f : r.families) {
        EXPECT_GT(f.counters.exchanges, 20u) << f.family;
        EXPECT_EQ(f.counters.garbled + f.counters.unexpected + f.counters.timeouts, 0u) << f.family << " was given what is not its own";
    }
    EXPECT_EQ(r.counters.exchanges, r.families[0].counters.exchanges + r.families[1].counters.exchanges);
    EXPECT_EQ(r.unclaimed, 0u);
    EXPECT_GT(r.status.load, 0.0);
}

TEST_F(MixedLine, TwinsOfBothStandOnOneBus) {
    apply(wanted("twin", "auto"));
    ASSERT_TRUE(world.run_until_true([&] { return online(uim) && online(text); }, 20s));
    for (const AxisId a : {uim, text}) {
        EXPECT_TRUE(world.picture(a).flags & flag_simulated);
        goes_there_and_back(a);
    }
    EXPECT_EQ(report().families.size(), 2u);
}

TEST_F(MixedLine, SilenceAndPowerOfOneDoNotTouchTheOther) {
    start();
    struct Case {
        int key;
        AxisId gone, stays;
        std::string_view stays_name;
    };
    for (const Case& c : {Case{2, text, uim, "uim"}, Case{1, uim, text, "text"}}) {
        for (const char* what : {"silent", "power"}) {
            const bool off = std::string_view(what) == "silent";
            hand(c.key, what, off);
            ASSERT_TRUE(world.run_until_true([&] { return !online(c.gone); }, 10s)) << what;
            world.run_for(5s);  // well into its back-off
            const auto status = world.engine.drive_status(site->drive_ids[c.key == 1 ? 0 : 1]);
            EXPECT_GT(status.retry_pause_ms, 0) << "its own pauses grow";
            const auto published_of =
                std::ranges::count_if(world.events, [&](const Event& e) { return e.drive == c.stays_name && e.kind == "drive"; });
            goes_there_and_back(c.stays);
            EXPECT_EQ(std::ranges::count_if(world.events, [&](const Event& e) { return e.drive == c.stays_name && e.kind == "drive"; }),
                      published_of);
            hand(c.key, what, !off);
            ASSERT_TRUE(world.run_until_true([&] { return online(c.gone); }, 30s)) << what;
            world.run_for(1s);
        }
    }
}

TEST_F(MixedLine, AStopOfOneEndsItsOwnMotionAlone) {
    start();
    for (const AxisId a : {uim, text})
        order(a, Enable{});
    const Ticket goes = world.command(text, move_to(20000), true), ends = world.command(uim, move_to(20000), true);
    ASSERT_TRUE(world.run_until_true([&] { return moving(uim) && moving(text); }, 5s));
    order(uim, QuickStop{});
    const Result* r = world.wait(ends, 5s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->reason, Reason::interrupted) << published(r);
    EXPECT_TRUE(moving(text));
    r = world.wait(goes, 20s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::done) << published(r);
    EXPECT_EQ(world.picture(text).position, 20000);
}

TEST_F(MixedLine, AScanFindsBothFamiliesEachByItsOwnCount) {
    start();
    plug_in(3, "uim342", "9");
    plug_in(4, "text_on_can", "12");
    ScanWish wish;
    wish.limit = 600s;
    wish.to = "20";
    ASSERT_EQ(world.engine.start_scan(site->line_ids[0], wish, world.now), "");
    const auto scan = [&] { return world.engine.scan_report(site->line_ids[0]); };
    ASSERT_TRUE(world.run_until_true([&] { return scan().state != ScanReport::State::running; }, 600s));
    EXPECT_EQ(scan().state, ScanReport::State::done) << scan().text;
    std::map<std::string, std::string> found;
    for (const auto& f : scan().found)
        EXPECT_TRUE(found.emplace(f.family + " " + f.address, f.known_as).second) << f.family << " " << f.address << " is found twice";
    EXPECT_EQ(found, (std::map<std::string, std::string>{
                         {"uim342 5", "uim"}, {"text_on_can 5", "text"}, {"uim342 9", ""}, {"text_on_can 12", ""}}));
    ASSERT_EQ(scan().parts.size(), 2u);
    for (const auto& part : scan().parts) {
        EXPECT_GT(part.of, 10u) << part.family;
        EXPECT_EQ(part.asked, part.of) << part.family;
    }
    EXPECT_EQ(scan().of, scan().parts[0].of + scan().parts[1].of);
    EXPECT_TRUE(online(uim) && online(text)) << "the site's own were served all the time";

    // One of them alone, and one that is not on the line.
    wish.family = "text_on_can";
    ASSERT_EQ(world.engine.start_scan(site->line_ids[0], wish, world.now), "");
    ASSERT_TRUE(world.run_until_true([&] { return scan().state != ScanReport::State::running; }, 600s));
    EXPECT_EQ(scan().parts.size(), 1u);
    EXPECT_EQ(scan().found.size(), 2u);
    wish.family = "mcode";
    EXPECT_THAT(world.engine.start_scan(site->line_ids[0], wish, world.now), testing::HasSubstr("does not speak on CAN"));
    wish.family = "nobody";
    EXPECT_THAT(world.engine.start_scan(site->line_ids[0], wish, world.now), testing::HasSubstr("there is no family nobody"));
}

TEST_F(MixedLine, AFamilyThatIsNotOnTheLineYetIsSearchedForAndGoesAgain) {
    apply(wanted("can:sim", "device", false));
    plug_in(1, "uim342", "5");
    plug_in(2, "text_on_can", "12");
    ASSERT_TRUE(world.run_until_true([&] { return online(uim); }, 20s));
    ScanWish wish;
    wish.family = "text_on_can";
    wish.limit = 600s;
    ASSERT_EQ(world.engine.start_scan(site->line_ids[0], wish, world.now), "");
    const auto scan = [&] { return world.engine.scan_report(site->line_ids[0]); };
    ASSERT_TRUE(world.run_until_true([&] { return scan().state != ScanReport::State::running; }, 600s));
    ASSERT_EQ(scan().found.size(), 1u);
    EXPECT_EQ(scan().found[0].address, "12");
    EXPECT_EQ(report().families.size(), 1u) << "the line has one family, as the site says";
    goes_there_and_back(uim);
}

TEST_F(MixedLine, FramesThatNobodyClaimsAreCountedAndGivenToNobody) {
    start();
    world.buses.at("line")->add(DriveId{9}, std::make_unique<Stranger>(), {}, world.now);
    world.run_for(2s);
    EXPECT_GT(report().unclaimed, 10u);
    for (const auto& f : report().families)
        EXPECT_EQ(f.counters.garbled + f.counters.unexpected, 0u) << f.family;
    EXPECT_TRUE(online(uim) && online(text));
}

TEST_F(MixedLine, AFamilyComesAndGoesWithoutDisturbingTheOther) {
    apply(wanted("can:sim", "device", false));
    plug_in(1, "uim342", "5");
    plug_in(2, "text_on_can", "5");
    ASSERT_TRUE(world.run_until_true([&] { return online(uim); }, 20s));
    order(uim, Enable{});
    const auto source = world.picture(uim).source;
    const Ticket t = world.command(uim, move_to(20000), true);
    ASSERT_TRUE(world.run_until_true([&] { return moving(uim); }, 5s));
    const AxisId before = uim;
    apply(wanted("can:sim", "device"));
    ASSERT_EQ(uim, before);
    ASSERT_TRUE(world.run_until_true([&] { return online(text); }, 3s)) << "its adapter is told that the line is up";
    EXPECT_EQ(report().families.size(), 2u);
    const Ticket waits = world.command(text, Enable{}, true);
    apply(wanted("can:sim", "device", false));
    ASSERT_TRUE(world.result(waits)) << "what waited is answered when its drive goes";
    EXPECT_EQ(report().families.size(), 1u);
    const Result* r = world.wait(t, 20s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::done) << published(r);
    EXPECT_EQ(world.picture(uim).source, source) << "another drive's coming and going is none of its";
}

TEST_F(MixedLine, ARecordedFrameIsReadByTheFamilyThatClaimsIt) {
    start();
    order(uim, Enable{});
    FrameDecoder decoder(all, site->site, "line");
    std::map<std::string, int> read;
    for (const auto& entry : world.engine.frame_log(site->line_ids[0])->read_newest(400, 0).entries) {
        for (const auto& line : decoder.read(entry)) {
            EXPECT_EQ(line.find("unknown"), std::string::npos) << line;
            EXPECT_TRUE(line.starts_with(entry.frame.extended ? "uim342: " : "text_on_can: ")) << line;
            ++read[line.substr(0, line.find(':'))];
        }
    }
    EXPECT_GT(read["uim342"], 10);
    EXPECT_GT(read["text_on_can"], 10);
    TraceEntry strange;
    strange.frame = Frame::can_extended(0x123, {});
    strange.frame.extended = false;
    ASSERT_EQ(decoder.read(strange).size(), 1u);
    EXPECT_THAT(decoder.read(strange)[0], testing::HasSubstr("belongs to no family of this line"));
}

/// The faults of a site with these drives on a CAN line.
TEST_F(MixedLine, TheSiteSaysWhatCannotShareALine) {
    const auto faults_of = [&](std::string_view text) {
        std::vector<SiteFault> faults;
        (void)parse_site(json::parse(text), all, faults);
        std::string s;
        for (const auto& f : faults)
            s += f.pointer + ": " + f.text + "\n";
        return s;
    };
    EXPECT_EQ(faults_of(R"({"lines":[{"name":"c","uri":"twin"}],"drives":[{"name":"a","line":"c","address":5}]})"),
              "/drives/0/family: drive a: family is missing, and its line c names none\n");
    EXPECT_EQ(faults_of(R"({"lines":[{"name":"c","uri":"tcp:127.0.0.1:9"}]})"),
              "/lines/0/family: line c: family is missing: a line of bytes carries one, by which it is set up\n");
    EXPECT_EQ(
        faults_of(
            R"({"lines":[{"name":"c","uri":"twin","family":"mcode"}],"drives":[{"name":"a","line":"c","family":"uim342","address":5}]})"),
        "/drives/0/family: drive a: line c carries bytes, and those of mcode alone\n");
    EXPECT_EQ(
        faults_of(
            R"({"lines":[{"name":"c","uri":"can:can0","family":"uim342"}],"drives":[{"name":"a","line":"c","family":"mcode","address":"A"}]})"),
        "/drives/0/family: drive a: mcode does not speak on CAN\n");
    EXPECT_EQ(
        faults_of(
            R"({"lines":[{"name":"c","uri":"can:can0","family":"uim342"}],"drives":[{"name":"a","line":"c","family":"nobody","address":"A"}]})"),
        "/drives/0/family: drive a: there is no family nobody\n");
    EXPECT_EQ(faults_of(R"({"lines":[{"name":"c","uri":"twin","family":"uim342"}],"drives":[{"name":"a","line":"c","address":5},
                            {"name":"b","line":"c","family":"text_on_can","address":5},{"name":"d","line":"c","family":"text_on_can","address":5}]})"),
              "/drives/2/address: two drives on c have the address 5\n");

    // Families without identifiers, or with overlapping ones.
    Family silent = text_on_can(), same = text_on_can();
    silent.name = "silent";
    silent.can_identifiers = nullptr;
    same.name = "same";
    all.entries.push_back({&silent, all.find("example").catalogue});
    all.entries.push_back({&same, all.find("example").catalogue});
    EXPECT_EQ(faults_of(R"({"lines":[{"name":"c","uri":"twin","family":"uim342"}],"drives":[{"name":"a","line":"c","address":5},
                            {"name":"b","line":"c","family":"silent","address":5}]})"),
              "/drives/1/family: drive b: silent cannot share a CAN line with other families\n");
    EXPECT_EQ(faults_of(R"({"lines":[{"name":"c","uri":"twin","family":"same"}],"drives":[{"name":"a","line":"c","address":5},
                            {"name":"b","line":"c","family":"text_on_can","address":6},{"name":"d","line":"c","family":"text_on_can","address":5}]})"),
              "/drives/2/address: drive d (text_on_can) and drive a (same) use the same CAN identifiers\n");
}

TEST_F(MixedLine, ADrivesFamilyIsKeptInTheDocumentAndTheLinesIsNotRepeated) {
    const auto text_of = [&](std::string_view text) {
        std::vector<SiteFault> faults;
        const auto parsed = parse_site(json::parse(text), all, faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f.pointer << ": " << f.text;
        return parsed ? json::serialize(to_json(*parsed)) : "";
    };
    const std::string mixed =
        R"({"lines":[{"name":"c","uri":"twin","family":"uim342"}],"drives":[{"name":"a","line":"c","presence":"auto","address":5},)"
        R"({"name":"b","line":"c","presence":"auto","family":"text_on_can","address":5}],"axes":[],"mappings":[]})";
    EXPECT_EQ(text_of(mixed), mixed);
    const std::string plain =
        R"({"lines":[{"name":"c","uri":"twin","family":"uim342"}],"drives":[{"name":"a","line":"c","presence":"auto","address":5}],"axes":[],"mappings":[]})";
    EXPECT_EQ(text_of(plain), plain);
    EXPECT_EQ(
        text_of(
            R"({"lines":[{"name":"c","uri":"twin","family":"uim342"}],"drives":[{"name":"a","line":"c","family":"uim342","address":5}]})"),
        plain)
        << "a drive of the line's family follows it";
    const std::string bare = R"({"lines":[{"name":"c","uri":"twin"}],"drives":[],"axes":[],"mappings":[]})";
    EXPECT_EQ(text_of(bare), bare) << "a line may wait for its drives";
}

}  // namespace
}  // namespace axisgate::test
