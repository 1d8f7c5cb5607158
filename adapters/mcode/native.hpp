// NativeLines: a person's own line of MCode, and the actions that are one line.
// In: native commands, actions. Out: the line as it is, or why it cannot be said.
// Never lets a line through that takes the drive from this gateway: PG, and words that belong to the line.
#pragma once

#include <string>

#include "adapters/mcode/drive_job.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::mcode {

class NativeLines final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
};

/// Actions that are a word of the language, or have a name for one.
class PlainActions final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void done(Turn& t) override;
};

/// Family::stated. A line is read as the drive would, without its program and its variables.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::mcode
