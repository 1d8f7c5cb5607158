// Unit map: what stands behind one Modbus unit id. The standard map is one; a site's own maps (units 2..254) are others.
// In: checked requests (function, count and byte counts are right). Out: register and bit data, or the commands of a write.
// Never answers a client: the Responder turns its verdicts into answers.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/doors/modbus/refusals.hpp"
#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

enum class Table : std::uint8_t { coils, discrete_inputs, holding_registers, input_registers };

/// One Command of a write. Ticket and origin are added by the Responder.
struct PlannedCommand {
    AxisId axis = no_axis;
    CommandBody body;
    /// false: the client's answer waits for the Result. true: the map itself takes it, by on_own_result(note, result).
    bool own = false;
    std::uint32_t note = 0;
};
/// Commands of one request, in the order in which they are given to the engine; at most `max_commands`.
struct WritePlan {
    static constexpr std::size_t max_commands = 128;  ///< no write of Modbus touches more registers than that
    std::vector<PlannedCommand> commands;             // kept from request to request, so that nothing is allocated for it
};

/// Addresses are 0-based; address + count <= 65536 and count >= 1 hold for every call.
class UnitMap {
public:
    /// Whether a read of this range would be served now.
    [[nodiscard]] virtual Exception check_read(Table table, std::uint16_t address, std::uint16_t count) = 0;
    /// 2 * count bytes, big-endian, all of one picture per axis. After an exception `out` is undefined.
    [[nodiscard]] virtual Exception read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now,
                                                   std::uint8_t* out) = 0;
    /// (count + 7) / 8 bytes, first bit lowest, unused bits 0.
    [[nodiscard]] virtual Exception read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) = 0;
    /// Whether the register shows its whole value: what is to be changed in part (function 22) must be known.
    [[nodiscard]] virtual bool is_exact(std::uint16_t /*address*/, Instant /*now*/) { return true; }
    /// Whether a write to this range would be tried: address and writability, then halves of values, then the axis.
    [[nodiscard]] virtual Exception check_write(Table table, std::uint16_t address, std::uint16_t count) = 0;
    /// Plans a write. `data`: registers big-endian, or bits as in read_bits. All or nothing: with an exception, nothing has changed and
    /// `plan` is empty.
    [[nodiscard]] virtual Exception write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data,
                                          WritePlan& plan) = 0;
    /// The result of a command planned with `own`. If none comes in time, it is one with Reason::no_answer.
    virtual void on_own_result(std::uint32_t note, const Result& result) = 0;
    virtual ~UnitMap() = default;

    /// What was refused since it was last asked; Reason::none: nothing. A write may be good and refuse: a parameter channel shows it.
    [[nodiscard]] Refused take_refused() noexcept { return std::exchange(refused_, {}); }

protected:
    Exception refuse(Exception e, AxisId axis, Reason reason, std::string text) {
        refused_ = {axis, reason, std::move(text), {}, {}};
        return e;
    }
    Refused refused_;
};

}  // namespace axisgate::modbus
