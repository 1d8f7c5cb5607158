// A third door on each thread, added beside Modbus and HTTP without an edit anywhere else: it gets results, sites and samples, and its lost
// clients are stopped. The gateway has one simulated drive.
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <atomic>
#include <boost/json/parse.hpp>
#include <future>
#include <thread>

#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/warm_ports.hpp"
#include "gateway/services/door.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

/// A door of the hot thread. Its only client enables axis 1 and turns it; then the client is gone.
struct ThirdHotDoor final : HotDoor {
    explicit ThirdHotDoor(DoorPort& port) : port(port), number(port.attach(*this)) {}
    ~ThirdHotDoor() override { port.detach(*this); }
    std::span<const WayIn> ways_in() const override { return {}; }
    std::string_view name() const override { return "third"; }
    void on_result(const Result& result) override { (good(result) ? good_results : bad_results).fetch_add(1); }
    void on_site(const SiteState& state) override { axis = state.axis_ids.at(0), sites.fetch_add(1); }
    void on_sample(const Sample&) override { samples.fetch_add(1); }
    void give(CommandBody body) {
        port.submit(
            {make_ticket(number, ++sequence), axis, std::move(body), false, {Door::dds, std::make_shared<const std::string>("peer:1")}});
    }
    void lose() { port.client_lost({Door::dds, "peer"}, LossCause::modbus_closed); }

    DoorPort& port;
    DoorNumber number;
    AxisId axis = no_axis;
    std::uint64_t sequence = 0;
    std::atomic<int> good_results{0}, bad_results{0}, sites{0}, samples{0};
};

/// A door of the service thread.
struct ThirdServiceDoor final : ServiceDoor, SiteListener, SampleListener {
    explicit ThirdServiceDoor(const PortSet<AxisPort, ParameterPort, SitePort>& ports) : ports(ports) {}
    std::span<const WayIn> ways_in() const override { return {}; }
    std::string_view name() const override { return "third"; }
    std::string start() override { return ports.get<SitePort>().listen(this), ports.get<ParameterPort>().listen(this), std::string(); }
    std::string address() const override { return "nowhere"; }
    void stop(std::function<void()> done) override {
        ports.get<SitePort>().unlisten(this), ports.get<ParameterPort>().unlisten(this), done();
    }
    void on_site(const std::shared_ptr<const SiteState>& state) override { axis = state->axis_ids.at(0), ++sites; }
    void on_sample(const Sample&) override { ++samples; }
    void give(CommandBody body) {
        Command c{no_ticket, axis, std::move(body), false, {Door::dds, std::make_shared<const std::string>("peer:1")}};
        ports.get<AxisPort>().submit(std::move(c), [this](const Result& r) { ++(good(r) ? good_results : bad_results); });
    }
    void lose() { ports.get<AxisPort>().client_lost({Door::dds, "peer"}, LossCause::modbus_closed); }

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
    /// The twin of the first family.
    void begin() {
        hot.connect(ports.outlets());
        const Family& family = *families.entries.at(0).family;
        const auto document =
            boost::json::parse(R"({"lines": [{"name": "l", "uri": "twin", "family": ")" + std::string(family.name) + R"("}],
            "drives": [{"name": "d", "line": "l", "address": ")" +
                               std::string(family.factory_address) + R"(", "presence": "twin"}],
            "axes": [{"name": "x", "drive": "d", "number": 1}]})");
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
    /// Enables the axis, sets it in motion and loses the client, over any door.
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
        lose();
        EXPECT_TRUE(until([&] { return (picture().flags & flag_moving) == 0; })) << "nobody commands it any more";
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
    const auto there = [&](auto f) {
        EXPECT_TRUE(house.hot.jobs().push([f](Engine&, Instant) { f(); }));
        house.hot.jobs().announce();
    };
    house.drive([&](CommandBody body) { there([&door, body] { door.give(body); }); }, [&] { return door.good_results.load(); },
                [&] { there([&door] { door.lose(); }); });
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
