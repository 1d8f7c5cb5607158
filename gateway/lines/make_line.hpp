// Making lines: creates the line that a line URI describes, not yet open.
// The result is never nullptr: for a URI that cannot be used, it is a line that stays down and reports the reason.
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

/// Creates the line of a checked URI. "twin" is not handled here (see core/twin_bus.hpp) and gives a line that stays down.
[[nodiscard]] std::unique_ptr<Line> make_line(const LineUri& uri, const LineBase& base, const CanLineOptions& can = {},
                                              const PtyPlaces& ptys = {}, const PairEnd& fleet = {});

/// Creates the line of a URI's text. The bit rate of the setup applies to a serial line whose URI gives none, and to the load of a CAN
/// interface that does not report its own; `default_format` is the one of the family (Family::default_format). `stale_after` is as in
/// LineBase; `fleet` takes the other end of a mirror line ("dds"); `clock` outlives the line.
[[nodiscard]] std::unique_ptr<Line> make_real_line(std::string_view uri, const LineSetup& setup, boost::asio::io_context& io,
                                                   std::string_view default_format = "8N1", const PtyPlaces& ptys = {},
                                                   Duration stale_after = stale_send_limit, const PairEnd& fleet = {},
                                                   const Clock& clock = machine_clock());

}  // namespace axisgate
