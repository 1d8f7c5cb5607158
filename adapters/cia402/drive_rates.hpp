// Rates holds the speed and the ramps that are in force in an axis: 6081h, 6083h, 6084h, 6085h, and by 605Ah which of them a quick stop
// uses. Only values that the drive has reported or acknowledged are shown: a value that may have changed is unknown until it is read again.
#pragma once

#include <array>
#include <optional>

#include "adapters/cia402/drive_steps.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/drive/turn.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Axis;

class Rates : public drive::Part<Axis> {
public:
    using Part::Part;
    static constexpr std::array objects{object::profile_velocity, object::profile_acceleration, object::profile_deceleration,
                                        object::quick_stop_deceleration, object::quick_stop_option};

    /// The values may have changed: they are unknown, and read again at once.
    void ask(drive::Turn& t);
    /// The start reads the values that were to be read.
    void forget() noexcept { at_ = objects.size(), told_ = {}; }
    [[nodiscard]] bool wants() const noexcept { return at_ < objects.size(); }
    [[nodiscard]] Step next() const { return {Step::Kind::read, objects[at_], {}}; }
    void answered(const canopen::SdoEnd& end, drive::Turn& t);
    /// A value was read, or a write was acknowledged. `address` is that of the first axis.
    void take(Address address, std::optional<std::int64_t> value) noexcept;
    /// An object was written by any command; `address` is that of the first axis. `by_order`: the value belongs to a motion and is valid as
    /// acknowledged.
    void written(Address address, std::int64_t value, bool by_order, drive::Turn& t);
    /// A write to this object may change one of the values: the rates, their limits and units, and manufacturer objects.
    [[nodiscard]] static bool hang_on(Address address) noexcept;
    /// Increments/s and increments/s^2. A quick stop that does not use 6084h or 6085h (605Ah) has no rate.
    [[nodiscard]] DriveRates in_force() const noexcept;

private:
    std::array<std::optional<std::int64_t>, objects.size()> told_{};
    std::size_t at_ = objects.size();  ///< the next one to be read
};

}  // namespace axisgate::cia402_drive
