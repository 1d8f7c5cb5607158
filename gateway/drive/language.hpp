// Language: what Dialogue asks a family about its drives' messages: how each is worded, what each means.
// In: commands, messages. Out: messages, values, words for people. Never keeps what it was asked, sends or reads a clock.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

/// What an answer says, whatever the language.
struct Reported {
    bool refused = false;
    std::int32_t code = 0;  ///< of the refusal: the catalogue has its words
    std::string text;       ///< the value; of a refusal what came
};

/// A command taken apart into exchanges, one after the other.
template <class Message>
struct DialogueJob {
    Command command;
    std::vector<Message> steps;
    std::size_t at = 0;
    bool streamed = false;  ///< a set-point: it owes no result, and is not repeated, because the next one is newer
    std::uint64_t number = 0;
};

/// `Message` is the family's: a value that can be compared.
template <class Message>
class Language {
public:
    using Job = DialogueJob<Message>;
    Language() = default;
    Language(const Language&) = delete;
    Language& operator=(const Language&) = delete;
    virtual ~Language() = default;

protected:
    [[nodiscard]] virtual Frame frame_of(const Message& request) const = 0;
    /// A message without what its answer cannot be known by: an answer fits a request if their marks are equal.
    [[nodiscard]] virtual Message mark_of(const Message& message) const = 0;
    /// What a write is answered with, besides its mark.
    [[nodiscard]] virtual bool answers(const Message& /*request*/, const Message& /*answer*/) const { return true; }
    [[nodiscard]] virtual Reported reported(const Message& answer) const = 0;
    /// A request that changes nothing, and another one with another mark: whether somebody is there; what parts late answers from new ones.
    [[nodiscard]] virtual Message probe(bool other) const = 0;
    /// What the link says of a drive that was found; `answer` is the probe's, nullptr if it was found by something else.
    [[nodiscard]] virtual std::string title(const Message* answer) const = 0;
    /// The question for the state of an axis.
    [[nodiscard]] virtual Message poll(int channel) const = 0;
    /// A state of an axis, whoever asked for it: taken into its AxisFeedback. Returns the channel; 0: it is none.
    [[nodiscard]] virtual int learn(const Message& answer) = 0;
    /// The request of a Halt, QuickStop or Disable.
    [[nodiscard]] virtual Message stop(const Command& command) const = 0;
    /// Adds the steps of a command; a Move without speed or ramps leaves those that the drive has. Empty, or why it is refused.
    [[nodiscard]] virtual std::string plan(Job& job, Reason& reason) const = 0;
    /// A step was answered well: more steps may be added.
    virtual void stepped(Job&, const Message& /*answer*/) {}
    /// The last step was: what is known by that before the next poll.
    virtual void acted(const CommandBody&, AxisFeedback&) {}
    /// A request in messages for people.
    [[nodiscard]] virtual std::string words_of(const Message& request) const = 0;
};

}  // namespace axisgate::drive
