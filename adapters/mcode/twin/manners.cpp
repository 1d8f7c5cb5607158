#include "adapters/mcode/twin/manners.hpp"

#include <string_view>

namespace axisgate::mcode::twin {

Manners manners_of(const FreedomValues& values) {
    const auto number = [&](std::string_view name, int fallback = 0) { return static_cast<int>(freedom(values, name, fallback)); };
    const auto chosen = [&](std::string_view name) { return freedom(values, name) != 0; };
    const auto ms = [&](std::string_view name, int fallback = 0) -> Duration {
        return std::chrono::milliseconds(freedom(values, name, fallback));
    };
    Manners m;
    m.delivered_em = number("delivered_em");
    m.delivered_ck = number("delivered_ck");
    m.echo_whole = chosen("echo_whole");
    m.echo_name = chosen("echo_name");
    m.answer_order = static_cast<Manners::Order>(number("answer_order"));
    m.number_form = number("number_form");
    m.version = number("firmware", m.version);
    m.version_alone = chosen("version_alone");
    m.lists = !chosen("lists_missing");
    m.sign_on = chosen("sign_on");
    m.memory_deaf = chosen("memory_deaf");
    m.chatter_ms = number("chatter_ms");
    m.prompt_late = ms("prompt_late_ms");
    m.party_gap = ms("party_gap_ms");
    m.listing_pause = ms("listing_pause_ms");
    m.error_late = ms("error_late_ms");
    m.memory = ms("memory_ms");
    m.store = ms("store_ms");
    m.turnaround = ms("turnaround_ms");
    m.escape = ms("escape_ms");
    m.execution = ms("execution_ms", 1);
    return m;
}

MotorManners motor_manners_of(const FreedomValues& values, std::uint64_t seed) {
    MotorManners m;
    m.shaft = shaft_freedoms(values);
    m.seed = seed;
    m.switch_hysteresis = freedom(values, "switch_hysteresis_increments");
    m.counter_start = freedom(values, "counter_start");
    m.encoder_start = freedom(values, "encoder_start");
    m.encoder_lines = static_cast<int>(freedom(values, "encoder_lines", m.encoder_lines));
    m.moving_late = std::chrono::milliseconds(freedom(values, "moving_late_ms"));
    m.moving_ends_with_steps = freedom(values, "moving_ends_with_steps") != 0;
    return m;
}

}  // namespace axisgate::mcode::twin
