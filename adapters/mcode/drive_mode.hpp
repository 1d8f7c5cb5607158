// ProgramMode: whether a drive is in program mode, and its way out: after a broken download, and when somebody else has left it there.
// In: lines PG as they are sent, their end; questions that were taken and not answered. Out: requests that lead it back to immediate mode,
// an event. It outlives absence: a drive that comes back may still be in it.
// Never lets a stop, a poll or a command go to a drive that may take it as program text: PG toggles [L4778], so each PG is counted, and
// when its acknowledgement was lost a marked question tells the mode: data means immediate, an acknowledgement alone means stored.
#pragma once

#include "adapters/mcode/drive_part.hpp"

namespace axisgate::mcode {

class ProgramMode : public Part {
public:
    using Part::Part;

    /// It is to be led out before anything else is said to it; a download of this gateway's is no reason.
    [[nodiscard]] bool leaving() const noexcept;
    [[nodiscard]] Request next();
    void ended(Verdict v, const ReplyReader& r, Turn& t);
    /// How a probe ended. True: that was about the mode, and no more is known of the drive.
    [[nodiscard]] bool probed(Verdict v, const ReplyReader& r, Turn& t);
    /// The probe of a drive that went away in program mode, where a question is stored and not answered.
    [[nodiscard]] bool probes_by_line() const noexcept { return mode_ == Mode::program; }
    /// Perhaps stored, perhaps refused: the next question is one that cannot be refused.
    [[nodiscard]] bool suspected() const noexcept { return suspected_; }

    /// A line is being sent: is it PG? And its end. True: it was.
    void sending(std::string_view line);
    [[nodiscard]] bool line_ended(Verdict v);
    void line_probed() noexcept { mode_ = Mode::unknown; }  ///< PG as a probe has ended: the next probe tells
    /// A question that is seldom refused was taken and not answered: asked before anything else is said, a stop included.
    void suspect() noexcept;
    [[nodiscard]] bool immediate() const noexcept { return mode_ == Mode::immediate; }
    /// The line before its request: whether a LF of the gateway's own stands before it, so that nothing can be joined with it.
    void led(bool by_own_end) noexcept { led_ = by_own_end; }
    /// Somebody on the line did not answer: the end of a line may be lost, so what has been seen of program mode proves nothing.
    void line_missed() noexcept { evidence_ = 0; }
    /// An acknowledgement may be a late one: the mode is asked after.
    void doubt(bool on) noexcept { doubt_ = on; }
    void away(bool line_down) noexcept;
    void restarted() noexcept { mode_ = Mode::immediate, suspected_ = found_ = false; }

private:
    [[nodiscard]] bool proven(int questions) const noexcept;
    void found();
    void led_out(Turn& t);

    enum class Mode : std::uint8_t { immediate, program, unknown };
    Mode mode_ = Mode::immediate;    ///< as far as this gateway knows
    Mode before_ = Mode::immediate;  ///< of the PG in flight
    bool in_flight_ = false;         ///< a PG is
    bool doubt_ = false;
    bool asks_ = false;       ///< the exchange in flight asks for the mode
    int rounds_ = 0;          ///< at 12 without success the drive is given up as absent
    bool suspected_ = false;  ///< a question was taken and not answered, and this gateway has sent no PG
    int evidence_ = 0;        ///< questions since then that were taken and not answered, each behind a LF of our own
    bool led_ = false;        ///< the one in flight is such a question
    bool found_ = false;      ///< it is certain: somebody else has left it in program mode
    int stored_ = 0;          ///< questions that it may have stored since
};

}  // namespace axisgate::mcode
