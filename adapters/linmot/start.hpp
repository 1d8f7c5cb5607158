// Start finds a drive and reads the values that moves need. Nothing is written to a drive that was just found.
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
    /// A probe has timed out.
    void absent(Turn& t);
    /// The answer has a form that this gateway does not read: the drive cannot be used.
    void not_ours(std::string why, Turn& t);
    [[nodiscard]] std::string reconfigured(const Telegram& telegram) const;

    [[nodiscard]] bool reads() const noexcept { return reading_.core_pending(); }
    void read_next(Turn& t);
    void read(const Telegram& telegram, Turn& t);
    void read_silent(Turn& t);
    /// Writes the site's position limits to 146Eh and 146Fh (RAM), behind the commands that wait.
    void set_limits();
    /// Reports with the next answer of the drive that the site has changed or removed the limits.
    void tell_limits(Turn& t);
    /// A write of a limit has ended. `fault`: empty, or why the drive refuses it.
    void limit_set(std::string fault, Turn& t);
    /// The limits of predefined moves may have changed: they are unknown, and read again at once.
    void read_again();

private:
    void ready(std::string_view more, Turn& t);

    drive::Reading reading_;
    std::size_t limits_open_ = 0;  ///< outstanding writes
    bool limits_untold_ = false;
    std::string not_ours_;  ///< why a drive that answers cannot be used
};

}  // namespace axisgate::linmot
