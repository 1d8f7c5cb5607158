// Framing: finds the answer to one request in the bytes that come back: echo, ACK and NAK, prompts, data with its mark.
// In: what was asked, bytes. Out: whether it is answered, and the data.
// Never takes foreign text for an answer: data count only behind the mark of the very question, and with their checksum where it is on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::mcode {

/// What is waited for.
struct Expect {
    enum class Kind : std::uint8_t {
        nothing,  ///< EM = 2: the drive says nothing [L2664]
        command,  ///< ACK, NAK, CR LF or a prompt, as EM and CK have it
        query,    ///< PR with a mark in quotes as its first item
        block     ///< text of unknown length: everything until the line falls silent, or with `ends` what stands before the closing answer
    };
    Kind kind = Kind::query;
    std::string mark;       ///< query: what the data begin with
    bool end_mark = false;  ///< query: the data end with `end_of_data` and may have several lines
    bool checksum = false;  ///< CK is on
    bool prompt = false;    ///< EM = 0: a prompt is the last character
    bool ends = false;      ///< block: silence is no end; a marked question asked behind it (close_with) is, since a drive answers in order
    std::string sent{};     ///< the line without its terminator, which may come back as an echo
    bool trailing = false;  ///< query: the acknowledgement may stand behind the data (E-4) and is waited for if none stood before them
};
inline constexpr char end_of_data = '~';

enum class Verdict : std::uint8_t {
    waiting,
    answered,      ///< query: `data()` holds it
    acknowledged,  ///< command: the drive took the line
    refused,       ///< NAK, or the prompt `?`: a wrong checksum or an error of the drive
    garbled        ///< the answer, but spoiled
};

/// Where the acknowledgement of an answered question stood (CR LF; ACK with CK on).
enum class AckPlace : std::uint8_t { none, before, behind };

class ReplyReader {
public:
    /// Bytes kept for one answer. More is dropped from the front; a listing of the whole program memory fits.
    static constexpr std::size_t limit = 64 * 1024;

    void begin(Expect expect);
    [[nodiscard]] Verdict push(std::string_view bytes);
    /// Block: the line is silent, and this question with this mark is being sent. Its answer, `data()`, ends the block; what comes before
    /// that still belongs to it. May be called again with another mark.
    void close_with(std::string mark, std::string sent);
    [[nodiscard]] bool closing() const noexcept { return closing_; }
    /// The time is over, or the line has fallen silent: what can be said of what there is.
    [[nodiscard]] Verdict give_up();
    [[nodiscard]] const std::string& data() const noexcept { return data_; }
    /// Block with `ends`: what came before its closing answer, without the echo of closing questions.
    [[nodiscard]] const std::string& block() const noexcept { return block_; }
    /// More came than is kept: the beginning is lost.
    [[nodiscard]] bool overflowed() const noexcept { return overflowed_; }
    /// Everything that came, for native exchanges.
    [[nodiscard]] const std::string& raw() const noexcept { return raw_; }
    /// What came before the answer and is none: echo, output of programs, noise.
    [[nodiscard]] const std::string& before() const noexcept { return before_; }

    /// What came behind the answer in the same run: output of programs, prompts.
    [[nodiscard]] const std::string& behind() const noexcept { return behind_; }
    /// Question: a NAK has come and no data: refused, unless data follow soon (then the NAK was noise).
    [[nodiscard]] bool maybe_refused() const noexcept { return maybe_refused_; }
    /// Question: its data are complete, and an acknowledgement behind them is waited for.
    [[nodiscard]] bool awaits_trailing() const noexcept { return awaits_trailing_; }
    [[nodiscard]] AckPlace acknowledgement() const noexcept { return acknowledgement_; }
    /// Nothing of an answer has come: no acknowledgement, and no data of a question. Output of programs, echoes and noise are none.
    [[nodiscard]] bool nothing_of_it() const { return expect_.kind != Expect::Kind::query || find_mark() == std::string::npos; }
    /// Question: its end came (CR LF; ACK where checksums are on) and nothing else but echo and prompt: it was taken like a line that
    /// prints nothing. So program mode stores it; without checksums a refusal looks the same.
    [[nodiscard]] bool taken_without_answer() const;

private:
    [[nodiscard]] Verdict look(bool over);
    [[nodiscard]] Verdict look_for_acknowledgement(bool over);
    [[nodiscard]] Verdict look_for_data(bool over);
    [[nodiscard]] Verdict look_without_mark(bool over);
    [[nodiscard]] Verdict look_for_end(bool over);
    [[nodiscard]] std::size_t find_mark() const;
    [[nodiscard]] std::size_t find_bare_end(std::string_view text) const;
    [[nodiscard]] AckPlace find_acknowledgement(std::string_view before, std::string_view behind) const;
    [[nodiscard]] std::size_t find_end(std::size_t mark) const;
    Expect expect_;
    std::string raw_, data_, before_, behind_, block_;
    std::vector<std::string> asked_;  ///< closing questions, as sent without their terminator; bounded by the line's retries
    std::size_t close_from_ = 0;      ///< of raw_: no closing answer begins before
    bool closing_ = false, overflowed_ = false;
    bool maybe_refused_ = false;
    bool awaits_trailing_ = false;
    AckPlace acknowledgement_ = AckPlace::none;
};

/// Checksums in a block with CK on: one behind the whole (E-5) or one at the end of each line, both are taken. A block without any is good:
/// nothing was printed.
[[nodiscard]] bool block_sums_good(std::string_view raw);

/// Text of a native answer: without echo of the request, ACK, NAK, checksum, prompt and outer line ends.
[[nodiscard]] std::string plain_text(std::string_view raw, std::string_view sent, bool checksum);

}  // namespace axisgate::mcode
