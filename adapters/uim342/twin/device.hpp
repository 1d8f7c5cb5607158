// The drive as a whole: wire, registers, axis, inputs, flags and error history put together behind the Twin interface.
// In: frames, time, the hand. Out: acknowledgements, error reports, notifications.
// Never reads a clock; every event happens at its own instant, however late it is asked for.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/uim342/twin/axis.hpp"
#include "adapters/uim342/twin/errors.hpp"
#include "adapters/uim342/twin/inputs.hpp"
#include "adapters/uim342/twin/link.hpp"
#include "adapters/uim342/twin/manners.hpp"
#include "adapters/uim342/twin/memory.hpp"
#include "adapters/uim342/twin/wire.hpp"
#include "gateway/core/hand_table.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::uim342::twin {

/// Codes of error reports [L557-567].
enum class Fault : std::uint8_t {
    none = 0,
    syntax = 0x32,     ///< unknown control word, wrong length, SP before PR or PA
    data = 0x33,       ///< value not allowed
    sub_index = 0x34,  ///< index not allowed
    sd_below_dc = 0x3C,
    running = 0x3D,        ///< not while the motor runs
    driver_off = 0x3E,     ///< BG with MO = 0
    stopping = 0x3F,       ///< BG on the SD ramp or while locked
    origin_running = 0x41  ///< OG while the motor runs
};

/// Alarms: d1 of a notification with d0 = 0 [L593-600].
enum class Alarm : std::uint8_t {
    none = 0,
    emergency_lock = 0x0A,
    overspeed = 0x19,
    lower_limit = 0x1A,
    upper_limit = 0x1B,
    stall = 0x1D,
    encoder_error = 0x1E,
    battery_low = 0x1F
};

struct Identity {
    std::array<std::uint8_t, 3> model{0x20, 0x0A, 0x11};  ///< d0..d2 of ML
    std::uint32_t serial = 0;
    std::uint16_t manufacturer = 0x0605;
    std::uint16_t vendor = 0x0807;
};

struct DeviceSetup {
    LineKind kind = LineKind::can;
    CrcRange crc = CrcRange::twelve;
    Form form = Form::crc12;  ///< of notifications, before the host has spoken
    Protocol factory;
    Identity identity;
    Manners manners;
    /// Of the bus, as PP[5] has it; nothing: not known, or a byte line, and then the drive hears whatever its own rate is.
    std::optional<std::uint8_t> bus_rate;
};

class Device final : public Twin {
public:
    explicit Device(const DeviceSetup& setup);

    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override { return next_; }
    [[nodiscard]] Acceptance acceptance() const noexcept override { return link_.acceptance(); }
    void power_on(const NonVolatile& memory, Instant now, Out& out) override;
    [[nodiscard]] NonVolatile non_volatile() const override;
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return memory_.revision(); }
    [[nodiscard]] std::vector<HandItem> hand() const override;
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override;
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override;

private:
    friend class DeviceReports;
    /// What the next motion will be, as instructions have set it.
    struct Wanted {
        std::uint8_t pending_group = 0;   ///< MF
        bool ptp = false;                 ///< DV[0]
        bool target_is_relative = false;  ///< PR or PA was set last
        std::int32_t speed = 0;           ///< DV[2], shared by JV and SP
        std::int32_t relative = 0;
        std::int32_t absolute = 0;
        /// MF directs one parameter GET or SET, then falls back to 0.
        [[nodiscard]] std::size_t take_group() noexcept { return std::exchange(pending_group, std::uint8_t{0}); }
    };
    struct Flags {  ///< of MS[0]
        bool paif = false, tlif = false, err = false, lock = false, output = false;
    };

    // --- life (device.cpp) ---
    void power_off(Instant now);
    void boot(Instant now, std::int32_t encoder_position, Duration takes);
    void boot_done(Instant at, Out& out);
    void power_on_actions(Instant at, Out& out);
    void settle(Instant now, Out& out);
    void step(Instant at, Out& out);
    [[nodiscard]] Instant earliest() const noexcept;
    void on_edge(Edge edge, Instant at, Out& out);
    void run_action(std::uint8_t action, std::size_t group, Instant at, Out& out);
    void emergency_stop_by_input(Instant at, Out& out);
    void on_axis(Axis::Event event, Instant at, Out& out);
    void configure_axis(Instant now);
    [[nodiscard]] Axis::Values values_of(std::size_t group) const noexcept;
    [[nodiscard]] bool may_start() const noexcept;
    void keep_position(Instant now) noexcept;

    // --- instructions (instructions.cpp, sets.cpp) ---
    void receive(const Telegram& t, Instant now, Out& out);
    void instruct(const Telegram& t, Instant now, Out& out);
    void restart(Instant now, Out& out);
    [[nodiscard]] Fault get(const Telegram& t, Instant now, Telegram& reply);
    [[nodiscard]] Fault get_indexed(const Telegram& t, Instant now, Telegram& reply) const;
    [[nodiscard]] Fault set(const Telegram& t, Instant now, Telegram& reply, Out& out);
    [[nodiscard]] Fault set_indexed(const Telegram& t, Instant now, Telegram& reply, Out& out);
    [[nodiscard]] Fault command_system(std::uint8_t i, Instant now, Out& out);
    [[nodiscard]] Fault set_motion_value(const Telegram& t, Telegram& reply);
    [[nodiscard]] Fault begin_motion(Instant now);
    [[nodiscard]] Fault set_driver(std::uint8_t value, Instant now);
    [[nodiscard]] Fault clear_error(const Telegram& t, Telegram& reply);

    // --- the hand (hand.cpp) ---
    static const HandRow<Device> conditions[];
    void set_alarm_condition(bool& condition, Alarm alarm, bool on, Instant now, Out& out);

    Identity identity_;
    Manners manners_;
    Link link_;
    Memory memory_;
    Axis axis_;
    Inputs inputs_;
    MessageReader reader_;

    // Outside conditions.
    bool powered_ = false;
    bool encoder_error_ = false;
    bool battery_low_ = false;
    double temperature_ = 25;  ///< deg C, of the motor
    Alarm injected_ = Alarm::none;

    // Since boot.
    bool online_ = false;
    // MT[0], QE[4] and IC[5] as they were at boot: later writes act after the next one.
    std::uint16_t microsteps_ = 16;
    std::uint16_t pulses_per_turn_ = 3200;
    bool absolute_ = false;
    bool enable_at_boot_ = false;
    Flags flags_;
    Wanted wanted_;
    ErrorHistory history_;
    std::int32_t saved_position_ = 0;  // of the absolute encoder

    // What a specimen shows or does later than the manual's drive.
    struct Notice {
        Instant at;
        std::array<std::uint8_t, 8> data;
        std::uint8_t size;
    };
    struct Status {
        Instant at;
        std::array<std::uint8_t, 2> bits;
        bool operator==(const Status&) const = default;
    };
    static constexpr std::size_t most_notices = 64;   ///< further ones are lost
    static constexpr std::size_t most_statuses = 64;  ///< the oldest go first
    std::deque<Notice> notices_;                      ///< in order of time
    std::deque<Status> statuses_;                     ///< changes of MS[0], oldest first
    std::uint64_t notified_ = 0;
    Instant arrive_at_ = never;
    Instant driver_on_at_ = never;
    Instant unasked_at_ = never;

    Instant boot_end_ = never;
    Instant actions_at_ = never;
    Out answer_;  ///< of an instruction whose notification is sent before it
    Instant last_ = Instant::min();
    Instant next_ = never;
};

}  // namespace axisgate::uim342::twin
