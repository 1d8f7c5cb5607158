// Polled reads the values of an axis by SDO, one after the other. It replaces the PDOs of a drive that cannot set them up, and those of a
// drive that does not set them up while it moves.
#pragma once

#include <array>

#include "adapters/cia402/drive_steps.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/drive/turn.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Axis;

class Polled : public drive::Part<Axis> {
public:
    using Part::Part;

    /// When the next value is read; at once within a round.
    [[nodiscard]] Instant due() const noexcept { return at_ == 0 ? look_at_ : Instant{}; }
    [[nodiscard]] Step next() const;
    /// True: the round is complete, and its values are in the feedback of the axis.
    bool answered(const canopen::SdoEnd& end, drive::Turn& t);
    /// A command has read the status word: the one of the round that is under way is older.
    void saw_status(std::uint32_t word) noexcept { values_[0] = word; }
    /// The next round begins at once.
    void begin_anew() noexcept { at_ = 0, look_at_ = {}; }

private:
    [[nodiscard]] bool skipped(std::size_t value) const noexcept;

    std::size_t at_ = 0;
    Instant look_at_{};
    std::array<std::int64_t, 4> values_{};
};

}  // namespace axisgate::cia402_drive
