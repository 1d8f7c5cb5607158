// The interface of the map behind a unit id: the standard map, a user map (units 2..254) or a profile. It gets checked requests (function,
// count and byte count are correct) and returns register data, or the commands of a write. It knows no protocol; the doors translate
// verdicts into their own codes.
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

/// The verdict on a request. The numbers are those of the Modbus exceptions, under which they are commonly known.
enum class Verdict : std::uint8_t {
    good = 0,
    no_address = 2,  ///< not mapped, not writable, or beyond 65535
    bad_value = 3,   ///< value out of range, half of a 32-bit value
    failed = 4,      ///< the drive refused or failed
    busy = 6,
    no_path = 0x0A,   ///< no such unit, the axis is not configured, or its line is down
    no_answer = 0x0B  ///< the drive did not answer in time
};
/// The verdict for the reason of a failed write.
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
/// `good` for a good result; a bad result is never `good`, whatever its reason is.
[[nodiscard]] inline Verdict verdict_of(const Result& result) noexcept {
    return axisgate::good(result) ? Verdict::good : verdict_of(result.reason);
}

/// The result for a reader that is not a door.
struct RegisterRead {
    Verdict verdict = Verdict::good;
    std::vector<std::uint8_t> bytes;  ///< registers big-endian, or bits, the first one lowest; empty unless good
};

/// Reason of a refusal, in the words of the other doors.
struct Refused {
    AxisId axis = no_axis;
    Reason reason = Reason::none;
    std::string text;
    std::string parameter, value;  ///< of a parameter: its id, and the value that was to be written
};

/// One command of a write. The sender adds ticket and origin.
struct PlannedCommand {
    AxisId axis = no_axis;
    CommandBody body;
    /// false: the client's answer waits for the result. true: the map itself gets it, by on_own_result(note, result).
    bool own = false;
    std::uint32_t note = 0;
    bool reported = false;    ///< without `own`: the map gets the result as well, before the client
    bool until_done = false;  ///< the result comes when the command is done, however long that takes (a day at most)
};
/// Commands of one request, in the order in which they are given to the engine; at most `max_commands`.
struct WritePlan {
    static constexpr std::size_t max_commands = 128;  ///< no write of a door has more registers than this
    std::vector<PlannedCommand> commands;             // kept from request to request, so that no memory is allocated for it
};

/// One value of a range, for clients that carry values in another form than registers.
struct MapValue {
    std::uint16_t address = 0, registers = 1;
    bool text = false;  ///< a text, with the first character in the high byte of the first register; otherwise a number
    MapWordOrder order = MapWordOrder::high_first;
    AxisId axis = no_axis;           ///< the axis of the value; no_axis: the unit
    std::optional<AxisPoint> point;  ///< of an axis; absent: a parameter, or a register of a language
    /// Returns false for values that change all the time.
    [[nodiscard]] bool steady() const noexcept { return point != AxisPoint::age_ms && point != AxisPoint::heartbeat; }
};

/// Addresses are 0-based; address + count <= 65536 and count >= 1 hold for every call.
class UnitMap {
public:
    /// Checks whether a read of this range would be answered now.
    [[nodiscard]] virtual Verdict check_read(Table table, std::uint16_t address, std::uint16_t count) = 0;
    /// Reads 2 * count bytes, big-endian, all of one picture per axis. Unless the verdict is good, `out` is undefined.
    [[nodiscard]] virtual Verdict read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now,
                                                 std::uint8_t* out) = 0;
    /// Reads (count + 7) / 8 bytes, first bit lowest, unused bits 0.
    [[nodiscard]] virtual Verdict read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) = 0;
    /// True if the register shows its whole value, which must be known to change a part of it (function 22).
    [[nodiscard]] virtual bool is_exact(std::uint16_t /*address*/, Instant /*now*/) { return true; }
    /// Checks whether a write to this range would be tried: address and writability, then halves of values, then the axis.
    [[nodiscard]] virtual Verdict check_write(Table table, std::uint16_t address, std::uint16_t count) = 0;
    /// Plans a write. `data`: registers big-endian, or bits as in read_bits. Unless the verdict is good, nothing has changed and `plan` is
    /// empty.
    [[nodiscard]] virtual Verdict write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data,
                                        WritePlan& plan) = 0;
    /// The result of a command planned with `own`; if none arrives in time, one with Reason::no_answer.
    virtual void on_own_result(std::uint32_t note, const Result& result) = 0;
    virtual ~UnitMap() = default;

    // --- for clients that carry a range as an image and renew it in cycles, with no answer or one per value
    // The values that lie completely in the range, by address: those that can be written, or those that can be read.
    [[nodiscard]] virtual std::vector<MapValue> values(Table /*table*/, std::uint16_t /*address*/, std::uint16_t /*count*/,
                                                       bool /*written*/) {
        return {};
    }
    /// Like read_registers, but an unknown value affects only itself: it shows its mark, or 0.
    virtual void show(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out);
    /// True if the changes of one image are one order of the language, and its first image is a base (adopt()).
    [[nodiscard]] virtual bool takes_images() const noexcept { return false; }
    /// Applies the first image of a client, or the first one after it was idle, as a base: set bits start nothing.
    virtual void adopt(Table /*table*/, std::uint16_t /*address*/, std::uint16_t /*count*/, const std::uint8_t* /*data*/,
                       WritePlan& /*plan*/) {}
    /// Plans a write of these values of the range only. `data` begins at `address`. A refused value affects only itself and is added to
    /// `refused`.
    virtual void renew(Table table, std::uint16_t address, std::span<const MapValue> changed, const std::uint8_t* data, WritePlan& plan,
                       std::vector<Refused>& refused);

    /// The refusals since the last call; Reason::none: none. A good write may also contain a refusal, which a parameter channel shows.
    [[nodiscard]] Refused take_refused() noexcept { return std::exchange(refused_, {}); }

protected:
    Verdict refuse(Verdict e, AxisId axis, Reason reason, std::string text) {
        refused_ = {axis, reason, std::move(text), {}, {}};
        return e;
    }
    Refused refused_;
};

}  // namespace axisgate::registers
