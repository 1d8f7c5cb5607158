// Start finds a drive, learns the form of its response, and reads the values that moves need. Nothing is written to a drive that was just
// found.
#pragma once

#include <string>

#include "adapters/linmot/drive_exchange.hpp"
#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/polls.hpp"

namespace axisgate::linmot {

class Start : public Part {
public:
    using Part::Part;

    void probe(Turn& t);
    void probed(const Request& asked, const Telegram& telegram, Turn& t);
    /// A probe was not answered. Returns true if it was one for the position, and the drive cannot be used without.
    [[nodiscard]] bool probe_silent(const Request& asked, Turn& t);
    /// A probe has timed out.
    void absent(Turn& t);
    /// The request for status word, StateVar and actual position: the default response, or a RAM read where this has no position.
    [[nodiscard]] Telegram status_request() const;
    /// Size of the data of the drive's response, as it was found last.
    [[nodiscard]] std::size_t response_size() const noexcept { return response_size_; }
    /// A response of this size is one of this drive. Before the drive is found, a stop is answered with one of any content.
    [[nodiscard]] bool response_fits(std::size_t size) const noexcept;
    /// The status in an answer to this request.
    [[nodiscard]] std::optional<Status> status_in(const Telegram& asked, const Telegram& answer) const noexcept;

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
    /// The drive answers, and cannot be used: its link and one event say why.
    void not_ours(std::string why, Turn& t);
    [[nodiscard]] std::string reconfigured(std::size_t size, std::string_view why) const;

    drive::Reading reading_;
    bool asks_presence_ = false;   ///< the drive did not answer the first read of a RAM value: does it answer at all?
    bool ram_silent_ = false;      ///< it answers other requests, and no read of a RAM value
    std::size_t limits_open_ = 0;  ///< outstanding writes
    bool limits_untold_ = false;
    std::string not_ours_;  ///< why a drive that answers cannot be used
    std::size_t response_size_ = default_size;
    std::size_t probed_size_ = default_size;  ///< of the answer to the last probe
    int position_unread_ = 0;                 ///< reads of the position without an answer, one after the other
};

}  // namespace axisgate::linmot
