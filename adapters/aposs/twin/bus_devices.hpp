// Devices on the controller's own bus: the objects that DRIVETYPE, ENCODERTYPE and MENCODERTYPE make by themselves, and the control word
// that the controller sends a drive [L1546-1690]. In: values that are set, starts of programs, what the axes are told. Out: which objects
// there are, who is guarded, the word. Never a frame of that bus: what the PDOs of a drive hold besides is not all printed.
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
    /// SET: the same value again does nothing; another one takes the objects away and makes new ones, with NMT0 to the device.
    void set(int axis, By by, std::int64_t value);
    /// A program starts, or power comes: all objects are made anew.
    void forget() { axes_ = {}; }
    void canini() { ++of_application_; }        ///< touches no automatic object
    void candel_all() { of_application_ = 0; }  ///< nor does CANDEL -1

    [[nodiscard]] bool guards() const;
    [[nodiscard]] std::int64_t initialised() const noexcept { return nmt0_; }
    /// Such as "DRIVETYPE x(2): PDO, SYNC, GUARD; application: 1", or "none".
    [[nodiscard]] std::string objects() const;

    // the control word of a bus drive: of the Servostar alone all of it is printed [L1667-1682]
    void motor_on(int axis) { send(axis, 0x0F); }
    void motor_off(int axis, std::int64_t errcond) { send(axis, errcond == 4 ? 0x02 : 0x06); }
    /// The axis is in error, or not: a word goes out when it comes.
    void failing(int axis, bool fails, std::int64_t errcond) {
        if (!std::exchange(of(axis).failing, fails) && fails) motor_off(axis, errcond);
    }
    /// OUTDA: the upper 16 bits are the word [L1649]. False: the controller keeps it itself (DRIVETYPE without 100).
    bool outda(int axis, std::int64_t value);
    [[nodiscard]] std::optional<std::uint16_t> control_word(int axis) const { return of(axis).word; }
    /// A drive that was stopped quickly is enabled again from ready to switch on alone.
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
