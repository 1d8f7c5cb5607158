// Wire: building, cutting and reading frames.
// In: requests, bytes one after the other. Out: frames; what was cut out of the stream, with its fault if it has one.
// Never guesses a missing field: all of them must be there [L1123].
#include "adapters/pacontrol/wire.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>

#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
template <std::size_t N>
bool split(std::string_view text, std::array<std::string_view, N>& fields) {
    for (std::size_t i = 0; i < N; ++i) {
        const auto at = text.find(';');
        if ((at == std::string_view::npos) != (i == N - 1)) return false;
        fields[i] = text.substr(0, at);
        if (fields[i].empty()) return false;
        if (at != std::string_view::npos) text.remove_prefix(at + 1);
    }
    return true;
}

template <class T>
bool number(std::string_view text, T& value, int base = 10) {
    const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    return ec == std::errc{} && p == text.data() + text.size();
}

bool flag(std::string_view text, bool& value) {
    value = text == "1";
    return value || text == "0";
}
}  // namespace

std::string text_of(const Request& r) { return fmt::format("{:04X};{};{};{}", r.code, r.parameter, r.real ? 1 : 0, r.data); }

std::string text_of(const Reply& r) {
    return fmt::format("{};{};{};{};{};{}", r.quit, r.end ? 1 : 0, r.status, r.error, r.real ? 1 : 0, r.data);
}

std::string_view name_of(CheckForm form) noexcept {
    return form == CheckForm::text ? "text" : form == CheckForm::with_etx ? "text and ETX" : "0, not used";
}

std::optional<CheckMode> check_mode_named(std::string_view name) noexcept {
    if (name == "compute") return CheckMode::compute;
    if (name == "zero") return CheckMode::zero;
    if (name == "learn") return CheckMode::learn;
    return std::nullopt;
}

std::uint8_t check_of(std::string_view text, CheckForm form) noexcept {
    if (form == CheckForm::zero) return 0;
    std::uint8_t sum = form == CheckForm::with_etx ? 3 : 0;
    for (const char c : text)
        sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
    return sum;
}

std::optional<CheckForm> form_of_check(std::string_view text, std::string_view digits, CheckForm expected) noexcept {
    unsigned v = 0;
    const auto [p, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), v);
    if (digits.empty() || digits.size() > 3 || ec != std::errc{} || p != digits.data() + digits.size() || v > 255) return std::nullopt;
    if (v == check_of(text, expected)) return expected;
    for (const CheckForm f : {CheckForm::text, CheckForm::with_etx, CheckForm::zero}) {
        if (v == check_of(text, f)) return f;
    }
    return std::nullopt;
}

std::vector<std::uint8_t> framed(std::string_view text, CheckForm form) {
    std::vector<std::uint8_t> b;
    b.reserve(text.size() + 7);
    b.insert(b.end(), {SOH, STX});
    b.insert(b.end(), text.begin(), text.end());
    b.push_back(ETX);
    for (const char c : std::to_string(check_of(text, form)))
        b.push_back(static_cast<std::uint8_t>(c));
    b.push_back(EOT);
    return b;
}

std::optional<Request> request_of(std::string_view text, std::string& fault) {
    std::array<std::string_view, 4> f;
    Request r;
    if (!split(text, f)) {
        fault = "a command has four fields: CMD;PAR_1;TYP_PAR_2;PAR_2";
    } else if (f[0].size() != 4 || !number(f[0], r.code, 16)) {
        fault = fmt::format("CMD {} is not four hex digits", f[0]);
    } else if (!number(f[1], r.parameter)) {
        fault = fmt::format("PAR_1 {} is not a decimal number", f[1]);
    } else if (!flag(f[2], r.real)) {
        fault = fmt::format("TYP_PAR_2 {} is neither 0 (integer) nor 1 (real)", f[2]);
    } else if (f[3].size() > 48 || !real_of(f[3])) {
        fault = fmt::format("PAR_2 {} is not a decimal number", f[3]);
    } else {
        r.data = f[3];
        return r;
    }
    return std::nullopt;
}

