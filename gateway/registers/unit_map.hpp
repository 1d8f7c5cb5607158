// Unit map: what stands behind one unit id. The standard map is one; the user maps of a site (units 2..254) are others.
// In: checked requests (function, count and byte counts are right). Out: register and bit data, or the commands of a write.
// Never answers a client, and knows no protocol: the doors turn verdicts into their own codes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate::registers {

using Table = MapTable;

/// What became of a request. The numbers are those of Modbus' exceptions, under which people know them.
enum class Verdict : std::uint8_t {
    good = 0,
    no_address = 2,  ///< not mapped, not writable, or beyond 65535
    bad_value = 3,   ///< value out of range, half of a 32-bit value
    failed = 4,      ///< the drive refused or failed
    busy = 6,
    no_path = 0x0A,   ///< no such unit, the axis is not configured, or its line is down
    no_answer = 0x0B  ///< the drive did not answer in time
};
/// The verdict that tells a client why its write did not succeed.
[[nodiscard]] constexpr Verdict verdict_of(Reason reason) noexcept {
    switch (reason) {
        case Reason::out_of_range:
            return Verdict::bad_value;
        case Reason::unknown_point:
        case Reason::not_writable:
            return Verdict::no_address;
        case Reason::busy:
        case Reason::authority:
            return Verdict::busy;
        case Reason::line_down:
            return Verdict::no_path;
        case Reason::no_answer:
            return Verdict::no_answer;
        case Reason::none:
        case Reason::wrong_state:
        case Reason::not_supported:
        case Reason::drive_refused:
        case Reason::interrupted:
        case Reason::not_stored:
        case Reason::internal:
            break;
    }
    return Verdict::failed;
}
/// `good` for a good result; a bad result is never `good`, whatever its reason says.
[[nodiscard]] inline Verdict verdict_of(const Result& result) noexcept {
    return axisgate::good(result) ? Verdict::good : verdict_of(result.reason);
}

/// What a reader that is no door of its own gets.
struct RegisterRead {
    Verdict verdict = Verdict::good;
    std::vector<std::uint8_t> bytes;  ///< registers big-endian, or bits, the first one lowest; none unless good
};

/// Why a request was refused, in the words of the other doors.
struct Refused {
    AxisId axis = no_axis;
    Reason reason = Reason::none;
    std::string text;
    std::string parameter, value;  ///< of a parameter: its id, and what was to be written
};

/// One Command of a write. Ticket and origin are added by who gives it to the engine.
struct PlannedCommand {
    AxisId axis = no_axis;
    CommandBody body;
    /// false: the client's answer waits for the Result. true: the map itself takes it, by on_own_result(note, result).
    bool own = false;
    std::uint32_t note = 0;
    bool reported = false;    ///< without `own`: the map hears of the result as well, before the client does
    bool until_done = false;  ///< the result comes when it is done, however long that takes (a day at most)
};
/// Commands of one request, in the order in which they are given to the engine; at most `max_commands`.
struct WritePlan {
    static constexpr std::size_t max_commands = 128;  ///< no write of a door touches more registers than that
    std::vector<PlannedCommand> commands;             // kept from request to request, so that nothing is allocated for it
};

/// One value of a range, as whoever carries it in another form than registers needs to know it.
struct MapValue {
    std::uint16_t address = 0, registers = 1;
    bool text = false;  ///< the first character in the high byte of the first register; else a number
    MapWordOrder order = MapWordOrder::high_first;
    AxisId axis = no_axis;           ///< whose it is; no_axis: of the unit
    std::optional<AxisPoint> point;  ///< of an axis; absent: a parameter, or a register of a language
    /// False: it changes while nothing happens.
    [[nodiscard]] bool steady() const noexcept { return point != AxisPoint::age_ms && point != AxisPoint::heartbeat; }
};

/// Addresses are 0-based; address + count <= 65536 and count >= 1 hold for every call.
class UnitMap {
public:
    /// Whether a read of this range would be served now.
    [[nodiscard]] virtual Verdict check_read(Table table, std::uint16_t address, std::uint16_t count) = 0;
    /// 2 * count bytes, big-endian, all of one picture per axis. After another verdict than good `out` is undefined.
    [[nodiscard]] virtual Verdict read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now,
                                                 std::uint8_t* out) = 0;
    /// (count + 7) / 8 bytes, first bit lowest, unused bits 0.
    [[nodiscard]] virtual Verdict read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) = 0;
    /// Whether the register shows its whole value: what is to be changed in part (function 22) must be known.
    [[nodiscard]] virtual bool is_exact(std::uint16_t /*address*/, Instant /*now*/) { return true; }
    /// Whether a write to this range would be tried: address and writability, then halves of values, then the axis.
    [[nodiscard]] virtual Verdict check_write(Table table, std::uint16_t address, std::uint16_t count) = 0;
    /// Plans a write. `data`: registers big-endian, or bits as in read_bits. All or nothing: unless it is good, nothing has changed and
    /// `plan` is empty.
    [[nodiscard]] virtual Verdict write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data,
                                        WritePlan& plan) = 0;
    /// The result of a command planned with `own`. If none comes in time, it is one with Reason::no_answer.
    virtual void on_own_result(std::uint32_t note, const Result& result) = 0;
    virtual ~UnitMap() = default;

    // --- for clients that carry a range as an image and renew it in cycles: they are not answered, value by value or at all
    /// The values that lie whole in the range, by address: those that can be written, or those that can be read.
    [[nodiscard]] virtual std::vector<MapValue> values(Table /*table*/, std::uint16_t /*address*/, std::uint16_t /*count*/,
                                                       bool /*written*/) {
        return {};
    }
    /// As read_registers, but a value that cannot be said spoils itself alone: it shows its mark, or 0.
    virtual void show(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out);
    /// What changes in one image is one order of the language behind, and its first image is what stood there before: see adopt().
    [[nodiscard]] virtual bool takes_images() const noexcept { return false; }
    /// The first image of a client, or the first after it was idle: a base. Nothing is started by what is set in it.
    virtual void adopt(Table /*table*/, std::uint16_t /*address*/, std::uint16_t /*count*/, const std::uint8_t* /*data*/,
                       WritePlan& /*plan*/) {}
    /// Plans a write of these values of the range alone. `data` begins at `address`. A value that is refused spoils itself alone: it is
    /// added to `refused`.
    virtual void renew(Table table, std::uint16_t address, std::span<const MapValue> changed, const std::uint8_t* data, WritePlan& plan,
                       std::vector<Refused>& refused);

    /// What was refused since it was last asked; Reason::none: nothing. A write may be good and refuse: a parameter channel shows it.
    [[nodiscard]] Refused take_refused() noexcept { return std::exchange(refused_, {}); }

protected:
    Verdict refuse(Verdict e, AxisId axis, Reason reason, std::string text) {
        refused_ = {axis, reason, std::move(text), {}, {}};
        return e;
    }
    Refused refused_;
};

}  // namespace axisgate::registers
