// A slave on a serial line: which frames it answers, the effect of broadcasts, and which answers are not awaited any more. Frames of other
// slaves, broadcasts, and requests after which other data were received are not answered. Port and clock are elsewhere.
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
    Counter broadcasts;    ///< sent, including exceptions
    Counter answers;       ///< sent, exceptions among them
    Counter late_answers;  ///< not sent: the master had sent something else before the drive answered
    Counter writes;        ///< writes to this gateway, including broadcasts
};

/// The port, as the session sees it.
struct RtuSink {
    /// Sends an answer: address, PDU, checksum. `repeats_request`: it has the same bytes as its request.
    virtual void send(std::span<const std::uint8_t> adu, bool repeats_request) = 0;
    /// All drives have answered: finish() can be called, but not from inside this call.
    virtual void answered() = 0;
    virtual ~RtuSink() = default;
};

class RtuSession final : public registers::WriteOwner {
public:
    static constexpr std::uint8_t broadcast = 0, first_address = 1, last_address = 247;

    /// `address` (1..247) has the standard map, or the site's user map of that unit if there is one. The site's other units (2..247) have
    /// their own numbers.
    RtuSession(Responder& responder, registers::RegisterImage& image, RtuSink& sink, std::uint8_t address,
               std::shared_ptr<const std::string> who)
        : responder_(responder), image_(image), sink_(sink), address_(address), client_{this, std::move(who)} {}
    ~RtuSession() override;
    RtuSession(const RtuSession&) = delete;
    RtuSession& operator=(const RtuSession&) = delete;

    /// The unit id of a slave address; empty: another slave's.
    [[nodiscard]] std::optional<std::uint8_t> unit_of(std::uint8_t address) const noexcept;

    /// `overtaken`: further data were received since; the request is carried out, and not answered.
    void on_frame(const RtuFrame& frame, Instant now, bool overtaken = false);
    /// Sends the waiting answer, if it is still permitted.
    void finish(Instant now);
    /// Data were received on the line, or it is down: the answer is not awaited any more.
    void give_up() noexcept;

    [[nodiscard]] bool waits() const noexcept { return waits_; }
    /// Of the last request to this gateway.
    [[nodiscard]] std::optional<Instant> received() const noexcept { return received_; }
    /// A write was carried out on an axis since forget_commands().
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
    RtuFrame asked_{};             // the request whose answer waits
    std::uint8_t generation_ = 0;  // of the waiting answer: results of earlier ones have another slot
    Instant begun_{};
    bool waits_ = false;
    bool commanded_ = false;
    std::optional<Instant> received_;
    std::array<std::uint8_t, rtu_max_frame> out_{};
};

}  // namespace axisgate::modbus
