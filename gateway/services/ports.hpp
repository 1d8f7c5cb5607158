// The interfaces through which services and doors of the service thread see the rest of the program, one small interface for each topic.
// The code that composes services and doors holds all of them; a service or a handler takes only those that it uses. All are called on the
// service thread and call back there.
#pragma once

#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/backup.hpp"
#include "gateway/services/ports/captures.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/connections.hpp"
#include "gateway/services/ports/descriptions.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/fleet.hpp"
#include "gateway/services/ports/lines.hpp"
#include "gateway/services/ports/modbus.hpp"
#include "gateway/services/ports/parameters.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/recorder.hpp"
#include "gateway/services/ports/registers.hpp"
#include "gateway/services/ports/rehearsal.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/ports/snapshots.hpp"
#include "gateway/services/ports/stage.hpp"
#include "gateway/services/ports/status.hpp"

namespace axisgate {

/// All ports, for the code that composes services and doors.
using Ports =
    PortSet<AxisPort, BackupPort, CapturePort, ClockPort, ConnectionPort, DescriptionPort, DocumentPort, DrivePort, EventPort, FleetPort,
            LinePort, ModbusPort, ParameterPort, RecorderPort, RegisterPort, RehearsalPort, SitePort, SnapshotPort, StagePort, StatusPort>;

}  // namespace axisgate
