// SdoClient: reads and writes entries of one node's object dictionary, one transfer at a time (CiA 301, 7.2.4): expedited, segmented,
// block.
// Frames of the node and time come in; frames, the next deadline and the result of each transfer come out: the bytes, or an abort code and
// the side that gave it. SdoLimits bounds every transfer, so a server that sends wrong lengths, repeats itself or never ends is aborted.
// A transfer is never repeated from here: that is decided by the user of the client.
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

/// The result of a transfer.
struct SdoEnd {
    Address address;
    bool write = false;
    Abort abort = Abort::none;       ///< none: success
    bool by_node = false;            ///< the abort came from the node, otherwise from us; silence is `timeout` without `by_node`
    std::vector<std::uint8_t> data;  ///< the complete value that was read; empty after writes and aborts

    [[nodiscard]] bool done() const noexcept { return abort == Abort::none; }
};
/// "1018h:01 could not be read: the node refused: the object does not exist (06020000h)"; "read" after success.
[[nodiscard]] std::string to_text(const SdoEnd& end);

class SdoClient {
public:
    /// Uses the default identifiers of the node. Others (1200h ff. of the node) are set by `set_ids`.
    explicit SdoClient(std::uint8_t node, SdoLimits limits = {}) noexcept
        : limits_(limits), request_id_(sdo_request_base + node), answer_id_(sdo_answer_base + node) {}
    void set_ids(std::uint16_t request, std::uint16_t answer) noexcept {
        request_id_ = request;
        answer_id_ = answer;
    }

    [[nodiscard]] bool busy() const noexcept { return phase_ != Phase::idle; }
    [[nodiscard]] Instant deadline() const noexcept { return busy() ? deadline_ : never; }
    [[nodiscard]] std::uint64_t strays() const noexcept { return strays_; }  ///< frames of the node that belong to no transfer

    /// Begins a transfer; returns false and does nothing while `busy`. `block`: a block transfer, with the plain protocol as a fallback if
    /// the node does not know block transfers.
    bool read(Address address, Instant now, std::vector<Frame>& out, bool block = false);
    bool write(Address address, std::vector<std::uint8_t> data, Instant now, std::vector<Frame>& out, bool block = false);

    /// The time-out for each message of the node, from the next transfer or repetition on.
    void set_patience(Duration patience) noexcept { limits_.patience = patience; }
    /// Extends the deadline for a node that is still busy with an earlier request.
    void extend(Instant until) noexcept {
        if (busy()) deadline_ = std::max(deadline_, until);
    }
    /// Whether the node has not yet answered the first request.
    [[nodiscard]] bool beginning() const noexcept;
    /// Sends the first request again while the node has not answered it: nothing is aborted, and an answer to either request counts.
    /// Returns false if there is no transfer, or if it is a block transfer or has been answered.
    bool repeat(Instant now, std::vector<Frame>& out);
    /// Ends the transfer without a message to the node: the next request replaces it there.
    void abandon() noexcept;

    /// Takes any frame and ignores all but this node's answers. At most one transfer ends.
    [[nodiscard]] std::optional<SdoEnd> on_frame(const Frame& frame, Instant now, std::vector<Frame>& out);
    [[nodiscard]] std::optional<SdoEnd> on_deadline(Instant now, std::vector<Frame>& out);
    /// Ends the present transfer with an abort message to the node.
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
    std::vector<std::uint8_t> data_;          ///< bytes to write, or read so far
    std::size_t at_ = 0;                      ///< bytes that have been written
    std::optional<std::uint32_t> announced_;  ///< size of the value to read, if the node has given it
    BlockReceiver receiver_;
    BlockSender sender_;
    Instant deadline_ = never;
    std::uint64_t strays_ = 0;
};

}  // namespace axisgate::canopen
