// The adapter and controllers that show their status word late: what was shown before a stop answers no command behind it.
#include "adapters/aposs/family.hpp"
#include "adapters/aposs/tests/macs.hpp"
#include "adapters/cia402/tests/line_bench.hpp"

namespace axisgate::aposs::test {
namespace {
using namespace std::chrono_literals;

struct Late : cia402_drive::test::LineBench {
    explicit Late(std::map<std::string, std::string> freedoms) : LineBench(page(), 1) {
        bus->add(DriveId{0}, macs(std::move(freedoms)), {}, now);
        open();
        run(3s);
    }
    static Move turn() {
        Move m;
        m.kind = Move::Kind::velocity;
        m.target = 4000;
        m.acceleration = m.deceleration = 20'000;
        return m;
    }
    void rest() {
        for (int i = 0; i < 5000 && speed() != 0; ++i)
            run(1ms);
        EXPECT_EQ(speed(), 0);
    }
};

TEST(ApossLateStatus, AnEnableBehindAStopIsNotAnsweredByAnOlderStatusWord) {
    for (const char* lacks : {"0", "2"}) {  // with 605Ah and without it: then the quick stop ends without power
        for (const char* late : {"0", "80", "294", "500"}) {
            for (const CommandBody& stop : {CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
                SCOPED_TRACE(std::string(lacks) + " " + late + " " + std::string(name_of(stop)));
                Late b({{"reply_ms", "74"}, {"status_late_ms", late}, {"lacking_objects", lacks}});
                ASSERT_TRUE(b.enable());
                for (int i = 0; i < 3; ++i) {
                    ASSERT_TRUE(good(b.ask(Late::turn())));
                    b.run(2s);
                    ASSERT_GT(b.speed(), 3000);
                    ASSERT_TRUE(good(b.ask(stop)));
                    b.rest();
                    const Result on = b.ask(Enable{});
                    ASSERT_TRUE(good(on)) << on.text;
                }
            }
        }
    }
}

TEST(ApossLateStatus, AMoveBehindAStopIsRefusedAlthoughTheStatusWordIsStillThatOfBefore) {
    for (const CommandBody& stop : {CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        Late b({{"status_late_ms", "500"}});
        ASSERT_TRUE(b.enable());
        ASSERT_TRUE(good(b.ask(Late::turn())));
        b.run(1s);
        ASSERT_TRUE(good(b.ask(stop)));
        b.rest();
        const Result r = b.ask(Late::turn());
        EXPECT_EQ(r.outcome, Outcome::refused) << name_of(stop);
        EXPECT_EQ(r.reason, Reason::wrong_state) << r.text;
        b.run(2s);
        EXPECT_EQ(b.speed(), 0) << name_of(stop);
    }
}

}  // namespace
}  // namespace axisgate::aposs::test
