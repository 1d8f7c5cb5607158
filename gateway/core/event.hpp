// Event: something that happened and is kept: alarms, writes, commands, what became of lines, drives and the site.
// In: made by whoever sees it happen. Out: the store and the live feed. Never holds ids of the running process: names alone outlive it.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/core/sample.hpp"

namespace axisgate {

/// What happened; kept in the store and streamed.
struct Event {
    std::uint64_t id = 0;  ///< counts up, without gaps, over the life of the data directory
    std::int64_t at_unix_ns = 0;
    Severity severity = Severity::info;
    std::string kind;               ///< "alarm", "write", "line", "presence", "site", "command", "input", ...
    std::string axis, drive, line;  ///< names; empty where they do not apply
    std::int32_t code = 0;          ///< the drive's own, 0 if none
    std::string text;
    std::string who;  ///< who and from where, for writes and commands; empty otherwise
    std::string door;
    std::string parameter, old_value, new_value;  ///< for writes
};

}  // namespace axisgate
