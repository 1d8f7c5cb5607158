// Wire: the frames of the serial port: SOH STX text ETX check EOT, and the poll, which is a lone EOT [L1123-L1205].
// In: requests; bytes as they come. Out: bytes; messages found among them, what their check digits prove, what was wrong with the rest.
// Never knows what a command means, and never holds more than one frame.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::pacontrol {

inline constexpr std::uint8_t SOH = 0x01, STX = 0x02, ETX = 0x03, EOT = 0x04;  // [L1126-L1127]; [L1043] swaps the first two

/// CMD ; PAR_1 ; TYP_PAR_2 ; PAR_2
struct Request {
    std::uint16_t code = 0;       ///< four hex digits, upper case; all other fields are decimal
    std::uint32_t parameter = 0;  ///< element, axis, or axis << 8 | number
    bool real = false;            ///< type of the data: 0 integer, 1 real
    std::string data = "0";       ///< decimal text, at most 48 characters; unused: 0 [L1123]
    bool operator==(const Request&) const = default;
};

/// QUIT ; BE ; STATUS ; ERROR ; TYP_QUIT ; Q_PAR
struct Reply {
    std::uint16_t quit = 0;   ///< command error number, 0: none
    bool end = true;          ///< end of processing
    std::uint8_t status = 0;  ///< operating status
    std::uint16_t error = 0;  ///< PA-CONTROL (system) error number, 0: none
    bool real = false;        ///< type of the data
    std::string data = "0";
    bool operator==(const Reply&) const = default;
};

/// "XOR sum of the digits" [L1047]. The manual gives no formula; its printed frames prove two, which differ by the ETX (03h) [L1220-L1495].
enum class CheckForm : std::uint8_t {
    text,      ///< XOR of the bytes strictly between STX and ETX: what requests carry
    with_etx,  ///< the same and ETX: what acknowledgements carry
    zero       ///< `0`: not used; legal in both directions [L1047]
};
[[nodiscard]] std::string_view name_of(CheckForm form) noexcept;

/// Option `check` of the line.
enum class CheckMode : std::uint8_t {
    compute,  ///< requests carry the computed digits
    zero,     ///< requests carry `0`
    learn     ///< computed, until the control answers "check wrong" (10h) to it: then the other form, then `0`
};
[[nodiscard]] std::optional<CheckMode> check_mode_named(std::string_view name) noexcept;

[[nodiscard]] std::uint8_t check_of(std::string_view text, CheckForm form) noexcept;

/// Which form received digits have. A sum that is 0 by itself counts as computed. Nothing: they fit no form, or are no number 0..255.
/// `expected` is looked at first.
[[nodiscard]] std::optional<CheckForm> form_of_check(std::string_view text, std::string_view digits, CheckForm expected) noexcept;

[[nodiscard]] std::string text_of(const Request& request);
[[nodiscard]] std::string text_of(const Reply& reply);
/// The text with its control symbols and check digits.
[[nodiscard]] std::vector<std::uint8_t> framed(std::string_view text, CheckForm form);

/// Reads the text of a frame; nothing, and `fault` in words, if it is not one.
[[nodiscard]] std::optional<Request> request_of(std::string_view text, std::string& fault);
[[nodiscard]] std::optional<Reply> reply_of(std::string_view text, std::string& fault);
/// The number that an acknowledgement carries, whichever its type.
[[nodiscard]] std::optional<double> number_of(const Reply& reply) noexcept;

/// What is not a frame.
enum class FrameFault : std::uint8_t {
    stray,       ///< bytes outside a frame
    restarted,   ///< SOH inside a frame: the begun one is dropped, a new one begins
    no_stx,      ///< SOH is not followed by STX
    no_etx,      ///< EOT came before ETX
    no_eot,      ///< after ETX and 3 digits, or something that is no digit, no EOT
    eight_bits,  ///< a byte above 7Fh: the line has 8 data bits where the other side sends 7, or noise
    not_text,    ///< a byte below 20h inside the text
    too_long     ///< more than 120 characters of text
};
[[nodiscard]] std::string_view name_of(FrameFault fault) noexcept;

/// Finds frames in a byte stream. SOH always begins anew, so that a frame inside a frame is found.
class Framer {
public:
    static constexpr std::size_t text_limit = 120;

    struct Sink {
        std::function<void(std::string_view text, std::string_view check)> frame;
        std::function<void()> poll;                                                        ///< an EOT outside a frame
        std::function<void(FrameFault fault, std::span<const std::uint8_t> bytes)> fault;  ///< and the bytes that were dropped with it
    };
    void push(std::span<const std::uint8_t> bytes, const Sink& sink);
    /// Bytes of a frame that has begun and not ended.
    [[nodiscard]] std::span<const std::uint8_t> pending() const noexcept { return raw_; }
    void reset() noexcept;

private:
    enum class State : std::uint8_t { outside, begun, text, check };
    void take(std::uint8_t b, const Sink& sink);
    void drop(FrameFault fault, const Sink& sink);

    State state_ = State::outside;
    std::string text_, check_;
    std::vector<std::uint8_t> raw_;
};

}  // namespace axisgate::pacontrol
