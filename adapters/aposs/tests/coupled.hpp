// A synchronisation without a controller, for tests: a slave without lag, a master in whole quad counts, index pulses of both.
#pragma once

#include <optional>
#include <utility>

#include "adapters/aposs/twin/coupling.hpp"
#include "adapters/aposs/twin/synchronisation.hpp"

namespace axisgate::aposs::test {

inline SyncParameters quick() {
    SyncParameters p;
    p.velocity = 1000;
    p.acceleration = p.deceleration = 1000;
    return p;
}
/// A slave without lag and a master at a constant speed; index pulses if the test sets them.
struct Coupled {
    SyncParameters p = quick();
    Synchronisation s;
    std::int64_t master = 0, speed = 10;
    double slave = 0;
    std::int64_t marks_m = 0;  ///< distance of master markers, 0: none
    double marks_s = 0, first_s = 0;
    Coupled() = default;
    void begin(SyncMode mode) {
        SyncInput in;
        in.master = master;
        in.slave = slave;
        s.begin(mode, p, in, slave, 0);
    }
    double pass(int ms) {
        for (int i = 0; i < ms; ++i) {
            SyncInput in;
            in.slave = slave;
            in.slave_marker = std::exchange(latched, std::nullopt);  // of the previous step
            if (const auto m =
                    index_between(static_cast<double>(master), static_cast<double>(master + speed), static_cast<double>(marks_m)))
                in.master_marker = static_cast<std::int64_t>(*m);
            in.master = master += speed;
            const double next = s.step(p, in);
            if (const auto m = index_between(slave - first_s, next - first_s, marks_s)) latched = *m + first_s;
            slave = next;
        }
        return slave;
    }
    std::optional<double> latched;
};

}  // namespace axisgate::aposs::test