std::optional<Reply> reply_of(std::string_view text, std::string& fault) {
    std::array<std::string_view, 6> f;
    Reply r;
    if (!split(text, f)) {
        fault = "an acknowledgement has six fields: QUIT;BE;STATUS;ERROR;TYP_QUIT;Q_PAR";
    } else if (!number(f[0], r.quit)) {
        fault = fmt::format("QUIT {} is not a decimal number", f[0]);
    } else if (!flag(f[1], r.end)) {
        fault = fmt::format("BE {} is neither 0 nor 1", f[1]);
    } else if (!number(f[2], r.status)) {
        fault = fmt::format("STATUS {} is not 0..255", f[2]);
    } else if (!number(f[3], r.error)) {
        fault = fmt::format("ERROR {} is not 0..65535", f[3]);
    } else if (!flag(f[4], r.real)) {
        fault = fmt::format("TYP_QUIT {} is neither 0 (integer) nor 1 (real)", f[4]);
    } else if (f[5].size() > 48 || !real_of(f[5])) {
        fault = fmt::format("Q_PAR {} is not a decimal number", f[5]);
    } else {
        r.data = f[5];
        return r;
    }
    return std::nullopt;
}

std::optional<double> number_of(const Reply& r) noexcept { return real_of(r.data); }

std::string_view name_of(FrameFault fault) noexcept {
    constexpr std::array<std::string_view, 8> names{"bytes outside a frame",
                                                    "a frame inside a frame: SOH before EOT",
                                                    "SOH without STX",
                                                    "EOT before ETX",
                                                    "no EOT after the check digits",
                                                    "a byte with 8 bits on a line of 7: format=7N1 is what the control has when new",
                                                    "a control symbol inside the text",
                                                    "a text that does not end"};
    return names[static_cast<std::size_t>(fault)];
}

void Framer::reset() noexcept {
    state_ = State::outside;
    text_.clear();
    check_.clear();
    raw_.clear();
}

void Framer::drop(FrameFault fault, const Sink& sink) {
    const std::vector<std::uint8_t> dropped(raw_);
    reset();
    if (sink.fault) sink.fault(fault, dropped);
}

void Framer::push(std::span<const std::uint8_t> bytes, const Sink& sink) {
    for (const std::uint8_t b : bytes)
        take(b, sink);
}

void Framer::take(std::uint8_t b, const Sink& sink) {
    if (b == SOH) {
        if (state_ != State::outside) drop(state_ == State::check ? FrameFault::no_eot : FrameFault::restarted, sink);
        raw_.push_back(b);
        state_ = State::begun;
        return;
    }
    if (state_ == State::outside && b == EOT) {
        if (sink.poll) sink.poll();
        return;
    }
    raw_.push_back(b);
    if (b > 0x7F) return drop(FrameFault::eight_bits, sink);
    switch (state_) {
        case State::outside:
            return drop(FrameFault::stray, sink);
        case State::begun:
            if (b != STX) return drop(FrameFault::no_stx, sink);
            state_ = State::text;
            return;
        case State::text:
            if (b == ETX) {
                state_ = State::check;
                return;
            }
            if (b == EOT) return drop(FrameFault::no_etx, sink);
            if (b < 0x20) return drop(FrameFault::not_text, sink);
            if (text_.size() >= text_limit) return drop(FrameFault::too_long, sink);
            text_.push_back(static_cast<char>(b));
            return;
        case State::check:
            if (b == EOT) {
                const std::string text = std::move(text_), check = std::move(check_);
                reset();
                if (sink.frame) sink.frame(text, check);
                return;
            }
            if (b < '0' || b > '9' || check_.size() >= 3) return drop(FrameFault::no_eot, sink);
            check_.push_back(static_cast<char>(b));
            return;
    }
}

}  // namespace axisgate::pacontrol
