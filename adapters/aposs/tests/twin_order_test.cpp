// The frames of one identifier keep their order on the bus, however late the simulated controller sends them (CAN has no way to overtake
// within one identifier).
#include "adapters/aposs/tests/macs_bench.hpp"
#include "gateway/protocols/canopen/nmt.hpp"

namespace axisgate::aposs::test {
namespace {

struct LateMacs : Macs {
    LateMacs() {
        twin = macs({{"extra_pdo_ms", "2"}, {"reply_ms", "60"}});
        twin->power_on({}, now, out);
    }
    void set_late(std::uint16_t index, std::uint8_t sub, std::uint32_t v, int size) {
        send(canopen::sdo_frame(0x605, static_cast<std::uint8_t>(0x23 | (4 - size) << 2), {index, sub}, v));
        pass(100ms);
    }
};

TEST(ApossOrder, APdoByItsEventTimerDoesNotOvertakeOneBehindASync) {
    LateMacs b;
    b.set_late(0x1800, 1, 0x8000'0185, 4);
    b.set_late(0x1800, 2, 1, 1);
    b.set_late(0x1800, 5, 0, 2);
    b.set_late(0x1A00, 0, 0, 1);
    b.set_late(0x1A00, 1, 0x60640020, 4);
    b.set_late(0x1A00, 0, 1, 1);
    b.set_late(0x1800, 1, 0x0000'0185, 4);
    b.set_late(0x6060, 0, 3, 1);
    for (const std::uint32_t word : {6U, 7U, 0xFU})
        b.set_late(0x6040, 0, word, 2);
    b.set_late(0x60FF, 0, 4000, 4);
    b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
    b.pass(1s);
    b.out.clear();
    for (int i = 0; i < 100; ++i) {
        b.send(canopen::data_frame(0x80, {}));
        for (int ms = 0; ms < 10; ++ms)
            b.pass(1ms);
    }
    std::int64_t last = 0;
    std::size_t backwards = 0;
    for (const auto& tx : b.out.frames) {
        if (tx.frame.id != 0x185) continue;
        const auto place = canopen::as_signed(canopen::low_first(tx.frame.data()), 32);
        backwards += place < last ? 1 : 0;
        last = place;
    }
    EXPECT_GT(b.count(0x185), 500U);
    EXPECT_GT(last, 3000);
    EXPECT_EQ(backwards, 0U);
}

}  // namespace
}  // namespace axisgate::aposs::test
