// Authority view: who may command which axis, from where, until when; to whom it could be handed over; and its end for who may not any
// more. In: pictures of axes, what the Modbus door says, clients that were seen. Out: documents; releases of leases. Never gives anybody an
// axis: that is the engine's.
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
/// The connections behind a holder that came by Modbus: all of its host, since one client is one address.
void add_connections(boost::json::object& document, const std::optional<ModbusReport>& report);
[[nodiscard]] bool held_by_modbus(const boost::json::object& document);
/// Who could be named as the next holder: clients that gave themselves a name or signed in, and hosts that are connected by Modbus.
[[nodiscard]] boost::json::array clients_document(const ClientsSeen& clients, const ClockPort& clock,
                                                  const std::optional<ModbusReport>& report);

/// Gives up what this user, or this user's token ("anna line3"), holds: he may not command any more. `by`: who did that.
void end_leases_of(AxisPort& axes, const SitePort& sites, std::string_view client, const std::string& by);

}  // namespace axisgate
