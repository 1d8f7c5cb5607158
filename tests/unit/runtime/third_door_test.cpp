// A third door on each thread, beside those of the program and without an edit anywhere else: it brings the word of its clients, its causes
// of loss, its settings and its making; it gets results, sites and samples, and the clients that it loses are stopped as the site says for
// its own cause. A seventh and an eighth share nothing with anybody. In: a gateway with one simulated drive. Out: what the doors were told.
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <atomic>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <future>
#include <thread>

#include "gateway/axis/cia402.hpp"
#include "gateway/registers/refusals.hpp"
#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/open_doors.hpp"
#include "gateway/runtime/warm_ports.hpp"
#include "gateway/services/door.hpp"
#include "gateway/services/fail_safe/fail_safe_matrix.hpp"
#include "gateway/services/services.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

/// What a door brings, by its number; the number of its first cause of loss is twice that and two more.
template <int number>
struct Brought {
    static constexpr Door clients{number};
    static constexpr LossCause gone{2 * number + 2}, silent{2 * number + 3};
    static constexpr std::string_view name = number == 6 ? "third" : number == 7 ? "seventh" : "eighth";
    static constexpr std::string_view gone_name = number == 6 ? "third_gone" : number == 7 ? "seventh_gone" : "eighth_gone";
    static constexpr std::string_view silent_name = number == 6 ? "third_silent" : number == 7 ? "seventh_silent" : "eighth_silent";
    static constexpr std::array losses{gone, silent};
    static constexpr std::array ways{WayIn{.name = name, .door = clients, .losses = losses, .by_registers = true}};
    static constexpr std::array<LossWords, 2> loss_words{{
        {gone, gone_name, "the client has hung up", "has hung up", ""},
        {silent, silent_name, "the client says nothing", "has been silent", "has said nothing for {} ms"},
    }};
    static constexpr DoorWords words{.door = clients, .name = name, .ways = ways, .losses = loss_words, .silence = silent};
};
using Third = Brought<6>;
using Seventh = Brought<7>;
using Eighth = Brought<8>;

/// A door of the hot thread. Its only client enables axis 1 and turns it; then the client is gone.
struct ThirdHotDoor final : HotDoor {
    explicit ThirdHotDoor(DoorPort& port, const DoorWords& words = Third::words) : port(port), words(words), number(port.attach(*this)) {
        EXPECT_EQ(bring(words), "");
    }
    ~ThirdHotDoor() override { port.detach(*this); }
    std::span<const WayIn> ways_in() const override { return words.ways; }
    std::string_view name() const override { return words.name; }
    std::vector<std::string> addresses() const override { return {fmt::format("{}:1", words.name)}; }
    std::string metrics() const override { return fmt::format("{}_results_total {}\n", words.name, good_results + bad_results); }
    void on_result(const Result& result) override {
        EXPECT_EQ(door_of(result.ticket), number) << "the ticket of another door";
        (good(result) ? good_results : bad_results).fetch_add(1);
    }
    void on_site(const SiteState& state) override { axis = state.axis_ids.at(0), sites.fetch_add(1); }
    void on_sample(const Sample&) override { samples.fetch_add(1); }
    std::optional<Instant> last_received(const AuthorityClient& client) const override {
        return client.door == words.door && silent_since != Instant{} ? std::optional(silent_since) : std::nullopt;
    }
    void give(CommandBody body) {
        port.submit(
            {make_ticket(number, ++sequence), axis, std::move(body), false, {words.door, std::make_shared<const std::string>("peer:1")}});
    }
    void lose() { port.client_lost({words.door, "peer"}, words.losses.front().cause); }

    DoorPort& port;
    const DoorWords& words;
    DoorNumber number;
    AxisId axis = no_axis;
    std::uint64_t sequence = 0;
    Instant silent_since{};  // hot thread
    std::atomic<int> good_results{0}, bad_results{0}, sites{0}, samples{0};
};

