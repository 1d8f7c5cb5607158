// The parameter channel: registers 48..54 of an axis, through which a client reads and writes any parameter of its drive. It never waits: a
// client starts an exchange with one write and polls the state register. There is one exchange at a time per axis, for all clients.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/command.hpp"
#include "gateway/registers/unit_map.hpp"
#include "gateway/registers/words.hpp"

namespace axisgate::registers {

/// The state of one axis' channel.
///
///   selector  bits 0..15: the parameter's position in the family's catalogue (0-based); bits 16..30: the element (0 if it is not an
///             array); bit 31: the float form, in which `value` is an IEEE 754 single
///   request   1: read the parameter into `value`; 2: write `value` to it; 0: back to idle. Other numbers are illegal values.
///   state     0 idle, 1 busy, 2 done, 3 refused
///   value     i32. u32 parameters: the same 32 bits unsigned. f32 and f64: only whole numbers, other values are refused (out_of_range),
///             never rounded. In the float form: the single nearest to the value, for every number; written, the shortest decimal number
///             that is this single (0.1 is 0.1), which must be whole if the parameter is. NaN and infinity are refused
///             (out_of_range). Texts and bytes are refused (not_supported). After a write it shows the value that the drive accepted.
///   error     0, or after a refusal the drive's own code if it gave one, otherwise the number of the Reason
///
/// While it is busy all writes are refused (busy), because the answer would overwrite the written value.
class ParameterChannel {
public:
    enum class State : std::uint16_t { idle = 0, busy = 1, done = 2, refused = 3 };

    /// A write to offsets 48..50 and 52..53 in one request; absent: not written.
    struct Write {
        std::optional<std::uint32_t> selector;
        std::optional<std::uint16_t> request;
        std::optional<std::uint32_t> value;
    };
    /// The outcome of a write.
    struct Outcome {
        Verdict verdict = Verdict::good;     ///< unless good, nothing has changed
        std::optional<CommandBody> command;  ///< to be given to the engine; the channel is busy until finish()
    };
    /// `catalogue` is that of the axis' family, nullptr if it is unknown (then exchanges are refused with line_down).
    [[nodiscard]] Outcome write(const Write& write, const Catalogue* catalogue);

    /// The result of the command that write() returned. Ignored unless busy.
    void finish(const Result& result, const Catalogue* catalogue);

    /// Writes registers 48..54 into a block of block_size bytes; 51 is `state`.
    void render(WordOrder order, std::uint8_t* block) const noexcept;

    [[nodiscard]] State state() const noexcept { return state_; }
    /// The text of the last refusal, or of the last write() that was not good, in the words of the other doors.
    [[nodiscard]] const std::string& why() const noexcept { return why_; }
    [[nodiscard]] Reason reason() const noexcept { return reason_; }
    /// Id of the requested parameter, and the value that was to be written; empty: none, or unknown.
    [[nodiscard]] const std::string& parameter() const noexcept { return parameter_; }
    [[nodiscard]] const std::string& wanted() const noexcept { return wanted_; }

private:
    void refuse(Reason reason, std::string why, std::int32_t code = 0);
    [[nodiscard]] Value given(ValueType type) const noexcept;
    [[nodiscard]] bool take(const Value& value, ValueType type) noexcept;

    std::uint32_t selector_ = 0;
    std::uint16_t request_ = 0;
    State state_ = State::idle;
    std::uint32_t value_ = 0;
    std::uint16_t error_ = 0;
    Reason reason_ = Reason::none;
    std::string why_, parameter_, wanted_;
};

}  // namespace axisgate::registers
