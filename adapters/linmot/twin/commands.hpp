// Interpreter carries out the 216 motion commands of the manual in a simulated drive, from the motion command buffer, the command table and
// armed events. A header whose count did not change has no effect, and a command is carried out completely or not at all.
#pragma once

#include <cstdint>
#include <span>

#include "adapters/linmot/twin/states.hpp"

namespace axisgate::linmot::twin {

class Interpreter {
public:
    Interpreter(Body& body, States& states) : body_(body), states_(states) {}

    void power_on() noexcept { x4_outputs_ = x6_outputs_ = 0; }
    /// Writes the bytes of a telegram into the buffer; the command is executed if its count differs from the last one [L545-547].
    void write(std::span<const std::uint8_t> bytes, Instant now);
    /// An edge of the trigger input, after its filter.
    void edge(bool rising, Instant now);
    /// The armed event has occurred.
    void fire(Instant now);
    /// The queued motion begins.
    void start_queued(Instant now);
    /// The command table continues if its present entry has ended.
    void step_table(Instant now);

    [[nodiscard]] std::uint64_t commands_done() const noexcept { return commands_done_; }
    [[nodiscard]] std::uint16_t outputs_x4() const noexcept { return x4_outputs_; }
    [[nodiscard]] std::uint16_t outputs_x6() const noexcept { return x6_outputs_; }
    /// Whether this drive has the command; the count in the header is 0.
    [[nodiscard]] bool has(std::uint16_t header) const noexcept;
    /// Whether the manual lists the command.
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