/// A door of the service thread.
struct ThirdServiceDoor final : ServiceDoor, SiteListener, SampleListener {
    explicit ThirdServiceDoor(const PortSet<AxisPort, ParameterPort, SitePort>& ports) : ports(ports) {
        EXPECT_EQ(bring(Third::words), "");
    }
    std::span<const WayIn> ways_in() const override { return Third::ways; }
    std::string_view name() const override { return "third"; }
    std::string start() override { return ports.get<SitePort>().listen(this), ports.get<ParameterPort>().listen(this), std::string(); }
    std::string address() const override { return "nowhere"; }
    void stop(std::function<void()> done) override {
        ports.get<SitePort>().unlisten(this), ports.get<ParameterPort>().unlisten(this), done();
    }
    void on_site(const std::shared_ptr<const SiteState>& state) override { axis = state->axis_ids.at(0), ++sites; }
    void on_sample(const Sample&) override { ++samples; }
    void give(CommandBody body) {
        Command c{no_ticket, axis, std::move(body), false, {Third::clients, std::make_shared<const std::string>("peer:1")}};
        ports.get<AxisPort>().submit(std::move(c), [this](const Result& r) { ++(good(r) ? good_results : bad_results); });
    }
    void lose() { ports.get<AxisPort>().client_lost({Third::clients, "peer"}, Third::gone); }

    PortSet<AxisPort, ParameterPort, SitePort> ports;
    AxisId axis = no_axis;
    int good_results = 0, bad_results = 0, sites = 0, samples = 0;
};

struct House {
    TempDir dir;
    StoreOptions options = options_for(dir.path());
    std::unique_ptr<Store> store = open_store(options);
    std::vector<std::string> faults;
    Families families = load_families(faults);
    Hot hot{families, {}};
    Cold cold{*store, {[](std::vector<Stored>) {}, [](std::vector<Event>) {}, [](std::string) {}}};
    boost::asio::io_context service;
    WarmPorts ports{service, hot, cold, families, must(StoreReader::open(options))};

