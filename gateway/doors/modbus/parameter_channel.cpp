// Parameter channel: see the header. Checks against the catalogue happen here, before anything goes to the line.
#include "gateway/doors/modbus/parameter_channel.hpp"

#include <limits>

#include "gateway/doors/modbus/register_map.hpp"

namespace axisgate::modbus {
namespace {
constexpr std::uint16_t request_none = 0, request_read = 1, request_write = 2;

Point point_of(std::uint32_t selector) noexcept {
    return {static_cast<std::uint16_t>(selector), static_cast<std::uint16_t>(selector >> 16)};
}
bool is_text(ValueType type) noexcept { return type == ValueType::text || type == ValueType::bytes; }
}  // namespace

ParameterChannel::Outcome ParameterChannel::write(const Write& write, const Catalogue* catalogue) {
    if (state_ == State::busy) return {Exception::busy, {}};
    if (write.request && *write.request > request_write) return {Exception::illegal_value, {}};
    if (write.selector) selector_ = *write.selector;
    if (write.value) value_ = *write.value;
    if (!write.request) return {};

    request_ = *write.request;
    error_ = 0;
    state_ = State::idle;
    if (request_ == request_none) return {};

    const Point point = point_of(selector_);
    const Parameter* parameter = catalogue ? catalogue->parameter(point) : nullptr;
    if (!catalogue) {
        refuse(Reason::line_down);
    } else if (!parameter) {
        refuse(Reason::unknown_point);
    } else if (is_text(parameter->type)) {
        refuse(Reason::not_supported);
    } else if (request_ == request_read) {
        if (parameter->readable()) {
            state_ = State::busy;
            return {Exception::none, ReadParameter{point}};
        }
        refuse(Reason::not_supported);
    } else if (!parameter->writable()) {
        refuse(Reason::not_writable);
    } else {
        const Value wanted{parameter->type == ValueType::u32 ? std::int64_t{value_} : std::int64_t{static_cast<std::int32_t>(value_)}};
        auto checked = catalogue->check_write(point, wanted);
        if (checked.fault.empty()) {
            state_ = State::busy;
            return {Exception::none, WriteParameter{point, std::move(checked.value)}};
        }
        refuse(Reason::out_of_range);
    }
    return {};
}

void ParameterChannel::finish(const Result& result, const Catalogue* catalogue) {
    if (state_ != State::busy) return;
    if (!good(result)) {
        refuse(result.reason == Reason::none ? Reason::internal : result.reason, result.code);
        return;
    }
    const Parameter* parameter = catalogue ? catalogue->parameter(point_of(selector_)) : nullptr;
    const bool shown = parameter && take(result.value, parameter->type);
    // A read value that does not fit is refused: nothing true could be shown. A write has happened, whatever came back with it: then
    // the value register keeps what was written.
    if (!shown && request_ == request_read) {
        refuse(Reason::out_of_range);
        return;
    }
    state_ = State::done;
}

void ParameterChannel::refuse(Reason reason, std::int32_t code) noexcept {
    state_ = State::refused;
    // A drive's code of 0x10000 or more would show as 0 in its low half if that is 0; then the reason says more.
    const auto own = static_cast<std::uint16_t>(code);
    error_ = own != 0 ? own : static_cast<std::uint16_t>(reason);
}

bool ParameterChannel::take(const Value& value, ValueType type) noexcept {
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

}  // namespace axisgate::modbus
