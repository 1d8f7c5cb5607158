// Frames of the serial port COM1, the twin's side: bytes to requests and polls, acknowledgements to bytes.
// In: bytes with their instants. Out: what was heard: a poll, a request, or a command error of the frame itself (16..19).
// Never keeps more than one frame; never includes the adapter's wire code.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/pacontrol/twin/value.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::pacontrol::twin {

/// Command error numbers of the frame [L4027-4031].
inline constexpr std::uint16_t quit_check = 0x10;
inline constexpr std::uint16_t quit_sequence = 0x11;
inline constexpr std::uint16_t quit_beginning = 0x12;
inline constexpr std::uint16_t quit_unknown = 0x13;

struct Received {
    enum class Kind : std::uint8_t { poll, request, fault };
    Kind kind = Kind::poll;
    std::uint16_t quit = 0;      ///< fault
    std::uint16_t code = 0;      ///< request: four hex digits [L1125]
    std::int64_t parameter = 0;  ///< request: decimal (E-03)
    Datum data;                  ///< request
};

/// Check of a request: XOR of the text; that or the same with ETX (3) in it; only the latter (E-04). 0 is always admitted [L1047].
enum class RequestCheck : std::uint8_t { text, either, with_etx };

struct FrameRules {
    RequestCheck check = RequestCheck::text;
    Duration silence = std::chrono::seconds(1);  ///< between two bytes of a request; a longer one forgets it
};

/// `SOH STX text ETX check EOT` [L1125-1155]. SOH begins a new frame wherever it comes (E-17); an EOT outside a frame is a poll
/// [L1193]. Silence inside a frame forgets it (E-17). A text over 64 characters is a wrong sequence.
class FrameReader {
public:
    static constexpr std::size_t text_limit = 64;

    explicit FrameReader(const FrameRules& rules = {}) : rules_(rules) {}
    [[nodiscard]] std::optional<Received> feed(std::uint8_t byte, Instant at);
    void reset() noexcept;
    /// When the silence is over that forgets what was begun; `never`.
    [[nodiscard]] Instant forgets() const noexcept { return state_ == State::idle ? never : last_ + rules_.silence; }

private:
    enum class State : std::uint8_t { idle, begun, text, check, headless };
    [[nodiscard]] Received finish() const;
    void begin() noexcept;

    FrameRules rules_;
    State state_ = State::idle;
    bool disorder_ = false;  // control symbols out of order, or a byte that is none of 7 bits
    std::string text_;
    std::string check_;
    Instant last_{};
};

/// XOR of the bytes of the text: the request's check; with ETX (3) in it, the reply's (recovered from the printed frames).
[[nodiscard]] std::uint8_t xor_of(std::string_view text) noexcept;

/// Check of an acknowledgement: the nine printed frames' rule, the tenth's (E-05), or switched off [L1047].
enum class ReplyCheck : std::uint8_t { with_etx, text, zero };

/// `QUIT ; BE ; STATUS ; ERROR ; TYP_QUIT ; Q_PAR` framed [L1161-1203].
[[nodiscard]] std::vector<std::uint8_t> acknowledgement(std::uint16_t quit, bool end, std::uint8_t status, std::uint16_t error,
                                                        const Datum& data, ReplyCheck check, RealForm reals = RealForm::seven_digits);

}  // namespace axisgate::pacontrol::twin
