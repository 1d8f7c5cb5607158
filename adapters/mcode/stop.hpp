// Stops: the lane of stops of one drive, which go before everything that waits, and how each is confirmed.
// In: halt, quick stop, disable; the ends of their lines; the poll or error code that confirms one. Out: the next line of a stop; results.
// Never takes an acknowledgement alone for a stop: a poll, and ER if it says that there is one, come behind it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/drive_part.hpp"
#include "gateway/drive/command_queue.hpp"

namespace axisgate::mcode {

class Stops : public Part {
public:
    static constexpr std::size_t limit = 16;  ///< waiting stops; one more is refused as busy
    /// How often a line is said again that nobody acknowledges, if what is read does not show that it acts; and how many of these questions
    /// may be lost, as to a drive whose program prints all the time.
    static constexpr int said_again_limit = 12;
    using Part::Part;

    /// Its ticket is open here.
    void add(const Command& command, Turn& t);
    [[nodiscard]] bool empty() const noexcept { return lane_.empty(); }
    /// A quick stop or a power-off is on its way.
    [[nodiscard]] const CommandBody* locking() const noexcept;
    [[nodiscard]] Ticket order() const noexcept { return lane_.first()->command.ticket; }
    [[nodiscard]] bool confirming() const noexcept { return !empty() && lane_.first()->confirming; }
    [[nodiscard]] Request next(Instant now);
    /// Perhaps an absent drive hears: with and without checksum, since nobody says which it would take.
    [[nodiscard]] Request to_absent();
    void ended(Verdict v, Turn& t);
    void confirmed(Turn& t);
    void unconfirmed(std::string why, Turn& t);  ///< what would confirm it cannot be had
    /// The poll that would confirm it was in vain. True: too often, it is over.
    void missed(Turn& t);
    /// The drive went away, or may have stored the line as program text.
    void say_again() noexcept;
    void fail_all(Reason reason, std::string_view why, Turn& t);

    // --- a line to every drive at once ---------------------------------------------------------------------------------------
    /// The first stop's line, sent or not; empty: none waits, or it cannot be said to all.
    [[nodiscard]] std::string_view line() const noexcept;
    void taken_by_all(Instant received);
    [[nodiscard]] bool sent_to_all() const noexcept { return confirming() && lane_.first()->to_all; }
    /// The acknowledgement of the one that is confirmed.
    [[nodiscard]] Verdict acknowledgement() const noexcept { return lane_.first()->acknowledgement; }

private:
    struct Stop {
        Command command;
        std::vector<std::string> lines;
        std::size_t at = 0;
        int tries = 0;
        bool confirming = false;
        Verdict acknowledgement = Verdict::waiting;
        bool to_all = false;                ///< the line went to every drive at once: nobody acknowledges it
        bool unproven = false;              ///< the line was not acknowledged
        bool quiet = false;                 ///< nobody acknowledges it (EM = 2, an escape character)
        bool at_once = false;               ///< it was sent soon behind an answer
        Instant said{};                     ///< when the line was sent
        std::optional<std::int64_t> speed;  ///< to_all, unproven: read once since
    };
    [[nodiscard]] std::string_view at_once() const noexcept;
    [[nodiscard]] std::vector<std::string> out_of_torque() const;
    [[nodiscard]] std::optional<bool> reached(Stop& s, Instant now) const;
    [[nodiscard]] bool proven(Stop& s, Turn& t);
    [[nodiscard]] bool changed_way(Stop& s) const;
    void line_taken(Stop& s, Turn& t);
    void over(Outcome o, Reason r, std::string text, Turn& t, std::int32_t code = 0);

    drive::StopLane<Stop, limit> lane_;
};

}  // namespace axisgate::mcode
