// Splits a TCP byte stream into Modbus ADUs, from pieces of any size. It never allocates and does not read the PDU. After garbage no new
// beginning is searched for, because it cannot be found on TCP: the verdict is that this is not Modbus.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

/// One request in the framer's buffer; `pdu` is valid until the next call of space().
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
        bad_protocol,  ///< the protocol id is not 0: the connection cannot be used
        bad_length     ///< the length field is outside 2..254: likewise
    };

    /// The place for received bytes: the free end of the buffer. Empty only if `capacity` bytes wait.
    [[nodiscard]] std::span<std::uint8_t> space() noexcept;
    /// This number of bytes was written at the beginning of space().
    void filled(std::size_t n) noexcept { end_ += n; }
    /// Copies as much as fits and returns the number of bytes.
    std::size_t feed(std::span<const std::uint8_t> bytes) noexcept;

    /// Examines the oldest ADU without removing it. A bad header is reported as soon as its bytes have arrived, before the ADU is complete.
    [[nodiscard]] Verdict peek(Adu& out) const noexcept;
    /// Removes the ADU that peek() returned.
    void pop() noexcept;

    [[nodiscard]] std::size_t buffered() const noexcept { return end_ - begin_; }

private:
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    std::array<std::uint8_t, capacity> buffer_;  // not initialised, so that an idle connection uses one page of it
};

}  // namespace axisgate::modbus
