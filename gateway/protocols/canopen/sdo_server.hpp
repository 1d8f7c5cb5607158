// SdoServer: answers one client's reads and writes of an object dictionary (CiA 301, 7.2.4): expedited, segmented, block.
// In: requests, time. Out: answers, the next deadline; the values go to and come from an SdoStore. Bounded by SdoLimits: one transfer, as
// many bytes as the store admits and the limits allow; a client that falls silent is given up with an abort. Never applies half a value:
// the store is written when the last byte is here and right.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/sdo.hpp"

namespace axisgate::canopen {

/// What a server reads from and writes to. `Abort::none` is a yes.
class SdoStore {
public:
    virtual ~SdoStore() = default;
    /// The present bytes of an entry.
    [[nodiscard]] virtual Abort read(Address address, std::vector<std::uint8_t>& into) = 0;
    /// Asked before the bytes of a longer write come. `size`: if the client has told it.
    [[nodiscard]] virtual Abort admits(Address address, std::optional<std::size_t> size) = 0;
    /// `sized`: the client has told the length; otherwise (expedited, four bytes) the store takes as many as the type has.
    [[nodiscard]] virtual Abort write(Address address, std::span<const std::uint8_t> bytes, bool sized) = 0;
};

class SdoServer {
public:
    /// `store` outlives the server.
    SdoServer(std::uint8_t node, SdoStore& store, SdoLimits limits = {}) noexcept : store_(store), limits_(limits) { set_node(node); }
    /// Default identifiers of this node; what was under way is forgotten.
    void set_node(std::uint8_t node) noexcept;
    /// Forgets what is under way without a word: the node was reset.
    void reset() noexcept { phase_ = Phase::idle; }

    [[nodiscard]] bool busy() const noexcept { return phase_ != Phase::idle; }
    [[nodiscard]] Instant deadline() const noexcept { return busy() ? deadline_ : never; }

    /// Any frame; others than requests to this node are not looked at. True: it was one.
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
    /// The bytes are here: the store's word is the answer, `yes` if it takes them.
    void store(std::span<const std::uint8_t> bytes, bool sized, const Frame& yes, std::vector<Frame>& out);

    SdoStore& store_;
    SdoLimits limits_;
    std::uint32_t request_id_ = 0, answer_id_ = 0;
    Phase phase_ = Phase::idle;
    Address address_;
    bool toggle_ = false;
    bool client_crc_ = false;
    std::uint8_t block_size_ = 0;  ///< that the client takes
    std::vector<std::uint8_t> data_;
    std::size_t at_ = 0;
    std::optional<std::uint32_t> announced_;
    BlockReceiver receiver_;
    BlockSender sender_;
    Instant deadline_ = never;
};

}  // namespace axisgate::canopen
