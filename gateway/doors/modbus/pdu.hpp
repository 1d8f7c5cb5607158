// From function codes to answers: the Responder turns the requests of all connections into reads, commands and exceptions. A request PDU
// with its unit id gives the answer PDU, or a LateAnswer that is finished when the drives have answered. It knows no socket, so Modbus RTU
// and TCP share it. The order of checks is function, count, address, state.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gateway/doors/modbus/access.hpp"
#include "gateway/doors/modbus/counters.hpp"
#include "gateway/doors/modbus/identification.hpp"
#include "gateway/doors/modbus/request_note.hpp"
#include "gateway/doors/modbus/wire.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/registers/register_image.hpp"
#include "gateway/registers/writer.hpp"

namespace axisgate::modbus {

/// The answer to a write whose commands are outstanding.
struct LateAnswer {
    std::uint8_t unit = 0;
    std::uint8_t function = 0;
    Exception exception = Exception::none;  ///< the first failure decides
    bool reads = false;                     ///< function 23: the registers are read when the write has succeeded
    std::uint16_t read_address = 0;
    std::uint16_t read_count = 0;
    std::uint16_t outstanding = 0;  ///< number of outstanding results
    std::uint8_t echo_size = 0;
    std::array<std::uint8_t, 8> echo{};  ///< the good answer of every other function

    void on_written(Exception e) noexcept {
        if (outstanding > 0) --outstanding;
        if (exception == Exception::none) exception = e;
    }
};

class Responder {
public:
    struct Settings {
        Access access;  ///< allow list, functions, read-only
        std::string version = "0";
        Duration result_timeout = std::chrono::seconds(30);  ///< a result that has not arrived after this time counts as "no answer"
        std::size_t max_commands = 4096;                     ///< limit of outstanding commands of all clients; further writes are answered
                                                             ///< busy (6)
    };
    Responder(DoorPort& port, registers::RegisterImage& image, Settings settings);
    Responder(const Responder&) = delete;
    Responder& operator=(const Responder&) = delete;

    using Client = registers::RegisterWriter::Client;
    /// Answers a request PDU of 1..253 bytes. Returns the size of the answer in `out` (max_pdu bytes). 0: it comes later; `late` is filled,
    /// client.owner is called with `slot` once per outstanding command, never from inside this call, and finish() then makes the answer.
    [[nodiscard]] std::size_t answer(const Client& client, std::uint8_t slot, std::uint8_t unit, std::span<const std::uint8_t> pdu,
                                     Instant now, std::uint8_t* out, LateAnswer& late);
    [[nodiscard]] std::size_t finish(const LateAnswer& late, Instant now, std::uint8_t* out);

    /// True if this request may begin while earlier writes of the same client are outstanding: plain writes only, because a read must see
    /// the earlier writes.
    [[nodiscard]] static bool may_overtake_waiting(std::span<const std::uint8_t> pdu) noexcept;

    /// Must get the results of the door's tickets, and the time.
    [[nodiscard]] registers::RegisterWriter& writer() noexcept { return writer_; }

    [[nodiscard]] const Access& access() const noexcept { return settings_.access; }
    void set_read_only(bool on) noexcept { settings_.access.read_only = on; }
    [[nodiscard]] Counters& counters() noexcept { return counters_; }
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] const DoorPort& port() const noexcept { return port_; }

private:
    struct Request;
    struct Answer {
        Exception exception = Exception::none;
        std::size_t size = 0;
    };
    [[nodiscard]] Answer dispatch(Request& r);
    [[nodiscard]] Answer read_bits(Request& r);
    [[nodiscard]] Answer read_registers(Request& r);
    [[nodiscard]] Answer write_single(Request& r);
    [[nodiscard]] Answer write_multiple(Request& r);
    [[nodiscard]] Answer mask_write(Request& r);
    [[nodiscard]] Answer read_write(Request& r);
    [[nodiscard]] Answer diagnostics(Request& r);
    [[nodiscard]] Answer encapsulated(Request& r);
    /// Carries a write out. Size 0 without an exception: it waits.
    [[nodiscard]] Answer carry_out(Request& r, Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data,
                                   std::size_t echo_size);
    /// Causes an event and sets the axis' registers 20 and 21.
    void refused(const std::string& who, Refused refused, const RequestNote& request, Exception e, Instant now);
    /// Of the standard map; otherwise no_axis.
    [[nodiscard]] AxisId axis_of(std::uint8_t unit, const RequestNote& request) const;
    [[nodiscard]] Refused refused_by_access(std::uint8_t unit, const RequestNote& request) const;
    std::size_t exception_answer(std::uint8_t function, Exception e, std::uint8_t* out) noexcept;

    DoorPort& port_;
    registers::RegisterImage& image_;
    Settings settings_;
    Identity identity_;
    registers::RegisterWriter writer_;
    Counters counters_;
};

}  // namespace axisgate::modbus
