// NmtWatch treats nodes that another NMT master has stopped: such a node answers no SDO and sends its heartbeat only. A node whose axes
// stand still is not started, because somebody may be working on it, unless the site says so (option `restart_stopped`).
#pragma once

#include "adapters/cia402/drive_node.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::cia402_drive {
class Drive;

class NmtWatch : public drive::Part<Drive> {
public:
    using Part::Part;
    /// The heartbeat reports "stopped". A node with a moving axis is started again, so that its position is known and it can be stopped.
    void stopped(Turn& t);
    /// The node is being searched for or set up: it is sent to pre-operational, where it can answer; no axis starts by this.
    void wake(Turn& t);
    /// The node answers, or its PDOs arrive.
    void back(Turn& t);
    /// The node does not answer. If one of its axes may be moving, NMT start is sent, because another master may have stopped the node
    /// without a heartbeat that shows it.
    void silent(Turn& t);
    void start(Priority priority, Ticket order, Turn& t);

private:
    [[nodiscard]] bool turning() const noexcept;
    int starts_ = 0;  ///< number of NMT starts since `since_`
    Instant since_{};
};

}  // namespace axisgate::cia402_drive
