// Checks requests against the catalogue before anything is sent to the line. A value of type single stands for its shortest decimal number.
// A read value that does not fit the value register is refused and never shown.
#include "gateway/registers/parameter_channel.hpp"

#include <fmt/core.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "gateway/registers/register_map.hpp"

namespace axisgate::registers {
namespace {
constexpr std::uint16_t request_none = 0, request_read = 1, request_write = 2;

constexpr std::uint32_t float_form = 1u << 31;

Point point_of(std::uint32_t selector) noexcept {
    return {static_cast<std::uint16_t>(selector), static_cast<std::uint16_t>((selector & ~float_form) >> 16)};
}
bool is_text(ValueType type) noexcept { return type == ValueType::text || type == ValueType::bytes; }

/// The decimal number that people would write for a single: 0.1, not 0.10000000149011612.
double shortest(float single) noexcept {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, single);
    double d = static_cast<double>(single);
    if (error == std::errc()) (void)std::from_chars(text, end, d);
    return d;
}
}  // namespace

ParameterChannel::Outcome ParameterChannel::write(const Write& write, const Catalogue* catalogue) {
    if (state_ == State::busy) {
        why_ = "the parameter channel is busy: write again when register 51 of the axis is no longer 1";
        return {Verdict::busy, {}};
    }
    if (write.request && *write.request > request_write) {
        why_ = fmt::format("the parameter channel has no request {}: 1 reads, 2 writes, 0 goes back to idle", *write.request);
        return {Verdict::bad_value, {}};
    }
    if (write.selector) selector_ = *write.selector;
    if (write.value) value_ = *write.value;
    if (!write.request) return {};

    request_ = *write.request;
    error_ = 0;
    state_ = State::idle;
    reason_ = Reason::none;
    parameter_.clear();
    wanted_.clear();
    if (request_ == request_none) return {};

    const Point point = point_of(selector_);
    const Parameter* parameter = catalogue ? catalogue->parameter(point) : nullptr;
    if (parameter) parameter_ = catalogue->id_of(point);
    if (!catalogue) {
        refuse(Reason::line_down, "the axis has no drive family: it is not configured");
    } else if (!parameter) {
        refuse(Reason::unknown_point,
               fmt::format("{} has no parameter {} with the element {}: the selector is in the list of its parameters", catalogue->family(),
                           point.parameter, point.element));
    } else if (is_text(parameter->type)) {
        refuse(Reason::not_supported, fmt::format("{} is a text, which the parameter channel does not carry", parameter_));
    } else if (request_ == request_read) {
        if (parameter->readable()) {
            state_ = State::busy;
            return {Verdict::good, ReadParameter{point}};
        }
        refuse(Reason::not_supported, fmt::format("{} can only be written", parameter_));
    } else {
        const Value value = given(parameter->type);
        wanted_ = to_text(value);
        if (!parameter->writable()) {
            refuse(Reason::not_writable, fmt::format("{} can only be read", parameter_));
            return {};
        }
        auto checked = catalogue->check_write(point, value);
        if (checked.fault.empty()) {
            state_ = State::busy;
            return {Verdict::good, WriteParameter{point, std::move(checked.value)}};
        }
        refuse(Reason::out_of_range, std::move(checked.fault));
    }
    return {};
}

void ParameterChannel::finish(const Result& result, const Catalogue* catalogue) {
    if (state_ != State::busy) return;
    if (!good(result)) {
        const Reason reason = result.reason == Reason::none ? Reason::internal : result.reason;
        refuse(reason, result.text.empty() ? fmt::format("{}: {}", parameter_, name_of(reason)) : result.text, result.code);
        return;
    }
    const Parameter* parameter = catalogue ? catalogue->parameter(point_of(selector_)) : nullptr;
    const bool shown = parameter && take(result.value, parameter->type);
    // A read value that does not fit is refused, because nothing correct could be shown. A write has taken place whatever its answer
    // contains: the value register then keeps the written value.
    if (!shown && request_ == request_read) {
        refuse(Reason::out_of_range,
               (selector_ & float_form) != 0
                   ? fmt::format("{} is {}, which no single can show", parameter_, to_text(result.value))
                   : fmt::format("{} is {}, which is no whole number of 32 bits: read it in the float form (bit 31 of the selector)",
                                 parameter_, to_text(result.value)));
        return;
    }
    state_ = State::done;
}

void ParameterChannel::refuse(Reason reason, std::string why, std::int32_t code) {
    state_ = State::refused;
    reason_ = reason;
    why_ = std::move(why);
    // If the low half of a drive's code of 0x10000 or more is 0, it would look like no error; the number of the reason is shown instead.
    const auto own = static_cast<std::uint16_t>(code);
    error_ = own != 0 ? own : static_cast<std::uint16_t>(reason);
}

/// The value in the value register. NaN and infinity stay what they are: the catalogue refuses them by name.
Value ParameterChannel::given(ValueType type) const noexcept {
    if ((selector_ & float_form) == 0)
        return type == ValueType::u32 ? std::int64_t{value_} : std::int64_t{static_cast<std::int32_t>(value_)};
    const float single = std::bit_cast<float>(value_);
    return std::isfinite(single) ? shortest(single) : static_cast<double>(single);
}

bool ParameterChannel::take(const Value& value, ValueType type) noexcept {
    if ((selector_ & float_form) != 0) {
        const auto d = as_number(value);
        if (!d || !(std::fabs(*d) <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
        value_ = std::bit_cast<std::uint32_t>(static_cast<float>(*d));
        return true;
    }
    const auto i = as_integer(value);
    if (!i) return false;
    const std::int64_t low = type == ValueType::u32 ? 0 : std::numeric_limits<std::int32_t>::min();
    const std::int64_t high =
        type == ValueType::u32 ? std::numeric_limits<std::uint32_t>::max() : std::int64_t{std::numeric_limits<std::int32_t>::max()};
    if (*i < low || *i > high) return false;
    value_ = static_cast<std::uint32_t>(*i);
    return true;
}

void ParameterChannel::render(WordOrder order, std::uint8_t* block) const noexcept {
    put32(block + 2 * reg::channel_selector, selector_, order);
    put16(block + 2 * reg::channel_request, request_);
    put16(block + 2 * reg::channel_state, static_cast<std::uint16_t>(state_));
    put32(block + 2 * reg::channel_value, value_, order);
    put16(block + 2 * reg::channel_error, error_);
}

}  // namespace axisgate::registers
