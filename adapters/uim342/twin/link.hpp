// Link: how the drive hears and speaks: its numbers on the line, its bit rate, and the host's way of speaking.
// In: telegrams to send. Out: frames; whether a telegram is for it. Never speaks on a bus with another bit rate than its own.
#pragma once

#include <optional>
#include <span>

#include "adapters/uim342/twin/memory.hpp"
#include "adapters/uim342/twin/wire.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::uim342::twin {

class Link {
public:
    /// `of_bus`: its rate as PP[5] has it; nothing: whatever it is, the drive hears.
    Link(LineKind of_kind, Form first_form, std::optional<std::uint8_t> of_bus) : kind(of_kind), bus_rate(of_bus), form(first_form) {}

    /// Later writes of PP act after the next boot.
    void boot(const Protocol& p) noexcept { node = p.node, group = p.group, bit_rate = p.bit_rate; }
    [[nodiscard]] bool on_the_bus() const noexcept { return !bus_rate || *bus_rate == bit_rate; }
    [[nodiscard]] bool is_for_me(std::uint8_t id) const noexcept { return id == node || id == global_id || id == group; }
    /// The same three on a CAN bus.
    [[nodiscard]] Acceptance acceptance() const noexcept;
    void send(const Telegram& telegram, Instant at, Out& out) const;
    /// To the master; of a specimen to every device.
    void notify(std::span<const std::uint8_t> data, Instant at, Out& out) const;

    const LineKind kind;
    const std::optional<std::uint8_t> bus_rate;
    Form form;  ///< of the byte line
    std::uint8_t node = 5, group = 10;
    std::uint8_t bit_rate = 2;  ///< as PP[5] was at boot
    std::uint8_t notifies = host_id;
    bool silent = false;  ///< nothing that it sends reaches the line
};

}  // namespace axisgate::uim342::twin
