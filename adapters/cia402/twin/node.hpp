// Node: the CANopen side of the simulated device: SDO server, NMT, error control, PDOs as they are mapped, SYNC, EMCY, memory.
// In: frames, time. Out: frames with the instant of their cause. Never answers while it is silent or without power.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>

#include "adapters/cia402/twin/device.hpp"
#include "adapters/cia402/twin/freedoms.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/protocols/canopen/pdo.hpp"
#include "gateway/protocols/canopen/sdo_server.hpp"

namespace axisgate::cia402_drive::twin {

class Node {
public:
    static constexpr std::uint16_t pdos = 4;  ///< of each direction
    Node(std::uint8_t node, canopen::Dictionary dictionary);
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;
    /// What stands behind it: before anything else is asked. Made over `dictionary()`.
    void attach(Device& device) noexcept { device_ = &device; }

    void power_on(const NonVolatile& memory, Instant now, Out& out);
    void power_off(Instant now);
    void on_frame(const Frame& frame, Instant now, Out& out);
    /// Everything that happens by itself until then, in order, each with its own instant.
    void advance(Instant now, Out& out);
    [[nodiscard]] Instant deadline() const;
    /// Of the pre-defined connection set: its own identifiers, NMT and SYNC, and those of the node whose heartbeat it watches.
    [[nodiscard]] Acceptance acceptance() const noexcept;

    /// How it answers and what it lets be set up, from now on.
    void set_freedoms(const Freedoms& freedoms) noexcept { free_ = freedoms; }

    [[nodiscard]] NonVolatile stored() const { return stored_; }
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
    [[nodiscard]] canopen::Dictionary& dictionary() noexcept { return d_; }
    [[nodiscard]] const canopen::Dictionary& dictionary() const noexcept { return d_; }
    void set_silent(bool silent) noexcept { silent_ = silent; }
    [[nodiscard]] bool silent() const noexcept { return silent_; }
    [[nodiscard]] bool powered() const noexcept { return powered_; }
    void after_hand(Instant now, Out& out) {
        shown_.reset();
        take_writes(now, out);  // also what a controller's own program has written
    }

private:
    struct Pdo {
        canopen::Pdo pdo;
        bool valid = false;
        int syncs = 0;                               ///< since it was sent, or began to count
        int start = 0;                               ///< sub 6: the counter of the SYNC that is its first; 0: any
        bool begun = false;                          ///< that one has come
        std::vector<const canopen::Entry*> entries;  ///< of what is mapped, in d_; null: a filler, or not there
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
    void show(Instant now);  ///< what is measured stands in the dictionary
    [[nodiscard]] bool may_set_up(canopen::Address address) const noexcept;
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
    void events(Instant at, Out& out);  ///< EMCY, and PDOs that are sent by event

    static constexpr std::size_t most_requests = 8;  ///< that wait for their answer; what is more is lost
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
    int sync_overflow_ = 0;  ///< 1019h; 0: a SYNC carries no counter
    bool sync_odd_ = false;  ///< the last one had another length
    canopen::HeartbeatProducer heartbeat_;
    canopen::GuardSlave guard_;
    canopen::HeartbeatWatch watch_{0};  ///< of the node that 1016h:01 names
    std::uint8_t watched_ = 0;
    std::array<Pdo, pdos> receive_, transmit_;
    std::vector<canopen::Address> writes_;
    Instant now_{};
    std::optional<Instant> shown_{};  ///< of what stands in the dictionary; nothing: something has happened since
    NonVolatile stored_;
    std::uint64_t revision_ = 0;
    bool powered_ = false, silent_ = false, restore_ = false;
};

}  // namespace axisgate::cia402_drive::twin
