// SdoClient: reads and writes entries of one node's object dictionary, one transfer at a time (CiA 301, 7.2.4): expedited, segmented,
// block. In: what to read or write, frames of the node, time. Out: frames, the next deadline, and how each transfer ended: with bytes, or
// with an abort code and who gave it. Bounded by SdoLimits: a server that lies about lengths, repeats or never ends is aborted. Never
// repeats a transfer by itself (that is its user's to decide), and never knows what an entry means.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/sdo.hpp"

namespace axisgate::canopen {

/// How a transfer ended.
struct SdoEnd {
    Address address;
    bool write = false;
    Abort abort = Abort::none;       ///< none: it is done
    bool by_node = false;            ///< the abort came from the node; otherwise we gave it: silence is `timeout` and not `by_node`
    std::vector<std::uint8_t> data;  ///< what was read, in full; empty after writes and aborts

    [[nodiscard]] bool done() const noexcept { return abort == Abort::none; }
};
/// "1018h:01 could not be read: the node refused: the object does not exist (06020000h)"; "read" when it is done.
[[nodiscard]] std::string to_text(const SdoEnd& end);

class SdoClient {
public:
    /// The default identifiers of a node. Others (1200h ff. of the node): `set_ids`.
    explicit SdoClient(std::uint8_t node, SdoLimits limits = {}) noexcept
        : limits_(limits), request_id_(sdo_request_base + node), answer_id_(sdo_answer_base + node) {}
    void set_ids(std::uint16_t request, std::uint16_t answer) noexcept {
        request_id_ = request;
        answer_id_ = answer;
    }

    [[nodiscard]] bool busy() const noexcept { return phase_ != Phase::idle; }
    [[nodiscard]] Instant deadline() const noexcept { return busy() ? deadline_ : never; }
    [[nodiscard]] std::uint64_t strays() const noexcept { return strays_; }  ///< frames of the node that belong to no transfer

    /// Begins; only while not `busy` (otherwise nothing happens and it is false). `block`: by blocks, with the plain protocol after all if
    /// the node does not know them.
    bool read(Address address, Instant now, std::vector<Frame>& out, bool block = false);
    bool write(Address address, std::vector<std::uint8_t> data, Instant now, std::vector<Frame>& out, bool block = false);

    /// Waits so long for the node's next message, from the next transfer or repeat on.
    void set_patience(Duration patience) noexcept { limits_.patience = patience; }
    /// The node is still busy with what it was asked before: its answer may take until then.
    void extend(Instant until) noexcept {
        if (busy()) deadline_ = std::max(deadline_, until);
    }
    /// The node has not answered the first request yet.
    [[nodiscard]] bool beginning() const noexcept;
    /// Sends the first request once more, for as long as the node has not answered it: nothing is aborted, and an answer to either is one.
    /// False: the transfer is beyond that, by blocks, or there is none.
    bool repeat(Instant now, std::vector<Frame>& out);
    /// Ends the transfer without a word to the node: the next request takes its place there.
    void abandon() noexcept;

    /// Any frame; others than this node's answers are not looked at. At most one transfer ends.
    [[nodiscard]] std::optional<SdoEnd> on_frame(const Frame& frame, Instant now, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_deadline(Instant now, std::vector<Frame>& out);
    /// Ends the transfer under way, and tells the node why.
    [[nodiscard]] std::optional<SdoEnd> stop(Abort why, std::vector<Frame>& out);

private:
    enum class Phase : std::uint8_t {
        idle,
        read_begin,
        read_segments,
        write_begin,
        write_segments,
        block_read_begin,
        block_read,
        block_read_end,
        block_write_begin,
        block_write,
        block_write_end
    };
    void begin(Instant now, std::vector<Frame>& out);
    void ask_segment(std::vector<Frame>& out);
    void send_segment(std::vector<Frame>& out);
    void send_block(std::uint8_t block_size, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_abort(const Frame& f, Instant now, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_begun(const Frame& f, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_read_begun(const Frame& f, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_read_segment(const Frame& f, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_write_segment(const Frame& f, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_block_read(const Frame& f, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_block_read_end(const Frame& f, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_block_write(const Frame& f, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> end(Abort abort, bool by_node);

    SdoLimits limits_;
    std::uint32_t request_id_, answer_id_;
    Phase phase_ = Phase::idle;
    Address address_;
    bool write_ = false, block_ = false;
    bool toggle_ = false;
    bool node_crc_ = false;
    std::vector<std::uint8_t> data_;          ///< to be written, or read so far
    std::size_t at_ = 0;                      ///< bytes that have been written
    std::optional<std::uint32_t> announced_;  ///< size of what is read, if the node has told it
    BlockReceiver receiver_;
    BlockSender sender_;
    Instant deadline_ = never;
    std::uint64_t strays_ = 0;
};

}  // namespace axisgate::canopen
