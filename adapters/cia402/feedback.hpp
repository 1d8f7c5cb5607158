// Feedback turns the PDOs of an axis into its feedback and monitors that they arrive. Feedback is reported when all PDOs of one SYNC have
// arrived, so that it never mixes two instants. Values read by SDO that are newer than the last PDO are taken, too. If a measured value is
// in none of them, the velocity is calculated from the positions, the demand is the position, and the mode is the one that was ordered.
#pragma once

#include <optional>
#include <span>
#include <vector>

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
    /// The state of the axis is not known any more: orders wait for the next picture, but not for ever.
    void doubt(Instant now) noexcept { doubted_until_ = now + std::chrono::seconds(2); }
    [[nodiscard]] Instant doubted_until() const noexcept { return doubted_until_; }
    [[nodiscard]] bool doubts(Instant now) const noexcept { return now < doubted_until_; }
    void forget() noexcept;
    /// The node has restarted: its set-up, its zero position and its orders are lost.
    void restarted();
    /// A PDO of the axis; `which` counts its reports from 0.
    void on_report(std::size_t which, std::span<const std::uint8_t> bytes, Turn& t);
    /// A complete set that was read by SDO. A mode or velocity that the drive does not have is not used.
    void on_values(std::uint32_t status_word, std::int64_t position, int mode, std::int64_t velocity, Turn& t);
    void after_sync() noexcept;
    /// Read by SDO and newer than the last PDO.
    void on_status_word(std::uint32_t word, Turn& t);
    void on_position(std::int64_t position, Turn& t);
    /// From an EMCY; 0: no error any more. The first code is the cause; codes that follow do not replace it.
    void on_error_code(std::uint16_t code) noexcept;
    /// Read by SDO, because the EMCY was lost.
    void error_code_read(const canopen::SdoEnd& end, Turn& t);
    [[nodiscard]] bool needs_error_code() const noexcept { return need_code_; }
    /// A motion or homing was ordered: the result of the previous one must not count for it. `target` is the place of a positioning.
    void ordered(Order order, std::optional<std::int64_t> target, Turn& t);

    /// The deceleration in force has changed: it is reported at once if feedback was reported before.
    void tell_rates(Turn& t);

    // --- monitoring of the PDOs ---------------------------------------------------------------------------------------------
    [[nodiscard]] Instant check_at() const noexcept { return check_at_; }
    void look_soon(Instant at) noexcept;
    /// The node has answered by SDO but sends no PDOs. True: this has happened several times; the node was reset, or another master has
    /// disabled its PDOs.
    [[nodiscard]] bool deaf(Instant now) noexcept;

private:
    void learnt(Turn& t);
    void take(Address object, std::uint64_t raw, std::uint8_t bits, Turn& t);
    void look_by(Instant at) noexcept;
    void calculate_velocity(Instant now) noexcept;
    void judge(Turn& t);
    void judge_order(unsigned statusword, Instant now);
    [[nodiscard]] bool may_have_arrived(Instant now) const noexcept;
    [[nodiscard]] bool near_target() const noexcept;
    void emit(Turn& t);
    void watch_power(unsigned statusword);
    [[nodiscard]] bool older_than_power(unsigned statusword, Instant now) noexcept;
    [[nodiscard]] Course course() const noexcept;

    std::vector<std::uint64_t> raw_{};  ///< entries of the last PDO
    unsigned fresh_reports_ = 0;        ///< bit by report: it has arrived in the present cycle
    bool need_code_ = false;
    bool seen_ = false;         ///< complete feedback has arrived since the start
    bool power_lost_ = false;   ///< the drive has left operation by itself, and has had no voltage since
    bool power_shown_ = false;  ///< a report has shown operation or a fault since the control word enables the axis
    Instant enabled_at_{};      ///< the last report before that control word
    std::uint32_t judged_ = 0;  ///< the status word of the picture
    int fallen_ = 0;            ///< reports in succession of an axis that is off under a control word that enables it
    int fresh_ = 0;             ///< status words since a new set-point that do not concern it yet
    bool left_ = false;         ///< since the order, the drive has shown that the target is not reached
    std::int64_t way_ = 0;      ///< of the positioning, from its begin to its target
    Instant ordered_at_{};
    Instant check_at_ = never;
    Instant doubted_until_{};
    Instant place_at_{};  ///< of the position from which the velocity is calculated
    std::int64_t place_ = 0;
    int deaf_ = 0;  ///< SDO answers in succession without a PDO between them
};

}  // namespace axisgate::cia402_drive
