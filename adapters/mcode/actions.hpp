// The actions of the family that are more than a line: the program memory, the end of a program, line.setup, reset and factory values.
// In: actions, listings, the loss and return of the drive. Out: steps, results, notices.
// Never sends program text that has not been checked as a whole.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/drive_job.hpp"
#include "adapters/mcode/native_program.hpp"

namespace axisgate::mcode {

/// The program memory: program.upload, program.download, program.edit; and what a broken download or a look at program mode has left in it.
class Programs final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void sending(Step& step, Request& r) override;
    [[nodiscard]] bool ended(const Step& step, Verdict v, Turn& t) override;
    [[nodiscard]] bool complained(const Step& step, int error, Turn& t) override;
    void answered(const std::string& data, Turn& t) override;
    void listed(const std::string& text, Turn& t) override;
    void done(Turn& t) override;
    void without_success(drive::Failure& how, Turn& t) override;

    [[nodiscard]] bool downloads() const noexcept { return is(Doing::download); }
    /// A stop came in between: a download is over.
    void interrupt(std::string_view by, Turn& t);
    void drive_away() noexcept { was_away_ = was_away_ || clear_half_; }
    void restarted() noexcept { clear_half_ = tidy_ = false; }
    /// Questions that were stored while it was in program mode are to be removed, at rest.
    void tidy() noexcept { tidy_ = true; }
    void untidy() noexcept { tidy_ = false; }
    [[nodiscard]] bool wants_clean_up() const noexcept { return clear_half_ || tidy_; }
    void clean_up();

private:
    enum class Doing : std::uint8_t {
        nothing,
        upload,
        download,
        edit,   ///< until what is replaced is gone; then it is a download
        clear,  ///< removes the half that a broken download has left
        tidy    ///< removes the questions that were stored
    };
    [[nodiscard]] bool is(Doing doing) const noexcept;
    void begin(Doing doing);
    void download(const std::string& text, Turn& t);
    void add_lines(const std::vector<ProgramLine>& lines);
    void compare(const std::string& listing, Turn& t);
    [[nodiscard]] std::string memory_is_half() const;
    void download_failed(std::string why, Turn& t);
    void setting_refused(const std::string& why, Turn& t);
    void keep_half();
    void clear_if_half(const std::string& listing, Turn& t);
    void tidy_up(const std::string& listing, Turn& t);
    void edit(const std::string& argument, Turn& t);
    void edit_listed(const std::string& text, Turn& t);
    [[nodiscard]] bool begin_edit(const std::vector<ListedLine>& rows, Turn& t);
    [[nodiscard]] bool clear_from(const std::vector<ListedLine>& rows, Turn& t);

    struct Work {
        Doing doing = Doing::nothing;
        bool memory_touched = false;  ///< download: the program memory has been cleared
        std::vector<ProgramLine> program;
        std::string from;                  ///< edit: address from which on the program is replaced
        std::vector<ProgramLine> fresh;    ///< edit: what comes there
        std::vector<std::string> stays;    ///< edit: normal forms of what stands before it
        std::vector<std::string> globals;  ///< edit: user variables that the drive has
        std::size_t left = 0;              ///< edit, clear: lines that the last CP has found
    } work_;
    bool clear_half_ = false;        ///< a download broke off: CP removes what it left, behind every stop
    bool was_away_ = false;          ///< the drive was out of reach since: it may have restarted with another program
    std::string half_from_;          ///< ... from this address on; empty: all of it
    std::vector<std::string> half_;  ///< what that download had sent, as a listing is compared
    bool tidy_ = false;
};

/// A program that was started by a command that is answered when it has ended: BY tells it, and what else may have ended it.
class ProgramEnd : public Part {
public:
    using Part::Part;
    void await(Command command, Turn& t);
    /// A line that the drive took, or may have taken: does it end programs?
    void line_taken(std::string_view line);
    void reported(int error) noexcept;        ///< the last error since its start
    void reported_first(int error) noexcept;  ///< of its first line, before its start was confirmed
    void lost(Reason reason, const std::string& why, Turn& t);
    void watch(Turn& t);  ///< behind a poll

private:
    struct Started {
        Command command;
        std::string ended_by;  ///< a line that ends programs, taken since
        int error = 0;
    };
    std::optional<Started> started_;
};

/// line.setup: a fresh drive gets its name, and each drive the line's rate.
class LineSetupAction final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void sending(Step& step, Request& r) override;
    void done(Turn& t) override;
    void without_success(drive::Failure& how, Turn& t) override;
    /// It gives a fresh drive its name: nothing for others in between, the fresh drive would take it too.
    [[nodiscard]] bool naming() const noexcept;
    void came(Turn& t);
    [[nodiscard]] bool too_late(Instant now) const noexcept;
    [[nodiscard]] bool named() const noexcept;

private:
    void set_rate(bool save, Turn& t);
    bool names_ = false, named_ = false;  ///< the drive is given its name; it is looked for by that
};

/// reset (CTRL+C) and factory_defaults (FD): the drive goes, is looked for and set up again.
class Restart final : public Verb {
public:
    static constexpr Duration limit = std::chrono::seconds(20);  ///< a restarted drive that is not back by then has failed
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void sending(Step& step, Request& r) override;
    void answered(const std::string& data, Turn& t) override;
    [[nodiscard]] bool ended(const Step& step, Verdict v, Turn& t) override;
    void came(const std::string& rate_trouble, Turn& t);
    void watch(Turn& t);
    void over(Outcome o, Reason r, std::string_view what, Turn& t);
    [[nodiscard]] bool too_late(Instant now) const noexcept;

private:
    std::optional<Command> awaited_;  ///< reset: answered when the drive is set up again, also when it was away meanwhile
    Instant until_{};
};

}  // namespace axisgate::mcode
