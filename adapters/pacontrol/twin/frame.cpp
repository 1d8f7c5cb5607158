// Bytes to requests, acknowledgements to bytes.
// In: bytes. Out: requests, polls, faults; bytes. Never blocks on half a frame: the next SOH or silence ends it.
#include "adapters/pacontrol/twin/frame.hpp"

#include <array>
#include <charconv>

namespace axisgate::pacontrol::twin {
namespace {

constexpr std::uint8_t soh = 1;
constexpr std::uint8_t stx = 2;
constexpr std::uint8_t etx = 3;
constexpr std::uint8_t eot = 4;

std::optional<std::int64_t> decimal(std::string_view text, int base = 10) {
    std::int64_t n = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), n, base);
    if (fault != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return n;
}

Received fault(std::uint16_t quit) {
    Received h;
    h.kind = Received::Kind::fault;
    h.quit = quit;
    return h;
}

}  // namespace

std::uint8_t xor_of(std::string_view text) noexcept {
    std::uint8_t x = 0;
    for (const char c : text)
        x = static_cast<std::uint8_t>(x ^ static_cast<std::uint8_t>(c));
    return x;
}

void FrameReader::reset() noexcept {
    state_ = State::idle;
    disorder_ = false;
    text_.clear();
    check_.clear();
}

void FrameReader::begin() noexcept {
    reset();
    state_ = State::begun;
}

std::optional<Received> FrameReader::feed(std::uint8_t byte, Instant at) {
    if (state_ != State::idle && at - last_ > rules_.silence) reset();
    last_ = at;
    if (byte == soh) {
        begin();
        return std::nullopt;
    }
    if (byte == eot) {
        const State state = state_;
        std::optional<Received> received;
        if (state == State::idle) {
            received = Received{};
        } else if (state == State::begun || state == State::headless) {
            received = fault(quit_beginning);
        } else if (state == State::text) {
            received = fault(quit_sequence);  // no ETX
        } else {
            received = finish();
        }
        reset();
        return received;
    }
    switch (state_) {
        case State::idle:
            state_ = State::headless;
            break;
        case State::begun:
            state_ = byte == stx ? State::text : State::headless;
            break;
        case State::text:
            if (byte == etx) {
                state_ = State::check;
            } else if (byte < 0x20 || byte > 0x7F || text_.size() == text_limit) {
                disorder_ = true;
            } else {
                text_.push_back(static_cast<char>(byte));
            }
            break;
        case State::check:
            if (byte < 0x20 || byte > 0x7F) {
                disorder_ = true;
            } else if (check_.size() < 4) {
                check_.push_back(static_cast<char>(byte));
            }
            break;
        case State::headless:
            break;
    }
    return std::nullopt;
}

Received FrameReader::finish() const {
    if (disorder_) return fault(quit_sequence);
    const auto check = check_.size() <= 3 && !check_.starts_with('-') ? decimal(check_) : std::nullopt;
    const std::uint8_t right = xor_of(text_);
    // 0 switches the check off [L1047].
    const bool plain = rules_.check != RequestCheck::with_etx, etx_in = rules_.check != RequestCheck::text;
    const bool fits = check && ((plain && *check == right) || (etx_in && *check == (right ^ 3)));
    if (!check || (*check != 0 && !fits)) return fault(quit_check);

    std::array<std::string_view, 4> field;
    std::string_view rest = text_;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const auto end = rest.find(';');
        if ((end == std::string_view::npos) != (i == 3)) return fault(quit_sequence);
        field[i] = rest.substr(0, end);
        if (i < 3) rest.remove_prefix(end + 1);
    }
    Received h;
    h.kind = Received::Kind::request;
    const auto code = field[0].size() == 4 && field[0].front() != '-' ? decimal(field[0], 16) : std::nullopt;
    if (!code) return fault(quit_unknown);
    const auto parameter = decimal(field[1]);
    if (!parameter || (field[2] != "0" && field[2] != "1")) return fault(quit_sequence);
    const auto data = from_wire(field[3], field[2] == "1");
    if (!data) return fault(quit_sequence);
    h.code = static_cast<std::uint16_t>(*code);
    h.parameter = *parameter;
    h.data = *data;
    return h;
}

std::vector<std::uint8_t> acknowledgement(std::uint16_t quit, bool end, std::uint8_t status, std::uint16_t error, const Datum& data,
                                          ReplyCheck check, RealForm reals) {
    const std::string text = std::to_string(quit) + (end ? ";1;" : ";0;") + std::to_string(status) + ";" + std::to_string(error) +
                             (data.real ? ";1;" : ";0;") + to_wire(data, reals);
    const int sum = check == ReplyCheck::zero ? 0 : check == ReplyCheck::text ? xor_of(text) : xor_of(text) ^ 3;
    std::vector<std::uint8_t> bytes{soh, stx};
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(etx);
    const std::string digits = std::to_string(sum);
    bytes.insert(bytes.end(), digits.begin(), digits.end());
    bytes.push_back(eot);
    return bytes;
}

}  // namespace axisgate::pacontrol::twin
