// Exchanges: the one SDO transfer that is on its way to a node, its repeats, and what late answers mean for the questions after it.
// In: transfers to begin, answers, the passing of time. Out: frames; the end of a transfer, or the news that there is none.
// Never takes a late answer for a new one: where one may still come, something else is asked before. A stop waits for nothing.
#pragma once

#include <optional>
#include <vector>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Drive;

class Exchanges : public drive::Part<Drive> {
public:
    Exchanges(Drive& drive, const Node& node);

    void send(Ask ask, Turn& t);
    /// The end of the present one, if this frame is that.
    [[nodiscard]] std::optional<canopen::SdoEnd> on_frame(const Frame& frame, Turn& t);
    /// True: it has ended without an answer, however often it was asked.
    [[nodiscard]] bool on_deadline(Turn& t);
    /// The line is down.
    void drop();
    /// A stop has come: what is on the way is not repeated.
    void no_repeats() noexcept;
    void nothing_late() noexcept { late_.clear(); }

    [[nodiscard]] bool active() const noexcept { return sdo_.busy(); }
    [[nodiscard]] Instant deadline() const noexcept { return sdo_.deadline(); }
    /// The present one, or the one that ended last.
    [[nodiscard]] const Ask& ask() const noexcept { return ask_; }
    /// Who asked has another place among the axes of the node, or is gone.
    void moved(std::size_t axis) noexcept { ask_.axis = axis; }

private:
    void transfer(Turn& t);

    drive::LateMarks<Address, 8> late_;
    canopen::SdoClient sdo_;
    Ask ask_;
};

}  // namespace axisgate::cia402_drive
