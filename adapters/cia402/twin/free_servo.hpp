// FreeServo is a servo with the freedoms of the page: when it samples its control word, shows a mode and sets its status bits, which modes
// it refuses, whether it monitors the stream of a cyclic mode, and how its shaft follows.
#pragma once

#include <algorithm>
#include <array>

#include "adapters/cia402/twin/freedoms.hpp"
#include "adapters/cia402/twin/servo.hpp"

namespace axisgate::cia402_drive::twin {

class FreeServo final : public Servo {
public:
    using Servo::Servo;
    /// From now on.
    void set_freedoms(const Freedoms& freedoms, Instant now);

    void power_on(Instant now) override;
    [[nodiscard]] canopen::Abort may_write(canopen::Address address, std::int64_t value, Instant now) const override;
    void written(canopen::Address address, Instant now) override;
    void on_sync(Instant now) override;
    void refresh(Instant now) override;
    [[nodiscard]] Instant next_event(Instant now) const override;
    void on_event(Instant at) override;

private:
    struct Late {
        Instant sample = never;  ///< when the written control word is sampled
        Instant mode = never;    ///< when the ordered mode is in force
        Instant shown = never;   ///< when bit 12 acknowledges the accepted set-point
        [[nodiscard]] Instant first() const noexcept { return std::min({sample, mode, shown}); }
    };
    /// A bit of the status word that is set late: when it will be, and whether it is.
    struct LateBit {
        unsigned bit;
        Instant due = never;
        bool set = false;
    };
    /// The drive's own watch of a cyclic mode: when a missing SYNC, and a missing target, is a fault.
    struct Stream {
        Instant sync = never, target = never;
        bool fresh = false;  ///< a target has arrived since the last SYNC
        [[nodiscard]] Instant first() const noexcept { return std::min(sync, target); }
    };
    void take(canopen::Address address, Instant now);
    void take_late(Instant at);
    void sample(Instant now);
    void acknowledge(Instant now);
    [[nodiscard]] bool refuses_mode(std::int64_t mode, Instant now) const;
    void note_bits(Instant now);
    [[nodiscard]] std::uint16_t shown_statusword(Instant now) const;
    void stream_stopped(Instant at);

    Freedoms free_;
    Late late_;
    std::array<LateBit, 3> bits_{{{0x400}, {0x1000}, {0x2000}}};
    Stream stream_;
    bool shown_ = true;     ///< bit 12 has acknowledged the set-point
    bool waiting_ = false;  ///< the set-point is acknowledged when it is taken
};

}  // namespace axisgate::cia402_drive::twin
