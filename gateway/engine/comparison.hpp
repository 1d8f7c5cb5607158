// Compares a recorded drive with its twin: the frames that the recording has for the drive are given to the twin at the recorded instants,
// and the twin's answers are compared with those of the drive by the sentences of the family's decoder. This is done for several specimens,
// so that the report can tell which specimen resembles the drive most, and which differences belong to none of them. Nothing is sent to a
// line.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/family.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// A frame as it was recorded.
struct SeenFrame {
    Frame frame;                   ///< `at` is its instant since the first frame of the recording
    std::optional<bool> to_drive;  ///< empty: the recording does not contain it
};
struct ComparedFrame {
    Frame frame;
    bool to_drive = false;
    bool foreign = false;  ///< CAN traffic of others: the twins receive it, and no answer is attributed to it
};

struct ComparisonInput {
    static constexpr std::size_t most_frames = 500'000;

    const Family* family = nullptr;
    const Catalogue* page = nullptr;
    LineKind kind = LineKind::can;
    std::uint32_t bit_rate = 0;                   ///< of a byte line: an answer may be later by its time on the wire; 0: no wire time
    std::vector<std::string> addresses;           ///< of the drives that are compared
    std::map<std::string, std::string> options;   ///< of the twins, and single freedoms by their names; without `specimen`
    std::map<std::string, NonVolatile> memories;  ///< of the twins when the recording begins, by address; absent: factory state
    std::vector<ComparedFrame> frames;            ///< in order of time
    std::vector<std::string> specimens;           ///< "0", "slow", "17", in the order in which they are tried
    Duration tolerance = std::chrono::milliseconds(20);  ///< by which a reply time may be outside a specimen's range
};

struct Difference {
    enum class Kind : std::uint8_t {
        value,    ///< the drive answered otherwise than the twin
        missing,  ///< the twin sent a message that the drive did not send
        extra,    ///< the drive sent a message that the twin did not send
        late,     ///< the same answer, after the specimen's longest reply time
        early     ///< the same answer, before the specimen's shortest reply time
    };
    Kind kind = Kind::value;
    Instant at{};                             ///< since the first frame: of the recorded message; missing: of the request
    std::string request{};                    ///< in words; empty: the drive or the twin sent the message by itself
    std::string recorded{}, twin{};           ///< in words; empty if this side has no message
    Duration reply{}, least{}, most{};        ///< late and early: the recorded reply time, and the specimen's range
    std::vector<std::string> explained_by{};  ///< specimens that do not have this difference (the first five); empty: none of those tried
};
[[nodiscard]] std::string_view name_of(Difference::Kind kind) noexcept;

/// Values that follow from mechanics, temperature or supply, which a model cannot know exactly: all answers to one request.
struct MeasuredDifference {
    std::string request, recorded, twin;  ///< of the answer with the largest difference
    Instant at{};                         ///< of this answer
    std::size_t answers = 0;              ///< that differ by more than one count and 0.1 %
    double largest = 0;                   ///< difference between the two values
};

/// The drive answered the same request differently from an instant on, although nothing was written that changes the twin's answer.
struct RecordedChange {
    Instant at{};
    std::string request, before, after;
};

struct SpecimenScore {
    std::string specimen;
    std::size_t values = 0, missing = 0, extra = 0, times = 0;
    std::size_t freedoms = 0;  ///< in which it differs from the drive of the manual
    [[nodiscard]] std::size_t differences() const noexcept { return values + missing + extra + times; }
};

struct Comparison {
    std::string fault;  ///< not empty: the recording cannot be compared, and why
    std::size_t requests = 0, answers = 0, equal = 0;
    Duration span{};
    Duration shortest_reply{}, median_reply{}, longest_reply{};  ///< recorded
    std::vector<SpecimenScore> scores;                           ///< the best first
    std::vector<std::string> best_in_words;                      ///< the freedoms of the best specimen
    std::vector<Difference> differences;                         ///< from the best specimen, in order of time
    std::vector<MeasuredDifference> measured;
    std::vector<RecordedChange> changes;
    [[nodiscard]] std::size_t unexplained() const noexcept;  ///< differences that no specimen explains
};

[[nodiscard]] Comparison compare(const ComparisonInput& input);

/// The addresses whose drives send frames in this recording of a CAN line, 1 to 127.
[[nodiscard]] std::vector<std::string> addresses_in(const Family& family, const Catalogue& page, std::span<const SeenFrame> frames);
/// The frames with their directions. On CAN the identifiers of the drives decide which frames are answers, unless the recording says that
/// one was sent to the drives; "from the drives" may also be another device of the line. Reports of the controller are left out. On a byte
/// line every frame must have a direction. Uses the other members of `input`.
[[nodiscard]] std::vector<ComparedFrame> with_directions(const ComparisonInput& input, std::span<const SeenFrame> frames);
/// Empty if the decoder of the family knows most messages; otherwise a fault that names the family that knows them.
[[nodiscard]] std::string check_family(const Families& families, const ComparisonInput& input);

}  // namespace axisgate
