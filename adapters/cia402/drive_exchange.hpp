// Exchanges controls the one SDO transfer that is in progress with a node: its repetitions, its time-out, and late answers. A request is
// repeated after the time in which this node usually answers, and abandoned `reply_timeout` after that. A request that the node refuses
// because of its present state is sent again a few times, because a busy node refuses so as well. If the answer to an abandoned request may
// still arrive, a request for another object is sent first, so that a late answer is never taken for the answer to a new request.
#pragma once

#include <optional>
#include <vector>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "adapters/cia402/drive_times.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Drive;

class Exchanges : public drive::Part<Drive> {
public:
    Exchanges(Drive& drive, const Node& node);
    /// Further attempts of a stop after NMT start, if it was not answered.
    static constexpr int after_start = 2;

    void send(Ask ask, Turn& t);
    /// The end of the transfer in progress, if this frame ends it.
    [[nodiscard]] std::optional<canopen::SdoEnd> on_frame(const Frame& frame, Turn& t);
    enum class Late : std::uint8_t {
        no,
        cut,  ///< a stop has ended the transfer early; this says nothing about the node
        over  ///< the transfer has ended without an answer after all its repetitions
    };
    [[nodiscard]] Late on_deadline(Turn& t);
    /// The line is down.
    void drop();
    /// A stop has arrived: the transfer in progress is not repeated, and its answer is awaited only as long as this node usually needs. A
    /// request that waits for a busy node ends at once.
    void no_repeats(Instant now) noexcept;
    /// No answer can arrive any more. True: one was expected.
    bool give_up() noexcept;
    void nothing_late() noexcept { late_.clear(); }

    [[nodiscard]] bool active() const noexcept { return sdo_.busy() || waits(); }
    [[nodiscard]] Instant deadline() const noexcept {
        return waits() ? std::min(busy_until_, cut_at_) : active() ? std::min({sdo_.deadline(), repeat_at_, cut_at_}) : never;
    }
    /// The request in progress, or the last one.
    [[nodiscard]] const Ask& ask() const noexcept { return ask_; }
    /// The axis of the request has another place on the node, or is gone.
    void moved(std::size_t axis) noexcept { ask_.axis = axis; }

private:
    void transfer(Turn& t);
    /// The node was busy: the request is sent again later.
    [[nodiscard]] bool waits() const noexcept { return busy_until_ != never; }
    [[nodiscard]] bool is_busy(const canopen::SdoEnd& end) const noexcept;
    [[nodiscard]] Late again(Turn& t);
    void late_or_second(Address address, Turn& t);
    void end() noexcept;
    [[nodiscard]] Duration patience() const noexcept;
    [[nodiscard]] Duration repeat_after() const noexcept;

    drive::LateMarks<Address, 8> late_;
    canopen::SdoClient sdo_;
    AnswerTimes times_;
    Ask ask_;
    bool repeated_ = false;
    int refusals_ = 0;  ///< of the request in progress, by a node that may be busy
    Instant busy_until_ = never;
    Instant sent_{}, repeat_at_ = never, cut_at_ = never;
};

}  // namespace axisgate::cia402_drive
