// An answer fits a request with the same address, axis and item; the answer to a write must also have the same value.
#include "adapters/example/drive.hpp"

#include <algorithm>
#include <cstdio>

#include "gateway/core/text.hpp"

namespace axisgate::example {
using Kind = Telegram::Kind;

Frame Drive::frame_of(const Telegram& request) const { return Frame::run(drive::bytes_of(text_of(request, true))); }

bool Drive::answers(const Telegram& request, const Telegram& answer) const {
    return request.kind == Kind::read || request.text == answer.text;
}

drive::Reported Drive::reported(const Telegram& answer) const {
    const bool refused = answer.kind == Kind::refused;
    return {refused, refused ? std::atoi(answer.text.c_str()) : 0, answer.text};
}

std::string Drive::title(const Telegram* answer) const { return "example drive, model " + (answer ? answer->text : "not read"); }

Telegram Drive::read(int channel, std::string item) const { return {address_, channel, std::move(item), Kind::read, {}}; }

Telegram Drive::write(int channel, std::string item, std::int64_t value) const {
    return {address_, channel, std::move(item), Kind::value, std::to_string(value)};
}

/// R06 speed, R07 acceleration, R08 deceleration, R09 deceleration of a quick stop, from any read or write. A value that was not
/// acknowledged as it was sent is not used.
bool Drive::learn_rate(const Telegram& answer) {
    if (answer.kind != Kind::value || answer.axis < 1 || answer.axis > channels) return false;
    DriveRates& rates = axis(answer.axis).rates;
    std::int64_t* const rate = answer.item == "R06"   ? &rates.velocity
                               : answer.item == "R07" ? &rates.acceleration
                               : answer.item == "R08" ? &rates.deceleration
                               : answer.item == "R09" ? &rates.quick_stop
                                                      : nullptr;
    if (rate) *rate = std::max<std::int64_t>(parse_whole(answer.text, 0, INT64_MAX).value_or(0), 0);
    return rate != nullptr;
}

/// S00: "bits,position,velocity,demand,fault". Bits: 0 on, 1 in motion, 2 target reached, 3 referenced.
int Drive::learn(const Telegram& answer) {
    unsigned bits = 0, fault = 0;
    long long position = 0, velocity = 0, demand = 0;
    if (learn_rate(answer)) return answer.axis;
    if (answer.item != "S00" || std::sscanf(answer.text.c_str(), "%u,%lld,%lld,%lld,%u", &bits, &position, &velocity, &demand, &fault) != 5)
        return 0;
    AxisFeedback& fb = axis(answer.axis);
    fb.power = bits & 1 ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb.moving = bits & 2;
    fb.target_reached = bits & 4;
    fb.referenced = bits & 8;
    fb.homing_attained = fb.homing_attained && fb.referenced;
    fb.fault = fault != 0;
    fb.error_code = static_cast<std::uint16_t>(fault);
    fb.native_status = bits;
    fb.position = position;
    fb.velocity = velocity;
    fb.position_demand = demand;
    fb.demand_source = bits & 1 ? DemandSource::drive : DemandSource::none;
    return answer.axis;
}

}  // namespace axisgate::example
