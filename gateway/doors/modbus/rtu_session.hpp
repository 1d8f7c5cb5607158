// RTU session: a slave on a serial line: whose frames it answers, what a broadcast does, and which answers nobody waits for any more.
// In: good frames, results of its writes. Out: answers as bytes with checksum, at most one per frame.
// Never answers a frame of another slave, a broadcast, or a request after which anything else was heard. Never touches a port or a clock.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "gateway/doors/modbus/pdu.hpp"
#include "gateway/doors/modbus/rtu_receiver.hpp"

namespace axisgate::modbus {

/// Written by the thread that serves, read by any.
struct RtuCounters {
    Counter foreign;       ///< good frames of other slaves
    Counter broadcasts;    ///< requests to address 0
    Counter answers;       ///< sent, exceptions among them
    Counter late_answers;  ///< not sent: the master had begun something else before the drive answered
    Counter writes;        ///< requests to this gateway that write, broadcasts among them
};

/// The port, as the session sees it.
struct RtuSink {
    /// Sends an answer: address, PDU, checksum. `repeats_request`: it has the bytes of its request.
    virtual void send(std::span<const std::uint8_t> adu, bool repeats_request) = 0;
    /// All drives have answered: finish() can be called, but not from inside this call.
    virtual void answered() = 0;
    virtual ~RtuSink() = default;
};

class RtuSession final : public registers::WriteOwner {
public:
    static constexpr std::uint8_t broadcast = 0, first_address = 1, last_address = 247;

    /// `address` (1..247): where the standard map stands, or the site's user map of that unit if it has one. The site's other units
    /// (2..247) stand under their numbers.
    RtuSession(Responder& responder, registers::RegisterImage& image, RtuSink& sink, std::uint8_t address,
               std::shared_ptr<const std::string> who)
        : responder_(responder), image_(image), sink_(sink), address_(address), client_{this, std::move(who)} {}
    ~RtuSession() override;
    RtuSession(const RtuSession&) = delete;
    RtuSession& operator=(const RtuSession&) = delete;

    /// The unit id behind a slave address; nothing: another slave's.
    [[nodiscard]] std::optional<std::uint8_t> unit_of(std::uint8_t address) const noexcept;

    /// `overtaken`: more was heard since; what is asked is carried out, and not answered.
    void on_frame(const RtuFrame& frame, Instant now, bool overtaken = false);
    /// Sends the answer that waited, if it still may.
    void finish(Instant now);
    /// Something is heard on the line, or it is down: who asked last has given up.
    void give_up() noexcept;

    [[nodiscard]] bool waits() const noexcept { return waits_; }
    /// Of the last request to this gateway.
    [[nodiscard]] std::optional<Instant> received() const noexcept { return received_; }
    /// A write was carried out on some axis since forget_commands().
    [[nodiscard]] bool has_commanded() const noexcept { return commanded_; }
    void forget_commands() noexcept { commanded_ = false; }
    [[nodiscard]] const std::string& who() const noexcept { return *client_.who; }
    [[nodiscard]] const RtuCounters& counters() const noexcept { return counters_; }

    void on_written(std::uint8_t slot, AxisId axis, Verdict verdict) override;

private:
    void send(std::uint8_t address, std::size_t pdu_size, std::span<const std::uint8_t> request);

    Responder& responder_;
    registers::RegisterImage& image_;
    RtuSink& sink_;
    std::uint8_t address_;
    Responder::Client client_;
    RtuCounters counters_;
    LateAnswer late_;
    RtuFrame asked_{};             // whose answer waits
    std::uint8_t generation_ = 0;  // of the answer that waits: results of those before it come with another slot
    Instant begun_{};
    bool waits_ = false;
    bool commanded_ = false;
    std::optional<Instant> received_;
    std::array<std::uint8_t, rtu_max_frame> out_{};
};

}  // namespace axisgate::modbus
