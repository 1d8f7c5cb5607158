// Making lines: from a line URI to the line that it names.
// In: a URI, the loop, options. Out: a line, not yet open. Never nullptr: a URI that cannot be is a line that says so and stays down.
#pragma once

#include <memory>
#include <string_view>

#include "gateway/core/line_uri.hpp"
#include "gateway/core/setup.hpp"
#include "gateway/lines/can_line.hpp"
#include "gateway/lines/clock.hpp"
#include "gateway/lines/pair_line.hpp"
#include "gateway/lines/pty_line.hpp"
#include "gateway/lines/real_line.hpp"

namespace axisgate {

/// The line of a checked URI. "twin" is no line of this room (core/twin_bus.hpp) and gives one that stays down.
[[nodiscard]] std::unique_ptr<Line> make_line(const LineUri& uri, const LineBase& base, const CanLineOptions& can = {},
                                              const PtyPlaces& ptys = {}, const PairEnd& fleet = {});

/// The line of a URI's text. A bit rate that the setup knows holds for a serial line whose URI does not say, and
/// for the load of a CAN interface that does not tell its own; `default_format` is the family's (Family::default_format). `stale_after` as
/// in LineBase; `fleet` takes the other end of a mirror line ("dds"); `clock` outlives the line.
[[nodiscard]] std::unique_ptr<Line> make_real_line(std::string_view uri, const LineSetup& setup, boost::asio::io_context& io,
                                                   std::string_view default_format = "8N1", const PtyPlaces& ptys = {},
                                                   Duration stale_after = stale_send_limit, const PairEnd& fleet = {},
                                                   const Clock& clock = machine_clock());

}  // namespace axisgate
