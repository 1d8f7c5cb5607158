// Feedback turns the PDOs of an axis into its feedback and monitors that they arrive. Feedback is reported when both PDOs of one SYNC have
// arrived, so that it never mixes two instants. Values read by SDO that are newer than the last PDO are taken, too.
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
    /// The node has restarted: its set-up, its zero position and its orders are lost.
    void restarted();
    void on_status(std::span<const std::uint8_t> bytes, Turn& t);
    void on_motion(std::span<const std::uint8_t> bytes, Turn& t);
    void after_sync() noexcept;
    /// Read by SDO and newer than the last PDO.
    void on_status_word(std::uint32_t word, Turn& t);
    void on_position(std::int64_t position, Turn& t);
    /// From an EMCY; 0: no error any more. The first code is the cause; codes that follow do not replace it.
    void on_error_code(std::uint16_t code) noexcept;
    /// Read by SDO, because the EMCY was lost.
    void error_code_read(const canopen::SdoEnd& end, Turn& t);
    [[nodiscard]] bool needs_error_code() const noexcept { return need_code_; }
    /// A motion or homing was ordered: the result of the previous one must not count for it.
    void ordered(Order order, Turn& t);

    /// The deceleration in force has changed: it is reported at once if feedback was reported before.
    void tell_rates(Turn& t);

    // --- monitoring of the PDOs ---------------------------------------------------------------------------------------------
    [[nodiscard]] Instant check_at() const noexcept { return check_at_; }
    void look_soon(Instant at) noexcept { check_at_ = std::min(check_at_, at); }
    /// The node has answered by SDO but sends no PDOs. True: this has happened several times; the node was reset, or another master has
    /// disabled its PDOs.
    [[nodiscard]] bool deaf(Instant now) noexcept;

private:
    void learnt(Turn& t);
    void judge(Turn& t);
    void judge_order(unsigned statusword);
    void emit(Turn& t);
    void watch_power(unsigned statusword);
    [[nodiscard]] Course course() const noexcept;

    bool status_new_ = false, motion_new_ = false, need_code_ = false;
    bool seen_ = false;        ///< complete feedback has arrived since the start
    bool power_lost_ = false;  ///< the drive has left operation by itself, and has had no voltage since
    int fallen_ = 0;           ///< reports in succession of an axis that is off under a control word that enables it
    int fresh_ = 0;            ///< status words since a new set-point that do not concern it yet
    Instant check_at_ = never;
    int deaf_ = 0;  ///< SDO answers in succession without a PDO between them
};

}  // namespace axisgate::cia402_drive
