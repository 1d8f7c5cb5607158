// The words of a controller and the commands of a second client, for tests that distinguish the two.
#pragma once

#include <memory>
#include <string>

#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/unit/axis/cia402_bench.hpp"

namespace axisgate::cia402_bench {

inline const Origin controller{modbus::clients, std::make_shared<const std::string>("192.0.2.7:5"), {}};
inline const Origin bert{http::clients, std::make_shared<const std::string>("bert"), {}};

/// The one order of a decision, if it is of this kind.
template <class T>
const T* only(const Cia402Axis::Decision& d) {
    return d.orders.size() == 1 ? std::get_if<T>(&d.orders.front()) : nullptr;
}
/// Words of the controller, carried out.
inline Cia402Axis::Decision say(Bench& b, const ProcessData& d) {
    auto r = b.profile.on_process_data(d, controller);
    b.obey(r);
    return r;
}
inline Cia402Axis::Decision word(Bench& b, std::uint16_t controlword) {
    ProcessData d;
    d.controlword = controlword;
    return say(b, d);
}
inline ProcessData speed(std::int32_t v) {
    ProcessData d;
    d.target_velocity = v;
    return d;
}
inline ProcessData place(std::int32_t target, std::uint16_t controlword) {
    ProcessData d;
    d.target_position = target;
    d.controlword = controlword;
    return d;
}
inline void enable(Bench& b, std::int16_t mode) {
    ProcessData d;
    d.mode = mode;
    d.profile_velocity = 1000;
    (void)say(b, d);
    for (const int step : {0x06, 0x07, 0x0F})
        (void)word(b, static_cast<std::uint16_t>(step));
    ASSERT_EQ(b.profile.state(), PowerState::operation_enabled);
}

}  // namespace axisgate::cia402_bench
