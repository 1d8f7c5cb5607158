// Language is the interface by which Dialogue asks a family about the messages of its drives: the message for each command, and the meaning
// of each answer. Its functions send nothing and read no clock.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

/// The content of an answer, independent of the protocol.
struct Reported {
    bool refused = false;
    std::int32_t code = 0;  ///< error code of a refusal; the catalogue has its text
    std::string text;       ///< the value; for a refusal the received text
};

/// A command as a sequence of exchanges.
template <class Message>
struct DialogueJob {
    Command command;
    std::vector<Message> steps;
    std::size_t at = 0;
    bool streamed = false;  ///< the job is a set-point: it has no result, and it is not repeated because the next set-point is newer
    std::uint64_t number = 0;
};

/// `Message` is a type of the family whose values can be compared.
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
    /// The part of a message by which its answer is recognised: an answer fits a request if their marks are equal.
    [[nodiscard]] virtual Message mark_of(const Message& message) const = 0;
    /// Whether the answer fits the request in the members that the mark does not contain.
    [[nodiscard]] virtual bool answers(const Message& /*request*/, const Message& /*answer*/) const { return true; }
    [[nodiscard]] virtual Reported reported(const Message& answer) const = 0;
    /// A request that changes nothing. `other` selects a second one with another mark, which separates late answers from new ones.
    [[nodiscard]] virtual Message probe(bool other) const = 0;
    /// The text for the link of a drive that was found. `answer` is the answer to the probe; nullptr if another message showed that the
    /// drive is present.
    [[nodiscard]] virtual std::string title(const Message* answer) const = 0;
    /// The request that reads the state of an axis.
    [[nodiscard]] virtual Message poll(int channel) const = 0;
    /// Stores a reported state in the AxisFeedback of its axis, whether it was requested or not. Returns the channel; 0 if the message is
    /// not a state.
    [[nodiscard]] virtual int learn(const Message& answer) = 0;
    /// The request for a Halt, QuickStop or Disable.
    [[nodiscard]] virtual Message stop(const Command& command) const = 0;
    /// Adds the steps of a command. Dialogue itself answers an enable only when a state shows the power. A Move without speed or ramps
    /// keeps those that are set in the drive. Returns an empty text, or why the command is refused.
    [[nodiscard]] virtual std::string plan(Job& job, Reason& reason) const = 0;
    /// A step was successful. The language may add further steps.
    virtual void stepped(Job&, const Message& /*answer*/) {}
    /// The last step was successful: sets the feedback that follows from this before the next poll.
    virtual void acted(const CommandBody&, AxisFeedback&) {}
    /// The text of a request for messages to the user.
    [[nodiscard]] virtual std::string words_of(const Message& request) const = 0;
};

}  // namespace axisgate::drive
