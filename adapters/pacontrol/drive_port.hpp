// Port: the serial port of one control: one request and its acknowledgement at a time, and everything that can go wrong between them.
// In: requests, bytes, the passing of time. Out: frames; acknowledgements and silences, given to the drive with what was asked.
// Never takes an acknowledgement for another request's: it carries no mark, so after a silence a barrier sorts late ones out.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "adapters/pacontrol/drive_control.hpp"
#include "gateway/drive/exchange.hpp"

namespace axisgate::pacontrol {

/// Why something is sent.
enum class Purpose : std::uint8_t { probe, barrier, look, job, processing, stop, renew, give_back, poll };

/// One of the values that are read again and again.
struct Poll {
    std::uint16_t code = 0;  ///< that reads it
    std::size_t axis = 0;
    std::uint8_t parameter = 0;  ///< AxisDemand::Parameter
};

/// What was sent.
struct Sent {
    Purpose purpose = Purpose::probe;
    std::size_t axis = 0;
    Request request{};
    bool eot = false;  ///< the lone EOT instead
    Poll poll{};
    Ticket order = no_ticket;  ///< the command for which it is sent
};

class Port : public Part {
public:
    using Part::Part;

    void send(Sent what, Priority priority, Turn& t);
    /// As they are; `what` stands for them.
    void send_raw(Sent what, std::span<const std::uint8_t> bytes, Turn& t);
    /// Sends what brings the line back into step, if that is needed.
    [[nodiscard]] bool send_barrier(Turn& t);
    void on_bytes(std::span<const std::uint8_t> bytes, Turn& t);
    void on_deadline(Turn& t);
    void forget();

    [[nodiscard]] bool busy() const noexcept { return exchange_.active(); }
    /// Nothing is on its way, and the pause after an answer is over.
    [[nodiscard]] bool free(Instant now) const noexcept { return !busy() && now >= quiet_until_; }
    [[nodiscard]] Instant deadline() const noexcept { return busy() ? exchange_.deadline() : quiet_until_; }
    /// An answer may still come late: what is answered now may have been another request.
    [[nodiscard]] bool out_of_step() const noexcept { return out_of_step_; }
    void lose_step() noexcept { out_of_step_ = true; }
    void restart(Instant now) noexcept { quiet_until_ = now; }
    /// The frame of the last acknowledgement.
    [[nodiscard]] const std::vector<std::uint8_t>& raw_reply() const noexcept { return raw_reply_; }

private:
    void begin(Sent what, std::span<const std::uint8_t> bytes, Priority priority, Turn& t);
    void on_text(std::string_view text, std::string_view digits, Turn& t);
    void garbled(std::string_view what, Turn& t);
    void on_reply(const Reply& reply, Turn& t);
    void unasked(const Reply& reply, Turn& t);
    [[nodiscard]] bool is_of_another(const Sent& sent, const Reply& reply);
    void check_refused(const Reply& reply, Turn& t);
    void silent(Turn& t);
    void regain_step();

    Framer framer_;
    drive::Exchange<Sent> exchange_;
    Instant quiet_until_{};
    bool out_of_step_ = false;
    bool answered_in_barrier_ = false;
    bool look_due_ = false;  ///< the barrier was refused: a poll tells whether something is being processed
    CheckForm form_ = CheckForm::text;
    bool form_proved_ = false;
    std::uint8_t check_refusals_ = 0;
    std::array<std::uint8_t, 66> misfits_{};  ///< by command: answers in a row whose type was not the table's
    std::optional<CheckForm> reply_form_;     ///< what acknowledgements carry, once a sum other than 0 has shown it
    std::uint8_t zero_checks_ = 0;            ///< acknowledgements in a row with 0 in place of that sum
    Instant next_protocol_notice_{};
    std::vector<std::uint8_t> raw_reply_;
};

}  // namespace axisgate::pacontrol
