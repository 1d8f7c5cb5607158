// Node is the CANopen part of the simulated device: SDO server, NMT, error control, mapped PDOs, SYNC, EMCY, memory. It does not answer
// while it is silent or without power.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>

#include "adapters/cia402/twin/device.hpp"
#include "adapters/cia402/twin/freedoms.hpp"
#include "adapters/cia402/twin/late_heartbeat.hpp"
#include "adapters/cia402/twin/pdo_rules.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/protocols/canopen/pdo.hpp"
#include "gateway/protocols/canopen/sdo_server.hpp"

namespace axisgate::cia402_drive::twin {

class Node {
public:
    Node(std::uint8_t node, canopen::Dictionary dictionary);
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;
    /// The device behind the node, which was made with `dictionary()`. Must be called first.
    void attach(Device& device) noexcept { device_ = &device; }

    void power_on(const NonVolatile& memory, Instant now, Out& out);
    void power_off(Instant now);
    void on_frame(const Frame& frame, Instant now, Out& out);
    /// All events until `now`, in order, each with its own instant.
    void advance(Instant now, Out& out);
    [[nodiscard]] Instant deadline() const;
    /// The identifiers of the pre-defined connection set: its own ones, NMT, SYNC, and those of the node whose heartbeat it monitors.
    [[nodiscard]] Acceptance acceptance() const noexcept;

    /// How it answers and which set-up it accepts, from now on. Objects and PDOs of the drive's own change with the next reset.
    void set_freedoms(const Freedoms& freedoms) noexcept {
        free_ = freedoms;
        heartbeat_.set_jitter(free_.heartbeat_jitter, free_.seed);
    }

    [[nodiscard]] NonVolatile stored() const { return stored_; }
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
    [[nodiscard]] canopen::Dictionary& dictionary() noexcept { return d_; }
    [[nodiscard]] const canopen::Dictionary& dictionary() const noexcept { return d_; }
    void set_silent(bool silent) noexcept { silent_ = silent; }
    [[nodiscard]] bool silent() const noexcept { return silent_; }
    [[nodiscard]] bool powered() const noexcept { return powered_; }
    void after_hand(Instant now, Out& out) {
        shown_.reset();
        take_writes(now, out);  // also writes of a controller's own program
    }

private:
    struct Pdo {
        canopen::Pdo pdo;
        bool valid = false;
        int syncs = 0;                               ///< since the PDO was sent, or began to count
        int start = 0;                               ///< sub 6: the counter of the SYNC that is its first; 0: any
        bool begun = false;                          ///< that SYNC has arrived
        std::vector<const canopen::Entry*> entries;  ///< the mapped entries, in d_; nullptr: a dummy entry or a missing one
        std::vector<std::uint8_t> sent, waiting;
        Instant event = never;
    };
    void send(Frame frame, Instant at, Out& out) const;
    void boot(Instant now, Out& out);
    void reset(bool all, Instant now, Out& out);
    void load();
    void save();
    [[nodiscard]] canopen::Abort on_write(canopen::Address address, std::span<const std::uint8_t> bytes);
    void take_writes(Instant now, Out& out);
    void read_sync();
    void read_pdos(Instant now);
    void read_pdo(canopen::PdoDirection direction, std::uint16_t number, Instant now);
    void show(Instant now);  ///< writes the measured values into the dictionary
    void keep_request(const Frame& request, Instant now);
    void serve_request(const Frame& request, Instant at, Out& out);
    void nmt(canopen::NmtCommand command, Instant now, Out& out);
    void receive(Pdo& p, std::span<const std::uint8_t> bytes, Instant now, Out& out);
    void transmit(Pdo& p, Instant at, Out& out);
    [[nodiscard]] std::vector<std::uint8_t> packed(const Pdo& p, Instant at);
    void on_sync(const Frame& sync, Instant now, Out& out);
    [[nodiscard]] bool due(Pdo& p, int counter) const;
    void watch_as_written();
    void connection_lost(Instant at, Out& out);
    void events(Instant at, Out& out);  ///< EMCY, and event-driven PDOs
    void send_changed(Instant at, Out& out);

    static constexpr std::size_t most_requests = 8;  ///< that wait for their answer; further ones are lost
    struct Request {
        Frame frame;
        Instant due;
    };
    std::uint8_t node_;
    Freedoms free_;
    std::deque<Request> requests_;
    canopen::Dictionary factory_, d_;
    Device* device_ = nullptr;
    canopen::SdoServer server_;
    canopen::NmtState state_ = canopen::NmtState::boot_up;
    std::uint32_t sync_id_ = 0x80;
    int sync_overflow_ = 0;  ///< 1019h; 0: SYNC has no counter
    bool sync_odd_ = false;  ///< the last SYNC had a wrong length
    LateHeartbeat heartbeat_;
    canopen::GuardSlave guard_;
    canopen::HeartbeatWatch watch_{0};  ///< the node in 1016h:01
    std::uint8_t watched_ = 0;
    std::array<Pdo, pdos> receive_, transmit_;
    std::vector<canopen::Address> writes_;
    Instant now_{};
    Instant awake_at_ = never;        ///< it restarts, and hears and says nothing until then
    Instant other_stop_ = never;      ///< another master stops the node
    bool other_stopped_ = false;      ///< or will
    std::optional<Instant> shown_{};  ///< of the measured values in the dictionary; empty: they are out of date
    NonVolatile stored_;
    std::uint64_t revision_ = 0;
    bool powered_ = false, silent_ = false, restore_ = false;
};

}  // namespace axisgate::cia402_drive::twin