    ~House() {
        hot.stop();
        cold.stop();
    }
    /// The first family's twin, whichever that is. `fail_safe`: the axis' choices, as JSON.
    void begin(const std::string& fail_safe = "{}") {
        hot.connect(ports.outlets());
        const Family& family = *families.entries.at(0).family;
        const auto document =
            boost::json::parse(R"({"lines": [{"name": "l", "uri": "twin", "family": ")" + std::string(family.name) + R"("}],
            "drives": [{"name": "d", "line": "l", "address": ")" +
                               std::string(family.factory_address) + R"(", "presence": "twin"}],
            "axes": [{"name": "x", "drive": "d", "number": 1, "fail_safe": )" +
                               fail_safe + "}]}");
        std::vector<SiteFault> wrong;
        auto site = parse_site(document, families, wrong);
        ASSERT_TRUE(site) << (wrong.empty() ? "" : wrong[0].text);
        const auto state = hot.engine().apply_site(std::move(*site), {}, 1, monotonic_now());
        ports.site.set_site(state);
        hot.publish_site(*state);
        cold.start();
        hot.start();
    }
    AxisPicture picture() { return ports.axes.picture(ports.site.site()->axis_ids.at(0)); }
    template <class Condition>
    bool until(Condition condition) {
        for (const auto end = std::chrono::steady_clock::now() + 20s; std::chrono::steady_clock::now() < end;
             std::this_thread::sleep_for(1ms)) {
            service.restart();
            service.poll();
            if (condition()) return true;
        }
        return false;
    }
    /// On the hot thread, where its doors live.
    template <class F>
    void there(F f) {
        std::promise<void> done;
        EXPECT_TRUE(hot.jobs().push([&](Engine&, Instant) {
            f();
            done.set_value();
        }));
        hot.jobs().announce();
        done.get_future().wait();
    }
    /// Brings the axis up, sets it in motion and loses who did so, by whatever door.
    template <class Give, class Results, class Lose>
    void drive(Give give, Results results, Lose lose) {
        ASSERT_TRUE(until([&] { return (picture().flags & flag_online) != 0; }));
        give(CommandBody{Enable{}});
        ASSERT_TRUE(until([&] { return results() == 1 && power_state_of(picture().statusword) == PowerState::operation_enabled; }));
        Move turn;
        turn.kind = Move::Kind::velocity;
        turn.target = 4000;
        turn.acceleration = turn.deceleration = 20000;
        give(CommandBody{turn});
        ASSERT_TRUE(until([&] { return results() == 2 && (picture().flags & flag_moving) != 0; }));
        EXPECT_EQ(picture().authority, Third::clients);
        EXPECT_STREQ(picture().authority_commander.data(), "third peer");
        lose();
        EXPECT_TRUE(until([&] { return (picture().flags & flag_moving) == 0; })) << "nobody commands it any more";
        EXPECT_EQ(picture().fail_safe_cause, 14) << "register 22";
        EXPECT_TRUE(until([&] {
            return ports.status.metrics().find("axisgate_fail_safe_total{cause=\"third_gone\"} 1\n") != std::string::npos;
        })) << ports.status.metrics();
        const auto parameters = families.entries.at(0).catalogue->parameters();
        const auto readable = std::ranges::find_if(parameters, [](const Parameter& p) { return p.readable() && p.count == 0; });
        ASSERT_NE(readable, parameters.end());
        give(CommandBody{ReadParameter{{static_cast<std::uint16_t>(readable - parameters.begin()), 0}}});
        EXPECT_TRUE(until([&] { return results() == 3; }));
    }
};

TEST(ThirdDoor, OnTheHotThread) {
    House house;
    ThirdHotDoor door(house.hot);
    house.begin();
    house.drive([&](CommandBody body) { house.there([&] { door.give(body); }); }, [&] { return door.good_results.load(); },
                [&] { house.there([&] { door.lose(); }); });
    EXPECT_EQ(door.bad_results, 0);
    EXPECT_EQ(door.sites, 1);
    EXPECT_GT(door.samples, 0);
    house.hot.stop();
}

TEST(ThirdDoor, OnTheServiceThread) {
    House house;
    ThirdServiceDoor door(house.ports.all());
    ASSERT_EQ(door.start(), "");
    house.begin();
    house.drive([&](CommandBody body) { door.give(std::move(body)); }, [&] { return door.good_results; }, [&] { door.lose(); });
    EXPECT_EQ(door.bad_results, 0);
    EXPECT_EQ(door.sites, 1);
    EXPECT_GT(door.samples, 0);
    bool stopped = false;
    door.stop([&] { stopped = true; });
    EXPECT_TRUE(stopped);
}

/// Its table in the configuration.
struct ThirdSettings {
    std::int64_t port = 7;
    std::string greeting;
};
constexpr setting::Key third_keys[] = {
    {"third", "port", [](Config& c, const std::string& s) { return setting::whole_number(c.of<ThirdSettings>().port, s, 1, 9); },
     setting::Written::as_number},
    {"third", "greeting", [](Config& c, const std::string& s) { return setting::any_text(c.of<ThirdSettings>().greeting, s); }},
};
struct RunningThird final : RunningDoor {
    explicit RunningThird(const DoorHouse& house) : settings(house.config.of<ThirdSettings>()), door(house.hot) {}
    std::string name() const override { return "third"; }
    bool on_hot() const override { return true; }
    std::string open() override { return settings.port == 9 ? "port 9 is not there" : ""; }
    bool is_late() const override { return false; }
    std::string metrics() const override { return fmt::format("third_port {}\n", settings.port); }
    ThirdSettings settings;
    ThirdHotDoor door;
};
const DoorDescriptor third_door{
    .name = "third",
    .words = &Third::words,
    .settings = third_keys,
    .wanted = [](const Config& c) { return !c.of<ThirdSettings>().greeting.empty(); },
    .make = [](const DoorHouse& house, std::vector<ConfigFault>&) -> std::unique_ptr<RunningDoor> {
        return std::make_unique<RunningThird>(house);
    },
    .check =
        [](const Config& c, const KeyPlace& place, std::vector<ConfigFault>& faults) {
            if (c.of<ThirdSettings>().port == 8) faults.push_back({place("third", "port"), "8 is no port", "write 7"});
        },
};
constexpr std::array third_alone{&third_door};

Config config_with(std::string text, std::vector<ConfigFault>& faults, std::span<const DoorDescriptor* const> doors = third_alone) {
    ConfigSources s;
    s.file_name = "f.toml";
    s.file_text = std::move(text);
    return read_config(s, faults, doors);
}

TEST(ThirdDoor, BringsItsOwnTableOfTheConfiguration) {
    std::vector<ConfigFault> faults;
    const Config c = config_with("[third]\nport = 3\ngreeting = \"hello\"\n[log]\nlevel = \"debug\"\n", faults);
    ASSERT_TRUE(faults.empty()) << faults[0].text;
    EXPECT_EQ(c.of<ThirdSettings>().port, 3);
    EXPECT_EQ(c.of<ThirdSettings>().greeting, "hello");
    EXPECT_EQ(Config{}.of<ThirdSettings>().port, 7) << "as the door has it";
    (void)config_with("[third]\nport = 10\nwhat = 1\n", faults);
    ASSERT_EQ(faults.size(), 2U);
    EXPECT_EQ(faults[0].place, "f.toml:2");
    EXPECT_EQ(faults[1].remedy, "keys: port, greeting");
    faults.clear();
    (void)config_with("[third]\nport = 8\n", faults);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].place, "f.toml:2") << "where its own check found it";
    faults.clear();
    (void)config_with("[third]\nport = 3\n", faults, {});
    ASSERT_EQ(faults.size(), 1U) << "without the door there is no such table";
    EXPECT_EQ(faults[0].text, "[third] is not a section");
}

