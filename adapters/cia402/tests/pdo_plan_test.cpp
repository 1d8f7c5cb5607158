// Where the PDOs of a drive come from: the gateway's mapping, the part of it that the drive accepts, the drive's own, or none.
#include <algorithm>
#include <string>

#include "adapters/cia402/drive_pdos.hpp"
#include "adapters/cia402/tests/manners_bench.hpp"

namespace axisgate::cia402_drive::test {
namespace {

struct Planned : Manners {
    std::map<std::uint32_t, int> pdos;  ///< by identifier, since the last clear
    int polled = 0;                     ///< reads of the position by SDO

    explicit Planned(const Options& of_twin, Options of_drive = {}) : Manners(of_twin, std::move(of_drive)) {
        crossed = [this](const Frame& f) {
            note(f);
            if (f.id >= 0x180 && f.id < 0x580) ++pdos[f.id];
            const auto d = f.data();
            polled += f.id == 0x605 && d[0] == 0x40 && d[1] == 0x64 && d[2] == 0x60;
        };
        run(2s);
    }
    [[nodiscard]] std::string told() const {
        std::string text;
        for (const Notice& n : notices)
            if (n.kind == "drive_lacks") text += n.text + "\n";
        return text;
    }
    void expect_pdos(std::initializer_list<std::uint32_t> reports) {
        pdos.clear();
        polled = 0;
        run(500ms);
        for (std::uint32_t id = 0x180; id < 0x580; ++id) {
            const bool wanted = std::ranges::find(reports, id) != reports.end();
            if (pdos.contains(id) != wanted) ADD_FAILURE() << std::hex << id << (wanted ? " does not come" : " comes");
        }
        EXPECT_EQ(polled > 0, reports.size() == 0) << "the position is read by SDO";
    }
    void expect_moves() {
        ASSERT_TRUE(link.online) << link.text;
        ASSERT_TRUE(enable());
        const Result r = ask(LineBench::to(static_cast<std::int64_t>(place()) + 5'000));
        ASSERT_TRUE(good(r)) << r.text;
        run(200ms);
        EXPECT_TRUE(axis.moving);
        EXPECT_NEAR(static_cast<double>(axis.velocity), speed(), 3'000);
        run(3s);
        EXPECT_FALSE(axis.moving);
        EXPECT_TRUE(axis.target_reached);
        EXPECT_EQ(axis.position, static_cast<std::int64_t>(place()));
        ASSERT_TRUE(good(ask(speed_of(6'000))));
        run(500ms);
        EXPECT_NEAR(static_cast<double>(axis.velocity), 6'000, 400);
        ASSERT_TRUE(good(ask(QuickStop{})));
        run(1s);
        EXPECT_FALSE(axis.moving);
        ASSERT_TRUE(enable());
    }
    static Move speed_of(std::int64_t v) { return test::speed(v); }
    /// The set-points of two seconds; where the axis is then, from its place before.
    double followed(SetPoint::Mode mode, std::int64_t value) {
        const double before = place();
        stream_ends.clear();
        for (int i = 0; i < 100 && stream_ends.empty(); ++i) {
            SetPoint p = led_to(mode == SetPoint::Mode::position ? static_cast<std::int64_t>(before) + value : value, 8'000);
            p.mode = mode;
            follow(p);
            run(20ms);
        }
        return place() - before;
    }
};

TEST(Cia402PdoPlan, TheGatewaysMappingWhereItIsTaken) {
    Planned b({});
    b.expect_pdos({0x185, 0x285});
    EXPECT_EQ(b.told(), "");
    b.expect_moves();
    EXPECT_NEAR(b.followed(SetPoint::Mode::position, 6'000), 6'000, 1);
}

TEST(Cia402PdoPlan, FurtherPdosOfTheDriveAreSwitchedOff) {
    Planned b({{"extra_tpdos", "3"}});
    b.expect_pdos({0x185, 0x285});
    Planned none({{"extra_tpdos", "3"}}, {{"pdo_plan", "sdo"}});
    none.expect_pdos({});
    none.expect_moves();
}

TEST(Cia402PdoPlan, AFixedMappingIsUsedAsItIs) {
    Planned b({{"pdo_setup", "3"}});
    b.expect_pdos({0x185, 0x285, 0x385});
    EXPECT_NE(b.told().find("the mapping of its PDOs is fixed, and is used as it is"), std::string::npos) << b.told();
    EXPECT_NE(b.told().find("6062h is in none of its PDOs"), std::string::npos);
    EXPECT_NE(b.told().find("6061h is in none of its PDOs"), std::string::npos);
    b.expect_moves();
    EXPECT_NEAR(b.followed(SetPoint::Mode::position, 6'000), 6'000, 1);
    EXPECT_GT(b.followed(SetPoint::Mode::velocity, 3'000), 3'000);
    ASSERT_TRUE(good(b.ask(Halt{})));
    b.run(500ms);
    EXPECT_GT(b.followed(SetPoint::Mode::torque, 100), 0);
}

TEST(Cia402PdoPlan, AFixedMappingWithTheControlWordBesideTheTarget) {
    for (const char* strict : {"0", "2"}) {
        SCOPED_TRACE(strict);
        Planned b({{"pdo_setup", "3"}, {"pdo_defaults", "1"}, {"strict_cob_id", strict}});
        b.expect_pdos({0x285, 0x385, 0x485});
        b.expect_moves();
        EXPECT_NEAR(b.followed(SetPoint::Mode::position, 6'000), 6'000, 1);
        // The target of the stream carries the control word: a stop that was sent by SDO beside it must not be taken back.
        for (int i = 0; i < 30; ++i) {
            b.follow(led_to(1'000'000, 8'000));
            b.run(20ms);
        }
        EXPECT_GT(b.speed(), 1'000);
        ASSERT_TRUE(good(b.ask(Halt{})));
        b.run(1s);
        EXPECT_EQ(b.speed(), 0);
        EXPECT_GT(b.followed(SetPoint::Mode::velocity, 3'000), 3'000);
        ASSERT_TRUE(good(b.ask(Halt{})));
        b.run(500ms);
        (void)b.followed(SetPoint::Mode::torque, 100);
        ASSERT_EQ(b.stream_ends.size(), 1u) << "it has no PDO for a torque";
        EXPECT_EQ(b.stream_ends[0].reason, Reason::not_supported);
    }
}

TEST(Cia402PdoPlan, AFixedMappingIsFoundAgainByTheNextGateway) {
    Planned b({{"pdo_setup", "3"}}, {{"watchdog_action", "none"}});
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(test::speed(8'000))));
    b.run(500ms);
    b.restart_gateway();
    b.run(3s);
    EXPECT_TRUE(b.link.online);
    EXPECT_NEAR(b.speed(), 8'000, 1) << "it goes on undisturbed";
    EXPECT_TRUE(b.axis.moving);
    ASSERT_TRUE(good(b.ask(QuickStop{})));
    b.run(3s);
    b.expect_pdos({0x185, 0x285, 0x385});
    b.expect_moves();
}

TEST(Cia402PdoPlan, FixedPdosThatComeByEventAreNoReports) {
    Planned b({{"pdo_setup", "3"}, {"pdo_types_fixed", "1"}});
    b.expect_pdos({});
    EXPECT_NE(b.told().find("read by SDO"), std::string::npos) << b.told();
    b.expect_moves();
}

TEST(Cia402PdoPlan, TargetsOfAFixedTypeTakeEffectAtOnce) {
    for (const char* setup : {"0", "2", "3"}) {
        SCOPED_TRACE(setup);
        Planned b({{"pdo_types_fixed", "1"}, {"pdo_setup", setup}});
        b.expect_pdos({});
        ASSERT_TRUE(b.enable());
        EXPECT_NEAR(b.followed(SetPoint::Mode::position, 6'000), 6'000, 1);
    }
}

TEST(Cia402PdoPlan, EntriesThatTheDriveDoesNotMapAreLeftOut) {
    for (const int mask : {1, 2, 4, 5, 6, 7}) {
        SCOPED_TRACE(mask);
        Planned b({{"unmappable", std::to_string(mask)}});
        if ((mask & 6) == 6)
            b.expect_pdos({0x185});
        else
            b.expect_pdos({0x185, 0x285});
        EXPECT_EQ(b.told().find("6061h is in none") != std::string::npos, (mask & 1) != 0) << b.told();
        EXPECT_EQ(b.told().find("606Ch is in none") != std::string::npos, (mask & 2) != 0) << b.told();
        EXPECT_EQ(b.told().find("6062h is in none") != std::string::npos, (mask & 4) != 0) << b.told();
        b.expect_moves();
        EXPECT_NEAR(b.followed(SetPoint::Mode::position, 6'000), 6'000, 1);
    }
}

TEST(Cia402PdoPlan, TheSiteNamesThePlan) {
    Planned sdo({}, {{"pdo_plan", "sdo"}});
    sdo.expect_pdos({});
    sdo.expect_moves();
    EXPECT_NEAR(sdo.followed(SetPoint::Mode::position, 6'000), 6'000, 1) << "targets have PDOs all the same";
    Planned file({{"pdo_defaults", "1"}}, {{"pdo_plan", "file"}});
    file.expect_pdos({0x285, 0x385, 0x485});
    file.expect_moves();
    EXPECT_NEAR(file.followed(SetPoint::Mode::position, 6'000), 6'000, 1);
    Planned free({{"unmappable", "4"}}, {{"pdo_plan", "free"}});
    free.expect_pdos({});
    free.expect_moves();
    Planned few({{"pdo_setup", "3"}}, {{"pdo_plan", "few"}});
    few.expect_pdos({});
    few.expect_moves();
}

// --- the choice ---------------------------------------------------------------------------------------------------------------

canopen::Pdo pdo(canopen::PdoDirection direction, std::uint16_t number, std::uint32_t id, canopen::PdoMapping mapping) {
    canopen::Pdo p;
    p.direction = direction;
    p.number = number;
    p.settings.id = id;
    p.mapping = std::move(mapping);
    return p;
}
constexpr canopen::MappedEntry word{object::statusword, 16}, place{object::position, 32}, turning{object::velocity, 32},
    shown{object::mode_shown, 8}, control{object::controlword, 16}, target{object::target_position, 32}, unknown{{0x2000, 1}, 16},
    gap{{0x0005, 0}, 8};
constexpr auto transmit = canopen::PdoDirection::transmit, receive = canopen::PdoDirection::receive;

std::vector<int> numbers(const std::vector<canopen::Pdo>& pdos) {
    std::vector<int> out;
    for (const auto& p : pdos)
        out.push_back(p.number);
    return out;
}

TEST(Cia402OwnPdos, TheFewestThatCarryTheMost) {
    const canopen::Pdo found[] = {pdo(transmit, 1, 0x185, {word}),        pdo(transmit, 2, 0, {word, shown}),
                                  pdo(transmit, 3, 0x385, {word, place}), pdo(transmit, 4, 0, {word, place, shown}),
                                  pdo(transmit, 5, 0, {turning}),         pdo(transmit, 6, 0x1A5, {turning, unknown})};
    const auto own = own_reports(found, 5, 0, 2);
    EXPECT_EQ(numbers(own), (std::vector<int>{4, 6})) << "5 has no identifier, and none in the connection set";
    EXPECT_EQ(own[0].settings.id, 0x485u);
    EXPECT_EQ(own[1].settings.id, 0x1A5u);
    for (const auto& p : own) {
        EXPECT_TRUE(p.settings.valid);
        EXPECT_EQ(p.settings.transmission, 2);
    }
    EXPECT_TRUE(own_reports(std::span(found).first(2), 5, 0, 1).empty()) << "no position";
    EXPECT_TRUE(own_reports(found, 5, 1, 1).empty()) << "nothing of the second axis";
}

TEST(Cia402OwnPdos, ATargetBesideValuesThatAreKnown) {
    const canopen::Pdo found[] = {pdo(receive, 1, 0x205, {control}), pdo(receive, 2, 0x305, {target, unknown}),
                                  pdo(receive, 3, 0x405, {control, gap, target}), pdo(transmit, 1, 0x185, {target})};
    const auto own = own_target(found, 5, object::target_position);
    ASSERT_TRUE(own);
    EXPECT_EQ(own->number, 3);
    EXPECT_EQ(own->settings.transmission, 1);
    EXPECT_FALSE(own_target(found, 5, object::target_velocity));
    EXPECT_EQ(target_bytes(own->mapping, {0x0F, 8, object::target_position, -2}),
              (std::vector<std::uint8_t>{0x0F, 0, 0, 0xFE, 0xFF, 0xFF, 0xFF}));
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
