// Start: is it there, what is it, what does it hold; and what follows when it falls silent or restarts.
// In: answers to ML and to the reads of a list. Out: DriveLink, samples of everything read, the drive made ready.
// Never writes to the drive but MF=0, which changes no value: a group left selected by somebody else would falsify the reads.
#pragma once

#include <string>

#include "adapters/uim342/drive_part.hpp"
#include "gateway/drive/polls.hpp"

namespace axisgate::uim342 {

class Start : public Part {
public:
    using Part::Part;

    void begin(Turn& t);
    void probe(Turn& t);
    void probe_answered(const Message& m, Turn& t);
    void probe_refused(Turn& t);
    /// Its presence has been lost just now.
    void lost(Turn& t, std::string why);
    /// SY[1] has been sent; nothing acknowledges it [L1216]. `waits`: answered when the drive is back.
    void reboot_begun(Ticket waits, Turn& t);
    /// Its first status behind that.
    void back(Turn& t);
    void not_back(Reason reason, const std::string& text, Turn& t);

    [[nodiscard]] const drive::Reading& reading() const noexcept { return reading_; }
    void read_next(Turn& t);
    void step_done(Turn& t);
    void step_silent() noexcept { reading_.silent(); }
    /// Nothing of before is trusted.
    void read_all();
    /// The drive goes on being used, but its RAM may have changed.
    void read_again();

private:
    void core_known(Turn& t);

    drive::Reading reading_;
    Ticket reboot_ = no_ticket;  ///< of who waits for its end
    std::string identity_;
    struct Before {  ///< last seen before a silence, to tell a broken cable from a restart
        bool known = false, on = false, referenced = false;
        std::int64_t position = 0;
        bool own_error = false;  ///< its error flag stood for something that it had refused to this gateway
    } before_;
};

}  // namespace axisgate::uim342