/// The service thread's part of a house with doors.
struct OpenHouse : House {
    registers::Languages languages{};
    registers::RegisterImage image{hot, {}};
    Services services{ports.all(), monotonic_now};
    OpenDoors doors{service, hot, ports};
    int open(const Config& config) {
        return doors.open({config, families, languages, hot, image, service, ports, services, *store, [] { return std::string(); }},
                          third_alone);
    }
};

TEST(ThirdDoor, IsMadeOpenedShownAndClosedAsItsDescriptorSays) {
    std::vector<ConfigFault> faults;
    const Config wanted = config_with("[third]\nport = 3\ngreeting = \"hello\"\n", faults);
    OpenHouse house;
    ASSERT_EQ(house.open(wanted), exit_good);
    const auto shown = house.ports.status.doors();
    ASSERT_EQ(shown.size(), 1U);
    EXPECT_EQ(shown[0].name, "third");
    EXPECT_EQ(shown[0].address, "third:1");
    house.begin();
    const std::string metrics = house.ports.status.metrics();
    EXPECT_NE(metrics.find("third_port 3\n"), std::string::npos);
    EXPECT_NE(metrics.find("third_results_total 0\n"), std::string::npos);
    house.hot.stop();
    house.doors.stop();
    EXPECT_FALSE(house.doors.hang());
}

TEST(ThirdDoor, IsAbsentWhereNobodyWantsItAndEndsTheStartWhereItCannotBeOpened) {
    std::vector<ConfigFault> faults;
    OpenHouse without;
    EXPECT_EQ(without.open(config_with("", faults)), exit_good);
    EXPECT_TRUE(without.ports.status.doors().empty());
    without.begin();
    without.hot.stop();
    OpenHouse closed;
    EXPECT_EQ(closed.open(config_with("[third]\nport = 9\ngreeting = \"x\"\n", faults)), exit_failed);
    closed.begin();
    closed.hot.stop();
}

TEST(ThirdDoor, ItsCauseOfLossIsAWordOfTheSiteAndARowOfTheMatrix) {
    ASSERT_EQ(bring(Third::words), "");
    House house;
    house.begin(R"({"third_gone": "disable", "modbus_closed": "halt"})");
    const auto site = house.ports.site.site();
    EXPECT_EQ(site->site.axes[0].fail_safe.of(Third::gone), FailSafeAction::disable);
    const auto axis = to_json(site->site).at("axes").at(0).at("fail_safe");
    EXPECT_EQ(boost::json::serialize(axis), R"({"modbus_closed":"halt","third_gone":"disable"})");
    const auto causes = loss_causes_document();
    const auto row = std::ranges::find_if(causes, [](const auto& c) { return c.at("cause") == "third_gone"; });
    ASSERT_NE(row, causes.end());
    EXPECT_EQ(row->at("number"), 14);
    EXPECT_EQ(row->at("description"), "the client has hung up");
    EXPECT_EQ(row->at("default_endless"), "halt");
}

