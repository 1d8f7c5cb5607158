// ADU framer: cuts a TCP byte stream into Modbus ADUs.
// In: bytes as they arrive, in pieces of any size. Out: whole ADUs in order, or the verdict that this is not Modbus.
// Never waits, never allocates, never looks into the PDU, and never looks for a new beginning after garbage: on TCP that cannot be found.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

/// One request as it stands in the framer's buffer; `pdu` is valid until the next call of space().
struct Adu {
    std::uint16_t transaction = 0;
    std::uint8_t unit = 0;
    std::span<const std::uint8_t> pdu;  ///< 1..253 bytes: function code and data
};

class AduFramer {
public:
    /// 32 requests of the greatest length fit. When it is full, its owner stops reading and TCP holds the client back.
    static constexpr std::size_t capacity = 32 * max_adu;

    enum class Verdict : std::uint8_t {
        need_more,
        adu,
        bad_protocol,  ///< the protocol id is not 0: the connection is worthless
        bad_length     ///< the length field is outside 2..254: likewise
    };

    /// Where received bytes go: the free end of the buffer. Empty only if `capacity` bytes wait.
    [[nodiscard]] std::span<std::uint8_t> space() noexcept;
    /// So many bytes were put at the beginning of space().
    void filled(std::size_t n) noexcept { end_ += n; }
    /// Copies as much as fits and returns how much that was.
    std::size_t feed(std::span<const std::uint8_t> bytes) noexcept;

    /// Looks at the oldest ADU without taking it. A bad header is told as soon as its bytes are there, before the ADU is whole.
    [[nodiscard]] Verdict peek(Adu& out) const noexcept;
    /// Takes the ADU that peek() showed.
    void pop() noexcept;

    [[nodiscard]] std::size_t buffered() const noexcept { return end_ - begin_; }

private:
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    std::array<std::uint8_t, capacity> buffer_;  // not initialised: an idle connection touches one page of it
};

}  // namespace axisgate::modbus
