// One MCode drive: its parts, each with a state of its own, and what is said to whom when an exchange ends.
// In: commands, the outcome of its exchanges, time. Out: what it wants, the next request when it has the line; links, results, notices.
// Never sends by itself: the line asks it, and gives it one exchange at a time.
#pragma once

#include <string>
#include <string_view>

#include "adapters/mcode/actions.hpp"
#include "adapters/mcode/drive_mode.hpp"
#include "adapters/mcode/drive_trouble.hpp"
#include "adapters/mcode/drive_turnaround.hpp"
#include "adapters/mcode/feedback.hpp"
#include "adapters/mcode/motion.hpp"
#include "adapters/mcode/native.hpp"
#include "adapters/mcode/parameters.hpp"
#include "adapters/mcode/start.hpp"
#include "adapters/mcode/stop.hpp"
#include "gateway/drive/drive_base.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::mcode {

class Drive : public drive::DriveBase {
public:
    static constexpr int channels = 1;
    Drive(Bus& of_line, const DriveSetup& setup, std::size_t slot) : DriveBase(setup, of_line.timing, slot), bus(of_line) {}

    // --- from the line ------------------------------------------------------------------------------------------------------
    void line_up(Turn& t) { start.probe_anew(t); }
    void line_down(std::string_view why, Turn& t);
    void remove(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    /// Stops are urgent until they are sent, commands until they are confirmed; all else takes turns.
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    /// What it would send next is answered without a mark (a line, not a question), and is no stop.
    [[nodiscard]] bool wants_unmarked(Instant now) const noexcept;
    void look(const DriveSetup& setup) noexcept {
        if (pace.take(setup)) poll.hurry();
    }
    [[nodiscard]] Instant wish() const noexcept { return ready() ? poll.deadline() : presence.deadline(); }
    [[nodiscard]] Request next(Turn& t);
    /// How the exchange ended. `waiting` as verdict: nobody answered.
    void ended(Verdict verdict, const ReplyReader& reader, Turn& t);
    /// Text that nobody asked for while this drive had the line.
    void foreign(std::string_view text, Turn& t);
    /// An answer was late, cut, spoiled or lost, or came twice: told when it happens again and again.
    void trouble(Trouble::Kind kind, Turn& t);

    // --- from its parts -----------------------------------------------------------------------------------------------------
    void came(std::string identity, Turn& t);
    void lost(const std::string& why, Turn& t);
    void fail_all(Reason reason, const std::string& why, Turn& t);
    /// A line's exchange is over: what that means for the demand, and for a program that is waited for.
    void line_ended(std::string_view line, Verdict v, bool own);
    /// The poll that confirms a line; ER first if that is wanted.
    [[nodiscard]] Request confirming_question(Instant now);
    [[nodiscard]] bool confirms() const noexcept { return stops.confirming() || jobs.job().confirming; }
    void confirmed(Turn& t);
    void unconfirmed(std::string why, Turn& t);

    // --- what is known ------------------------------------------------------------------------------------------------------
    [[nodiscard]] const std::string& address() const noexcept { return setup_.address; }
    /// Points are numbered by it. What the language is stands in the family's page: names of users are none of its words.
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return catalogue_or(bus.catalogue); }
    [[nodiscard]] bool away() const noexcept { return presence.is(drive::Presence::Phase::absent); }
    /// It could hear a line to all drives now, or later: else it is away.
    [[nodiscard]] bool in_reach() const noexcept { return !away() && !presence.is(drive::Presence::Phase::down); }
    /// A CTRL+C for another drive restarts this one too (CE = 1) [L2005].
    [[nodiscard]] bool receives_every_reset() const noexcept { return ready() && words.ce == 1; }
    [[nodiscard]] Link link() const noexcept { return {setup_.address[0], words.sums}; }
    /// It takes lines without a word: EM = 2, or CK = 2 while a program runs [L2082, L2664].
    [[nodiscard]] bool quiet() const noexcept { return words.em == 2 || (words.ck == 2 && feedback.running()); }

    Bus& bus;
    LinkWords words;
    drive::PollTimer poll;
    drive::Pace pace;
    Turnaround turnaround;
    TrailingAck trailing;
    Start start{*this};
    ProgramMode mode{*this};
    Feedback feedback{*this};
    Errors errors{*this};
    Stops stops{*this};
    Jobs jobs{*this};
    Power power{*this};
    Motion motion{*this};
    Homing homing{*this};
    Parameters parameters{*this};
    Survey survey{*this};
    NativeLines native{*this};
    PlainActions plain_actions{*this};
    Programs programs{*this};
    ProgramEnd program{*this};
    LineSetupAction line_setup{*this};
    Restart restart{*this};

private:
    [[nodiscard]] Request choose(Turn& t);
    void watch_quality(Verdict v, const ReplyReader& r, Turn& t);
    void confirm_ended(Verdict v, const ReplyReader& r, Turn& t);
    void poll_ended(Verdict v, const ReplyReader& r, Turn& t);

    Request::Purpose purpose_ = Request::Purpose::poll;
    int poll_refusals_ = 0;
    std::uint32_t unanswered_ = 0;  ///< questions without an answer since it was heard last
    Trouble trouble_, twice_{1};
};

}  // namespace axisgate::mcode
