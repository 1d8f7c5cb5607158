// Rates: the speed and the ramps that an axis has in force, as its drive has told or acknowledged them: 6081h, 6083h, 6084h, 6085h, and by
// 605Ah which of them a quick stop uses. In: answers to reads and writes. Out: what feedback shows; the next read while one is to be asked.
// Never a value that the drive has not told: what may have changed is unknown until it is read again.
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

    /// They may be others now: unknown, and asked again at once.
    void ask(drive::Turn& t);
    /// What was to be asked is read by the start.
    void forget() noexcept { at_ = objects.size(), told_ = {}; }
    [[nodiscard]] bool wants() const noexcept { return at_ < objects.size(); }
    [[nodiscard]] Step next() const { return {Step::Kind::read, objects[at_], {}}; }
    void answered(const canopen::SdoEnd& end, drive::Turn& t);
    /// One of them has been read, or a write of one was acknowledged. `address` is the first axis'.
    void take(Address address, std::optional<std::int64_t> value) noexcept;
    /// Whatever wrote it: an object of the first axis. `by_order`: a motion's own value, which stands as acknowledged.
    void written(Address address, std::int64_t value, bool by_order, drive::Turn& t);
    /// A write to this object may change one of them: the rates, their limits and units, what is the maker's own.
    [[nodiscard]] static bool hang_on(Address address) noexcept;
    /// Increments/s and increments/s^2. A quick stop that does not run on 6084h or 6085h (605Ah) has none.
    [[nodiscard]] DriveRates in_force() const noexcept;

private:
    std::array<std::optional<std::int64_t>, objects.size()> told_{};
    std::size_t at_ = objects.size();  ///< the next one to be asked
};

}  // namespace axisgate::cia402_drive