TEST(ThirdDoor, ASilentClientOfItIsStoppedForItsOwnCause) {
    House house;
    ThirdHotDoor door(house.hot);
    house.begin(R"({"watchdog_ms": 300})");
    ASSERT_TRUE(house.until([&] { return (house.picture().flags & flag_online) != 0; }));
    house.there([&] { door.silent_since = house.hot.now() + 1h, door.give(Enable{}); });
    ASSERT_TRUE(house.until([&] { return power_state_of(house.picture().statusword) == PowerState::operation_enabled; }));
    Move turn;
    turn.kind = Move::Kind::velocity;
    turn.target = 4000;
    turn.acceleration = turn.deceleration = 20000;
    house.there([&] { door.give(turn); });
    ASSERT_TRUE(house.until([&] { return (house.picture().flags & flag_moving) != 0; }));
    EXPECT_EQ(house.picture().fail_safe_cause, 0);
    house.there([&] { door.silent_since = house.hot.now(); });
    EXPECT_TRUE(house.until([&] { return (house.picture().flags & flag_moving) == 0; }));
    EXPECT_EQ(house.picture().fail_safe_cause, 15);
    house.hot.stop();
}

TEST(SeventhAndEighthDoor, ShareNothingThoughTheirClientsHaveOneName) {
    House house;
    ThirdHotDoor seventh(house.hot, Seventh::words), eighth(house.hot, Eighth::words);
    EXPECT_NE(seventh.number, eighth.number);
    house.begin();
    const auto write = [&](ThirdHotDoor& door, const ProcessData& data, int good, int bad) {
        house.there([&] { door.give(data); });
        EXPECT_TRUE(house.until([&] { return door.good_results == good && door.bad_results == bad; }))
            << door.name() << ": " << door.good_results << " good, " << door.bad_results << " bad";
    };
    ASSERT_TRUE(house.until([&] { return (house.picture().flags & flag_online) != 0; }));
    ProcessData of_seventh;
    of_seventh.mode = cia402::mode_profile_position;
    of_seventh.profile_velocity = 4000;
    of_seventh.profile_acceleration = of_seventh.profile_deceleration = 20'000;
    int good = 0;
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
        of_seventh.controlword = word;
        write(seventh, of_seventh, ++good, 0);
    }
    ASSERT_TRUE(house.until([&] { return power_state_of(house.picture().statusword) == PowerState::operation_enabled; }));
    of_seventh.target_position = static_cast<std::int32_t>(house.picture().position) + 8000;
    write(seventh, of_seventh, ++good, 0);
    // The same name by another door: the target and the speed of the seventh are none of its own.
    ProcessData of_eighth;
    of_eighth.mode = cia402::mode_profile_position;
    of_eighth.controlword = 0x0F;
    write(eighth, of_eighth, 1, 0);
    of_eighth.controlword = 0x1F;
    write(eighth, of_eighth, 1, 1);
    EXPECT_EQ(house.picture().flags & flag_moving, 0);
    of_seventh.controlword = 0x1F;
    write(seventh, of_seventh, ++good, 0);
    ASSERT_TRUE(house.until([&] { return (house.picture().flags & flag_moving) != 0; })) << "its own target and speed are there yet";
    house.there([&] { eighth.lose(); });
    EXPECT_EQ(house.picture().authority, Seventh::clients);
    EXPECT_TRUE(house.until([&] { return (house.picture().statusword & cia402::sw_target_reached) != 0; }));
    EXPECT_EQ(house.picture().fail_safe_cause, 0) << "the loss of the eighth door's client is not that of the seventh's";
    house.hot.stop();
}

