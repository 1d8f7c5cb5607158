// Exchanges: the one SDO transfer that is on its way to a node, its repeats, and what late answers mean for the questions after it.
// In: transfers to begin, answers, the passing of time. Out: frames; the end of a transfer, or the news that there is none.
// A question is repeated when the node should have answered it, as fast as it is known to be, and given up when no answer comes for
// `reply_timeout` after that. Never takes a late answer for a new one: where one may still come, something else is asked before.
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
    /// A stop that is not answered is sent so often again when the node has been told to start (NMT).
    static constexpr int after_start = 2;

    void send(Ask ask, Turn& t);
    /// The end of the present one, if this frame is that.
    [[nodiscard]] std::optional<canopen::SdoEnd> on_frame(const Frame& frame, Turn& t);
    enum class Late : std::uint8_t {
        no,
        cut,  ///< a stop has ended it before its time: nothing is known by that
        over  ///< it has ended without an answer, however often it was asked
    };
    [[nodiscard]] Late on_deadline(Turn& t);
    /// The line is down.
    void drop();
    /// A stop has come: what is on the way is not repeated, and not waited for longer than this node needs for an answer.
    void no_repeats(Instant now) noexcept;
    /// No answer can come. True: one was waited for.
    bool give_up() noexcept;
    void nothing_late() noexcept { late_.clear(); }

    [[nodiscard]] bool active() const noexcept { return sdo_.busy(); }
    [[nodiscard]] Instant deadline() const noexcept { return active() ? std::min({sdo_.deadline(), repeat_at_, cut_at_}) : never; }
    /// The present one, or the one that ended last.
    [[nodiscard]] const Ask& ask() const noexcept { return ask_; }
    /// Who asked has another place among the axes of the node, or is gone.
    void moved(std::size_t axis) noexcept { ask_.axis = axis; }

private:
    void transfer(Turn& t);
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
    Instant sent_{}, repeat_at_ = never, cut_at_ = never;
};

}  // namespace axisgate::cia402_drive
