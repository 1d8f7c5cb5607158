// ShownWords are the status word, StateVar and warn word as the response shows them: a drive whose interface copies them late shows those
// of some time ago, and single bits even later. Without a lateness they are those of the drive at the instant of the question.
#pragma once

#include <deque>

#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {

struct Words {
    std::uint16_t status = 0, state_var = 0, warn = 0;
};

class ShownWords {
public:
    explicit ShownWords(const Manners& manners) : manners_(manners) {}

    /// Advances the drive to `now`, and notes its words on the way there: on a grid of a sixteenth of the longest lateness, at least 1 ms.
    void advance(Drive& drive, Instant now);
    /// At the instant of the last advance.
    [[nodiscard]] Words at(const Drive& drive, Instant now) const;
    void forget() { notes_.clear(); }

private:
    struct Note {
        Instant at;
        Words words;
    };
    [[nodiscard]] Duration longest() const noexcept;
    [[nodiscard]] Words before(const Drive& drive, Instant now, Duration late) const;

    Manners manners_;
    std::deque<Note> notes_;  ///< in order of time, at most 18
};

}  // namespace axisgate::linmot::twin
