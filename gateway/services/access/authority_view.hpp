// Shows which client may command which axis, from where and until when, and the candidates for a hand-over; and releases the leases of
// users that lose their permission. The authority itself is decided in the engine.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/services/access/clients_seen.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/modbus.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

[[nodiscard]] boost::json::object authority_document(const AxisPort& axes, const ClockPort& clock, const AxisSpec& spec, AxisId id);
/// Adds the connections of a Modbus holder: all of its host, because one address is one client.
void add_connections(boost::json::object& document, const std::optional<ModbusReport>& report);
[[nodiscard]] bool held_by_modbus(const boost::json::object& document);
/// The candidates for the next holder: clients that gave themselves a name or signed in, and hosts that are connected by Modbus.
[[nodiscard]] boost::json::array clients_document(const ClientsSeen& clients, const ClockPort& clock,
                                                  const std::optional<ModbusReport>& report);

/// Releases the leases of this user, or of this user's token ("anna line3"), which may not command any more. `by` names the cause.
void end_leases_of(AxisPort& axes, const SitePort& sites, std::string_view client, const std::string& by);

}  // namespace axisgate
