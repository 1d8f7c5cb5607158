// Start: how a drive is found: its first answer, the values that moves rest on.
// In: answers to probes and reads, silences. Out: presence, links. Never writes anything to a drive that was just found.
#pragma once

#include <string>

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/polls.hpp"

namespace axisgate::linmot {

class Start : public Part {
public:
    using Part::Part;

    void probe(Turn& t);
    void probed(const Telegram& telegram, Turn& t);
    /// A probe had no answer.
    void absent(Turn& t);
    /// It answers in a form that this gateway does not read: it cannot be served.
    void not_ours(std::string why, Turn& t);
    [[nodiscard]] std::string reconfigured(const Telegram& telegram) const;

    [[nodiscard]] bool reads() const noexcept { return reading_.core_pending(); }
    void read_next(Turn& t);
    void read(const Telegram& telegram, Turn& t);
    void read_silent(Turn& t);
    /// The site's limits of position into 146Eh and 146Fh (RAM), as writes of the drive's own that stand behind what waits.
    void set_limits();
    /// That the site wants other ones now, or none, is told with the drive's next word.
    void tell_limits(Turn& t);
    /// One of them has ended. `fault`: empty, or why the drive does not take it.
    void limit_set(std::string fault, Turn& t);
    /// The limits of predefined moves may be others now: unknown, and asked again at once.
    void read_again();

private:
    void ready(std::string_view more, Turn& t);

    drive::Reading reading_;
    std::size_t limits_open_ = 0;  ///< writes that have not ended
    bool limits_untold_ = false;
    std::string not_ours_;  ///< why a drive that answers cannot be served
};

}  // namespace axisgate::linmot
