// NmtWatch: what becomes of a node that somebody else has stopped (NMT stop): it answers nothing and shows nothing but its heartbeat.
// In: states of its heartbeat, silences, answers. Out: NMT start, warnings. Never starts a node that stands: somebody is at work there.
#pragma once

#include "adapters/cia402/drive_node.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::cia402_drive {
class Drive;

class NmtWatch : public drive::Part<Drive> {
public:
    using Part::Part;
    /// Its heartbeat says so. One that turns is started again, so that it is seen, and can be stopped.
    void stopped(Turn& t);
    /// It is looked for, or being set up: out of the stopped state it can answer, and nothing starts by that.
    void wake(Turn& t);
    /// It answers, or its PDOs come.
    void back(Turn& t);
    /// It does not answer. Where its heartbeat does not tell why, an axis that may be turning is not given up for that.
    void silent(Turn& t);
    void start(Priority priority, Ticket order, Turn& t);

private:
    [[nodiscard]] bool turning() const noexcept;
    int starts_ = 0;  ///< since `since_`
    Instant since_{};
};

}  // namespace axisgate::cia402_drive
