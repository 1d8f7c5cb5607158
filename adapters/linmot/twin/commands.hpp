// The interpreter: what the 216 motion commands of the manual do in a simulated drive.
// In: the motion command buffer, entries of the command table, events. Out: what the parts begin and end, errors.
// Never moves for a header whose count did not change, and never carries out half a command.
#pragma once

#include <cstdint>
#include <span>

#include "adapters/linmot/twin/states.hpp"

namespace axisgate::linmot::twin {

class Interpreter {
public:
    Interpreter(Body& body, States& states) : body_(body), states_(states) {}

    void power_on() noexcept { x4_outputs_ = x6_outputs_ = 0; }
    /// The bytes of a telegram go into the buffer; executed if its count is another than the last [L545-547].
    void write(std::span<const std::uint8_t> bytes, Instant now);
    /// An edge behind its filter.
    void edge(bool rising, Instant now);
    /// The armed event has come.
    void fire(Instant now);
    /// The motion that was queued begins.
    void start_queued(Instant now);
    /// The command table goes on, if its entry is over.
    void step_table(Instant now);

    [[nodiscard]] std::uint64_t commands_done() const noexcept { return commands_done_; }
    [[nodiscard]] std::uint16_t outputs_x4() const noexcept { return x4_outputs_; }
    [[nodiscard]] std::uint16_t outputs_x6() const noexcept { return x6_outputs_; }
    /// Whether this drive has the command; the header with count 0.
    [[nodiscard]] bool has(std::uint16_t header) const noexcept;
    /// Whether the manual has it.
    [[nodiscard]] static bool listed(std::uint16_t header) noexcept;

private:
    void execute(std::uint16_t header, const Bytes& b, bool from_table, Instant now);
    [[nodiscard]] Fault carry_out(std::uint16_t header, const Bytes& b, bool from_table, Instant now);
    // commands.cpp
    void general(std::uint8_t sub, const Bytes& b, Instant now);
    void rename(const Bytes& b, Instant now);
    [[nodiscard]] Fault interpolator(std::uint16_t header, const Bytes& b, Instant now);
    [[nodiscard]] Order order_of_position(std::uint8_t sub, const Bytes& b) const;
    void arm_order(const Order& order);
    void begin(Order order, bool endless, Instant now);
    void arm(Armed::Kind kind, Armed::What what, std::uint8_t sub, const Bytes& b);
    void start(const Order& order, Instant now);
    // commands_following.cpp
    [[nodiscard]] Fault curve(std::uint16_t header, const Bytes& b, Instant now);
    [[nodiscard]] Fault cam(std::uint16_t header, const Bytes& b, Instant now);
    [[nodiscard]] Fault cams(std::uint8_t sub, const Bytes& b, Instant now);
    [[nodiscard]] Fault shot(std::uint8_t sub, const Bytes& b, Instant now);
    [[nodiscard]] Fault winding(std::uint16_t header, const Bytes& b, Instant now);
    [[nodiscard]] Fault couple(Coupling::Mode mode, Instant now);
    void force(std::uint8_t sub, const Bytes& b, Instant now);
    // commands_table.cpp
    [[nodiscard]] Fault table(std::uint16_t header, const Bytes& b, bool from_table, Instant now);
    [[nodiscard]] Fault entry(std::uint8_t sub, const Bytes& b, Instant now);
    [[nodiscard]] Fault variable(std::uint8_t sub, const Bytes& b);
    void start_entry(std::uint16_t id, Instant now);
    [[nodiscard]] Watched watched(Instant now) const;

    Body& body_;
    States& states_;
    std::uint64_t commands_done_ = 0;
    std::uint16_t x4_outputs_ = 0, x6_outputs_ = 0;
};

}  // namespace axisgate::linmot::twin
