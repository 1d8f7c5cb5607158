// An event that is stored and streamed: alarms, writes, commands, changes of lines, drives and the site. It contains names only, because
// ids of the running process do not survive it.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/core/sample.hpp"

namespace axisgate {

/// An event; stored and streamed.
struct Event {
    std::uint64_t id = 0;  ///< increases without gaps over the life of the data directory
    std::int64_t at_unix_ns = 0;
    Severity severity = Severity::info;
    std::string kind;               ///< "alarm", "write", "line", "presence", "site", "command", "input", ...
    std::string axis, drive, line;  ///< names; empty if not applicable
    std::int32_t code = 0;          ///< the drive's own, 0 if none
    std::string text;
    std::string who;  ///< the client and its address, for writes and commands; otherwise empty
    std::string door;
    std::string parameter, old_value, new_value;  ///< for writes
};

}  // namespace axisgate
