// The owners of all ports of the service thread. Service thread only, except for the mailboxes and WarmEvents::written.
#pragma once

#include <memory>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/warm_axes.hpp"
#include "gateway/runtime/warm_backup.hpp"
#include "gateway/runtime/warm_captures.hpp"
#include "gateway/runtime/warm_connections.hpp"
#include "gateway/runtime/warm_descriptions.hpp"
#include "gateway/runtime/warm_documents.hpp"
#include "gateway/runtime/warm_events.hpp"
#include "gateway/runtime/warm_fleet.hpp"
#include "gateway/runtime/warm_lines.hpp"
#include "gateway/runtime/warm_modbus.hpp"
#include "gateway/runtime/warm_parameters.hpp"
#include "gateway/runtime/warm_recorder.hpp"
#include "gateway/runtime/warm_registers.hpp"
#include "gateway/runtime/warm_rehearsal.hpp"
#include "gateway/runtime/warm_site.hpp"
#include "gateway/runtime/warm_stage.hpp"
#include "gateway/runtime/warm_status.hpp"
#include "gateway/services/ports.hpp"

namespace axisgate {

class WarmClock final : public ClockPort {
public:
    [[nodiscard]] std::int64_t now_unix_ns() const override { return unix_now_ns(); }
    [[nodiscard]] std::int64_t to_unix_ns(Instant instant) const override { return unix_ns_of(instant); }
};

class WarmPorts {
    std::unique_ptr<StoreReader> reader_;
    Doorbell bell_;
    WarmThreads threads_;

public:
    WarmPorts(boost::asio::io_context& warm, Hot& hot, Cold& cold, Families families, std::unique_ptr<StoreReader> reader)
        : reader_(std::move(reader)), bell_(warm), threads_{warm, bell_, hot, cold, *reader_}, site(threads_, events, std::move(families)) {
        site.listen(&parameters);
    }
    WarmPorts(const WarmPorts&) = delete;
    WarmPorts& operator=(const WarmPorts&) = delete;

    [[nodiscard]] Ports all() {
        return {axes,  backup, captures,   clock,    connections, descriptions, documents, drives,    events, fleet,
                lines, modbus, parameters, recorder, registers,   rehearsal,    site,      snapshots, stage,  status};
    }
    /// The bell by which other threads wake this one.
    [[nodiscard]] Doorbell& bell() noexcept { return bell_; }
    /// The mailboxes for the output of the hot thread to this one.
    [[nodiscard]] Hot::Outlets outlets() { return {&axes.results(), &parameters.samples(), &threads_.cold.from_hot()}; }

    WarmClock clock;
    WarmEvents events{threads_};
    WarmSite site;
    WarmStage stage{threads_, events, site};
    WarmAxes axes{threads_};
    WarmParameters parameters{threads_, axes};
    WarmLines lines{threads_, events};
    WarmDrives drives{threads_, site};
    WarmDescriptions descriptions{threads_, site.families().descriptions};
    WarmDocuments documents{threads_};
    WarmSnapshots snapshots{threads_};
    WarmRecorder recorder{threads_, events, site};
    WarmCaptures captures{threads_, recorder, events};
    WarmRegisters registers{threads_};
    WarmRehearsal rehearsal{threads_, site.families()};
    WarmFleet fleet;
    WarmModbus modbus{threads_, events};
    WarmConnections connections{threads_, events};
    WarmBackup backup{threads_, events};
    WarmStatus status{threads_, events, site, axes, drives};
};

}  // namespace axisgate
