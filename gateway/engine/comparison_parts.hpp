// The parts of a comparison: messages in words, the playing of a recording to twins, the pairing of two lists of messages, and the values
// that follow from mechanics. Only for comparison*.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "gateway/engine/comparison.hpp"

namespace axisgate::comparison {

inline constexpr std::size_t none = static_cast<std::size_t>(-1);

/// One message of a drive or a twin.
struct Message {
    Instant at{};
    std::size_t cause = none;  ///< number of the request before it; for a prompt message the request that caused it; none: before the first
    bool prompt = false;       ///< a twin sent it when it received the request; unknown (false) for recorded messages
    std::uint32_t stream = 0;  ///< CAN: its identifier, within which the order of messages is compared; bytes: 0
    std::uint16_t size = 0;    ///< bytes of its last frame
    std::string text;          ///< the decoder's sentence
};

struct Requests {
    std::vector<std::size_t> frames;  ///< index of each request among the frames
    std::vector<Instant> at;
    std::vector<std::string> text;  ///< empty for a run of bytes that completes no message
};
[[nodiscard]] Requests requests_of(const ComparisonInput& input);
[[nodiscard]] std::vector<Message> recorded_messages(const ComparisonInput& input);

/// How a play differs from the recording, to find the values that follow from mechanics.
struct Disturbance {
    double time = 1;            ///< factor of all instants
    std::int64_t position = 0;  ///< increments by which the shaft was moved by hand before the recording; 0: it was not
};
struct Play {
    std::vector<Message> messages;       ///< in order of time
    std::vector<Instant> memory_writes;  ///< the non-volatile memory changed at these instants
};
/// A twin of the input's drives as this specimen, without the freedoms that all families share.
[[nodiscard]] std::unique_ptr<Twin> make_twin(const ComparisonInput& input, const std::string& address, const std::string& specimen);
/// The twins as this specimen without the freedoms that all families share: their effects on time and number of messages are calculated,
/// because a drawn loss or delay would be at another message than that of the drive.
[[nodiscard]] Play play(const ComparisonInput& input, const std::string& specimen, const Disturbance& disturbance = {});

/// A sentence as text with places for numbers.
struct Shape {
    std::string text;                       ///< with # for each number
    std::vector<std::string_view> numbers;  ///< views into the sentence
    std::vector<std::string_view> labels;   ///< the word before " = " in front of each number; empty: none
};
[[nodiscard]] Shape shape_of(std::string_view sentence);

/// The places of sentences whose numbers follow from mechanics.
class Measured {
public:
    explicit Measured(const Catalogue& page);
    /// Numbers that differ between two plays of the same specimen.
    void learn(const Requests& requests, const std::vector<Message>& a, const std::vector<Message>& b);
    /// Whether the differences between these two sentences are only in such places. `largest`: the difference of the numbers.
    [[nodiscard]] bool only(const Requests& requests, const Message& recorded, const Message& twin, double& largest) const;

private:
    [[nodiscard]] static std::size_t key(const Requests& requests, const Message& m, const Shape& shape, std::size_t number);
    std::unordered_set<std::size_t> places_;
    std::set<std::string, std::less<>> names_;  ///< of the page's parameters with measured values
};

struct Pair {
    std::size_t recorded = none, twin = none;  ///< none: this side has no such message
};
/// The time by which an answer may be later than that of the twin.
struct ReplyRange {
    Duration least{}, most{};
};
/// Every message of both lists once, in order of time.
[[nodiscard]] std::vector<Pair> pair_messages(const Requests& requests, const std::vector<Message>& recorded,
                                              const std::vector<Message>& twin, const ReplyRange& range);

}  // namespace axisgate::comparison