TEST(SeventhAndEighthDoor, EachTellsItsOwnRefusals) {
    ASSERT_EQ(bring(Seventh::words) + bring(Eighth::words), "");
    std::vector<Event> told;
    const auto tell = [&](const Event& e, AxisId) { told.push_back(e); };
    registers::RefusalLog of_seventh(Seventh::clients, tell), of_eighth(Eighth::clients, tell);
    const registers::RequestNote note{.unit = 1, .code = 6, .write = true, .address = 34, .count = 1};
    for (auto* log : {&of_seventh, &of_eighth})
        log->add("peer:1", {AxisId{1}, Reason::out_of_range, "too far", {}, {}}, note, "no", at_ns(1'000'000'000));
    ASSERT_EQ(told.size(), 2U) << "the same refusal of the same peer at another door is no repetition";
    EXPECT_EQ(told[0].door, "seventh");
    EXPECT_EQ(told[1].door, "eighth");
}

TEST(DoorsThatAreBrought, CannotTakeWhatBelongsToAnother) {
    ASSERT_EQ(bring(Third::words), "");
    EXPECT_EQ(bring(Third::words), "") << "the same again";
    static constexpr Door mine{9};
    static constexpr std::array losses{LossCause::lease_ended};
    static constexpr std::array ways{WayIn{.name = "w", .door = mine, .losses = losses}};
    static constexpr DoorWords number_taken{.door = Third::clients, .name = "ninth", .ways = {}, .losses = {}};
    static constexpr DoorWords word_taken{.door = mine, .name = "third", .ways = ways, .losses = {}};
    static constexpr DoorWords of_nobody{.door = Door::internal, .name = "ninth", .ways = {}, .losses = {}};
    static constexpr std::array lossless{WayIn{.name = "w", .door = mine, .losses = {}}};
    static constexpr DoorWords endless{.door = mine, .name = "ninth", .ways = lossless, .losses = {}};
    static constexpr std::array<LossWords, 1> untold{{{LossCause{40}, "ninth_gone", "d", "t", ""}}};
    static constexpr DoorWords unused{.door = mine, .name = "ninth", .ways = ways, .losses = untold};
    for (const DoorWords* wrong : {&number_taken, &word_taken, &of_nobody, &endless, &unused})
        EXPECT_NE(bring(*wrong), "") << wrong->name;
    static constexpr std::array with_taken{Third::gone};
    static constexpr std::array ways_taken{WayIn{.name = "w", .door = mine, .losses = with_taken}};
    static constexpr std::array<LossWords, 1> cause_taken{{{Third::gone, "ninth_gone", "d", "t", ""}}};
    static constexpr DoorWords takes_cause{.door = mine, .name = "ninth", .ways = ways_taken, .losses = cause_taken};
    EXPECT_NE(bring(takes_cause).find("number 14 belongs to the cause third_gone"), std::string::npos) << bring(takes_cause);
    EXPECT_EQ(words_of(mine), nullptr);
}

TEST(DriveStatusOfTheServiceThread, SaysThePresenceThatTheAxesOfTheDriveShow) {
    House house;
    house.begin();
    const auto site = house.ports.site.site();
    const DriveId drive = site->drive_ids.at(0);
    const auto online = [&](Presence presence) { return presence != Presence::offline; };
    ASSERT_TRUE(house.until([&] { return house.picture().presence == Presence::twin; }));
    for (int turn = 0; turn < 3; ++turn) {
        for (const bool power : {false, true}) {
            house.ports.drives.set_hand(drive, {{"power", power}}, {}, [](std::string fault) { EXPECT_EQ(fault, ""); });
            ASSERT_TRUE(house.until([&] { return online(house.picture().presence) == power; }));
            EXPECT_EQ(online(house.ports.drives.drive_status(drive).presence), power) << "behind its axis";
            const std::string text = house.ports.status.metrics();
            EXPECT_NE(text.find(fmt::format("axisgate_drive_online{{drive=\"d\"}} {}\n", power ? 1 : 0)), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace axisgate::test
