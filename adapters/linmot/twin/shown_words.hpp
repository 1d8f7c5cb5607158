// ShownWords are the status word, StateVar and warn word as the response shows them: a drive whose interface copies them late shows those
// of some time ago, and single bits even later. Without a lateness they are those of the drive at the instant of the question.
#pragma once

#include <deque>

#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {

struct Words {
    std::uint16_t status = 0, state_var = 0, warn = 0;
    bool operator==(const Words&) const = default;
};

class ShownWords {
public:
    explicit ShownWords(const Manners& manners) : manners_(manners) {}

    /// Advances the drive to `now`, and notes each change of its words on the way there; changes that have no closed form are looked for
    /// in steps of a sixteenth of the longest lateness, at least 2 ms.
    void advance(Drive& drive, Instant now);
    /// At the instant of the last advance.
    [[nodiscard]] Words at(const Drive& drive, Instant now);
    /// The drive has changed without a request.
    void doubt() noexcept { noted_ = false; }
    void forget() { notes_.clear(), noted_ = false; }

private:
    struct Note {
        Instant at;
        Words words;
    };
    [[nodiscard]] Duration longest() const noexcept;
    [[nodiscard]] Words before(Instant now, Duration late) const;
    void note(const Words& words, Instant at);

    Manners manners_;
    std::deque<Note> notes_;  ///< the changes within the longest lateness and the one before, in order of time
    Instant looked_at_{};
    bool noted_ = false;  ///< the words as of `looked_at_`
};

}  // namespace axisgate::linmot::twin
