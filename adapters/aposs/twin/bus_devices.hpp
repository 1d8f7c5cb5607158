// The devices on the controller's own bus: the objects that DRIVETYPE, ENCODERTYPE and MENCODERTYPE create automatically, and the control
// word that the controller sends to a drive [L1546-1690]. No frames of that bus are simulated, because the manual does not print the whole
// content of a drive's PDOs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "adapters/aposs/twin/coded.hpp"

namespace axisgate::aposs {

class BusDevices {
public:
    enum class By : std::uint8_t { drive, encoder, master };
    /// SET: the same value has no effect; another value deletes the objects and creates new ones, with NMT0 to the device.
    void set(int axis, By by, std::int64_t value);
    /// A program starts, or the power is switched on: all objects are created again.
    void forget() { axes_ = {}; }
    void canini() { ++of_application_; }        ///< does not change automatic objects
    void candel_all() { of_application_ = 0; }  ///< neither does CANDEL -1

    [[nodiscard]] bool guards() const;
    [[nodiscard]] std::int64_t initialised() const noexcept { return nmt0_; }
    /// Such as "DRIVETYPE x(2): PDO, SYNC, GUARD; application: 1", or "none".
    [[nodiscard]] std::string objects() const;

    // the control word of a bus drive; only that of the Servostar is printed completely [L1667-1682]
    void motor_on(int axis) { send(axis, 0x0F); }
    void motor_off(int axis, std::int64_t errcond) { send(axis, errcond == 4 ? 0x02 : 0x06); }
    /// Whether the axis is in error; a control word is sent when the error occurs.
    void failing(int axis, bool fails, std::int64_t errcond) {
        if (!std::exchange(of(axis).failing, fails) && fails) motor_off(axis, errcond);
    }
    /// OUTDA: the upper 16 bits are the control word [L1649]. False: the controller sets it itself (DRIVETYPE without 100).
    bool outda(int axis, std::int64_t value);
    [[nodiscard]] std::optional<std::uint16_t> control_word(int axis) const { return of(axis).word; }
    /// After a quick stop, a drive is enabled again only from ready to switch on.
    [[nodiscard]] bool drive_enabled(int axis) const { return of(axis).enabled; }

private:
    struct Axis {
        std::array<std::int64_t, 3> value{};
        std::optional<std::uint16_t> word;
        bool enabled = false, quick_stop = false, failing = false;
    };
    [[nodiscard]] Axis& of(int axis) { return axes_.at(static_cast<std::size_t>(axis)); }
    [[nodiscard]] const Axis& of(int axis) const { return axes_.at(static_cast<std::size_t>(axis)); }
    void send(int axis, std::uint16_t word);
    std::array<Axis, 2> axes_;
    std::int64_t nmt0_ = 0, of_application_ = 0;
};

}  // namespace axisgate::aposs
