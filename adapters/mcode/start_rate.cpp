// Start: the drive's bit rate: BD acts at the next restart only, so what will go wrong is said while the drive can still be heard.
// In: BD as the drive has it, the line's rate. Out: texts that say what will happen and what to do.
// Never sets a rate: that is for line.setup.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

namespace {
constexpr std::array<std::pair<int, std::uint32_t>, 5> rates{{{48, 4800}, {96, 9600}, {19, 19200}, {38, 38400}, {11, 115200}}};
}  // namespace

std::uint32_t rate_of(int code) noexcept {
    const auto it = std::ranges::find(rates, code, &std::pair<int, std::uint32_t>::first);
    return it == rates.end() ? 0 : it->second;
}
int code_of(std::uint32_t rate) noexcept {
    const auto it = std::ranges::find(rates, rate, &std::pair<int, std::uint32_t>::second);
    return it == rates.end() ? 0 : it->first;
}

void Start::rate_set() noexcept { bd_ = drive_.bus.rate_code; }

std::string Start::rate_trouble() const {
    const int wanted = drive_.bus.rate_code;
    if (wanted == 0 || bd_ == 0 || bd_ == wanted) return {};
    return fmt::format(
        "{}: BD={}: from its next reset or power-up on it speaks at {} bit/s and is not heard on this line, which runs at {}: "
        "line.setup with save sets BD={}; or give the line baud={} when it has restarted",
        name(), bd_, rate_of(bd_), rate_of(wanted), wanted, rate_of(bd_));
}

std::string Start::factory_hint() const {
    const int wanted = drive_.bus.rate_code;
    if (!at_factory_rate_ || wanted == 0 || wanted == 96) return {};
    return fmt::format(
        "; since FD it may speak at the factory's 9600 bit/s, and this line runs at {}: give the line baud=9600, set BD={} there, "
        "program.save, reset, and then give the line its rate again",
        rate_of(wanted), wanted);
}

}  // namespace axisgate::mcode
