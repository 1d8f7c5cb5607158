// SdoServer: answers one client's reads and writes of an object dictionary (CiA 301, 7.2.4): expedited, segmented, block.
// Requests and time come in; answers and the next deadline come out; values are read from and written to an SdoStore. SdoLimits and the
// store bound each transfer, and the transfer of a client that falls silent is aborted. The store is written only when all bytes of a
// value have arrived and are valid.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/sdo.hpp"

namespace axisgate::canopen {

/// The values that a server reads and writes. `Abort::none` means success.
class SdoStore {
public:
    virtual ~SdoStore() = default;
    /// The present bytes of an entry.
    [[nodiscard]] virtual Abort read(Address address, std::vector<std::uint8_t>& into) = 0;
    /// Called before the bytes of a longer write arrive. `size`: as given by the client, if it is.
    [[nodiscard]] virtual Abort admits(Address address, std::optional<std::size_t> size) = 0;
    /// `sized`: the client has given the length; otherwise (expedited, four bytes) the store uses as many bytes as the type has.
    [[nodiscard]] virtual Abort write(Address address, std::span<const std::uint8_t> bytes, bool sized) = 0;
};

class SdoServer {
public:
    /// `store` outlives the server.
    SdoServer(std::uint8_t node, SdoStore& store, SdoLimits limits = {}) noexcept : store_(store), limits_(limits) { set_node(node); }
    /// Sets the default identifiers of this node and discards the present transfer.
    void set_node(std::uint8_t node) noexcept;
    /// Discards the present transfer without a message, for a node that was reset.
    void reset() noexcept { phase_ = Phase::idle; }

    [[nodiscard]] bool busy() const noexcept { return phase_ != Phase::idle; }
    [[nodiscard]] Instant deadline() const noexcept { return busy() ? deadline_ : never; }

    /// Takes any frame and ignores all but requests to this node. Returns whether it was one.
    bool on_frame(const Frame& frame, Instant now, std::vector<Frame>& out);
    void on_deadline(Instant now, std::vector<Frame>& out);

private:
    enum class Phase : std::uint8_t { idle, read, write, block_read_begin, block_read, block_read_end, block_write, block_write_end };
    void begin(const Frame& f, std::vector<Frame>& out);
    void begin_read(const Frame& f, bool block, std::vector<Frame>& out);
    void begin_write(const Frame& f, std::vector<Frame>& out);
    void begin_block_write(const Frame& f, std::vector<Frame>& out);
    void on_read(const Frame& f, std::vector<Frame>& out);
    void on_write(const Frame& f, std::vector<Frame>& out);
    void on_block_read(const Frame& f, std::vector<Frame>& out);
    void on_block_write(const Frame& f, std::vector<Frame>& out);
    void on_block_write_end(const Frame& f, std::vector<Frame>& out);
    void abort(Abort why, std::vector<Frame>& out);
    /// Writes the complete bytes to the store, and answers with `yes` or with the abort code of the store.
    void store(std::span<const std::uint8_t> bytes, bool sized, const Frame& yes, std::vector<Frame>& out);

    SdoStore& store_;
    SdoLimits limits_;
    std::uint32_t request_id_ = 0, answer_id_ = 0;
    Phase phase_ = Phase::idle;
    Address address_;
    bool toggle_ = false;
    bool client_crc_ = false;
    std::uint8_t block_size_ = 0;  ///< accepted by the client
    std::vector<std::uint8_t> data_;
    std::size_t at_ = 0;
    std::optional<std::uint32_t> announced_;
    BlockReceiver receiver_;
    BlockSender sender_;
    Instant deadline_ = never;
};

}  // namespace axisgate::canopen
