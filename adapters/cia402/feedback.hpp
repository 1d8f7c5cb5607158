// Feedback: what the PDOs of an axis tell, turned into its picture, and the watch whether they come.
// In: PDOs, answers that are newer than they, time. Out: feedback when both PDOs of one SYNC are here. Never mixes two instants in one
// picture.
#pragma once

#include <span>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_plans.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Axis;

class Feedback : public drive::Part<Axis> {
public:
    using Part::Part;

    void begin(Instant now);
    void forget() noexcept;
    /// Whatever was set up in it is gone, and so are its zero and what was ordered.
    void restarted();
    void on_status(std::span<const std::uint8_t> bytes, Turn& t);
    void on_motion(std::span<const std::uint8_t> bytes, Turn& t);
    void after_sync() noexcept;
    /// Read by SDO just now: newer than the last PDO.
    void on_status_word(std::uint32_t word, Turn& t);
    void on_position(std::int64_t position, Turn& t);
    /// Of an EMCY; 0: all errors are gone. The first one is the cause, what follows from it does not take its place.
    void on_error_code(std::uint16_t code) noexcept;
    /// Read by SDO, since its EMCY was lost.
    void error_code_read(const canopen::SdoEnd& end, Turn& t);
    [[nodiscard]] bool needs_error_code() const noexcept { return need_code_; }
    /// A motion or a homing has been ordered: what the last one attained must not stand for it.
    void ordered(Order order, Turn& t);

    /// What the axis brakes with has changed: told at once, where there is a picture already.
    void tell_rates(Turn& t);

    // --- whether PDOs come --------------------------------------------------------------------------------------------------
    [[nodiscard]] Instant check_at() const noexcept { return check_at_; }
    void look_soon(Instant at) noexcept { check_at_ = std::min(check_at_, at); }
    /// It has answered instead of sending PDOs. True: again and again; somebody has reset it, or taken them away.
    [[nodiscard]] bool deaf(Instant now) noexcept;

private:
    void learnt(Turn& t);
    void judge(Turn& t);
    void judge_order(unsigned statusword);
    void emit(Turn& t);
    void watch_power(unsigned statusword);
    [[nodiscard]] Course course() const noexcept;

    bool status_new_ = false, motion_new_ = false, need_code_ = false;
    bool seen_ = false;        ///< a whole picture has come since the start
    bool power_lost_ = false;  ///< it has left operation by itself, and has no voltage since
    int fallen_ = 0;           ///< pictures in a row of an axis that is off under a control word that enables it
    int fresh_ = 0;            ///< status words since a new set-point that do not tell of it yet
    Instant check_at_ = never;
    int deaf_ = 0;  ///< answers by SDO in a row without a PDO between them
};

}  // namespace axisgate::cia402_drive
