// The state that a recording shows at one instant: every axis, its registers, the last frames with their meaning, the recent events. A
// truncated or altered file is reported, and nothing of it is shown.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "gateway/site/site.hpp"

namespace axisgate {

struct PlaybackWish {
    std::optional<std::int64_t> at_unix_ns{};  ///< empty: the end of the recording
    std::size_t frames = 50;                   ///< at most this number before that instant
    std::size_t columns = 0;                   ///< of the curves of the whole period; 0: none
    static constexpr std::size_t happenings = 50;
};

/// Members: from, to, at; axes (as GET /axes), registers (0..23 of each axis, the high word first), frames, happened, curves (as trends).
/// `families` needs a shelf of its own, which takes the recording's descriptions. Reads the whole file: a tenth of a second for 32 MB.
[[nodiscard]] boost::json::object play_back(std::span<const char> file, const Families& families, const PlaybackWish& wish,
                                            std::string& fault);

}  // namespace axisgate
