// Exchange: one instruction on its way and the wait for its answer; and the memory of answers that may still come late.
// In: requests, answers, time. Out: whether it is over, and when it has to be looked at again.
// Never sends by itself. Fixed size: nothing is allocated for an exchange.
#pragma once

#include <cstdint>

#include "adapters/uim342/wire_instructions.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/drive/exchange.hpp"

namespace axisgate::uim342 {

/// Why something was asked; decides what its answer does.
enum class Purpose : std::uint8_t {
    probe,     ///< ML: is anybody there
    startup,   ///< a value read after a drive was found
    poll,      ///< MS[0] or MS[1]
    error,     ///< ER[0], because ERR appeared
    barrier,   ///< any read: separates late answers from new ones
    clear_mf,  ///< MF=0 after a group exchange whose end is not known
    job,       ///< a step of the present job
    confirm,   ///< a stop repeated behind a motion that it may have overtaken
    orphan     ///< its job has been ended by a stop; the answer is only taken off the line
};

struct Exchange {
    bool active = false;
    Purpose purpose = Purpose::poll;
    Message message;
    std::uint8_t mf = 0;       ///< group that the value belongs to
    std::uint8_t tries = 0;    ///< sent so often
    std::uint8_t left = 0;     ///< may be sent again so often
    bool probe_place = false;  ///< holds a place of those for silent drives
    Instant sent{};
    Instant deadline = never;
};

/// Of instructions that were given up, or sent twice.
using LateAnswers = drive::LateMarks<std::uint16_t>;

}  // namespace axisgate::uim342
