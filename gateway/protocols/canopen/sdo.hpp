// SDO, the common part of client and server (CiA 301, 7.2.4): the block checksum, abort messages, and both ends of a block transfer.
// A receiver keeps at most as many bytes as were announced, and either end aborts when several blocks in a row make no progress. There is
// no clock here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/abort.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen {

inline constexpr std::uint8_t most_block_size = 127;  ///< segments between two acknowledgements
inline constexpr std::size_t segment_bytes = 7;

/// CRC-16 of block transfers: polynomial 1021h, start 0, not reflected ("123456789" gives 31C3h).
[[nodiscard]] std::uint16_t sdo_crc(std::span<const std::uint8_t> bytes) noexcept;

/// An SDO message of eight bytes: command, index and subindex, and four bytes of data.
[[nodiscard]] Frame sdo_frame(std::uint32_t id, std::uint8_t command, Address address, std::uint32_t value = 0) noexcept;
[[nodiscard]] Frame abort_frame(std::uint32_t id, Address address, Abort code) noexcept;
/// Index and subindex of a message with eight bytes.
[[nodiscard]] Address address_of(const Frame& frame) noexcept;
[[nodiscard]] std::uint32_t value_of(const Frame& frame) noexcept;

struct SdoLimits {
    Duration patience = std::chrono::milliseconds(500);  ///< time until the next message of the other side
    std::size_t most_bytes = 64 * 1024;                  ///< limit for a received value; a longer one is aborted (memory)
    std::uint8_t block_size = 32;                        ///< requested when receiving, 1..127
    int stalls = 3;                                      ///< blocks in a row without a good segment before the transfer is aborted
};

/// The receiving end of a block transfer.
class BlockReceiver {
public:
    /// `announced`: the size that the sender has given.
    void begin(const SdoLimits& limits, std::optional<std::uint32_t> announced);
    struct Step {
        bool acknowledge = false;   ///< the block is over: send `sequence` and the block size for the next one
        std::uint8_t sequence = 0;  ///< of the last good segment
        Abort abort = Abort::none;  ///< the transfer cannot go on
    };
    /// A segment out of sequence is ignored; the acknowledgement makes the sender repeat from there.
    [[nodiscard]] Step on_segment(const Frame& frame);
    [[nodiscard]] bool complete() const noexcept { return complete_; }  ///< the last segment has arrived and is acknowledged
    /// Checks the end message: the number of unused bytes in the last segment, and the checksum if both sides use one.
    [[nodiscard]] Abort finish(std::uint8_t unused, std::optional<std::uint16_t> crc);
    [[nodiscard]] std::vector<std::uint8_t> take() noexcept { return std::move(data_); }

private:
    SdoLimits limits_;
    std::optional<std::uint32_t> announced_;
    std::vector<std::uint8_t> data_;
    std::uint8_t good_ = 0;
    int stalls_ = 0;
    bool complete_ = false;
};

/// The sending end of a block transfer.
class BlockSender {
public:
    void begin(std::vector<std::uint8_t> data, int stalls);
    /// The segments of the next block: at most 127 frames.
    void send(std::uint32_t id, std::uint8_t block_size, std::vector<Frame>& out);
    /// Takes the last segment that the receiver has; later ones are sent again with the next block.
    [[nodiscard]] Abort on_acknowledge(std::uint8_t sequence);
    [[nodiscard]] bool complete() const noexcept { return at_ >= data_.size() && begun_; }
    [[nodiscard]] std::uint8_t unused() const noexcept;
    [[nodiscard]] std::uint16_t crc() const noexcept { return sdo_crc(data_); }

private:
    std::vector<std::uint8_t> data_;
    std::size_t at_ = 0;     ///< first byte that is not acknowledged
    std::uint8_t sent_ = 0;  ///< segments of the present block
    bool begun_ = false;     ///< a segment was acknowledged; an empty value also has one segment
    int stalls_ = 0, most_stalls_ = 0;
};

}  // namespace axisgate::canopen
