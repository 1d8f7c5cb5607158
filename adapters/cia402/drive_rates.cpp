// CiA 402-2: 605Ah 1 and 5 brake with 6084h, 2 and 6 with 6085h; without 605Ah a quick stop uses 6085h.
#include "adapters/cia402/drive_rates.hpp"

#include <algorithm>

#include "adapters/cia402/drive_axis.hpp"

namespace axisgate::cia402_drive {

void Rates::ask(drive::Turn& t) {
    if (!drive_.known.profile) return;
    told_ = {};
    at_ = 0;
    drive_.feedback.tell_rates(t);
}

void Rates::answered(const canopen::SdoEnd& end, drive::Turn& t) {
    if (!wants()) return;
    const Address a = objects[at_++];
    take(a, end.done() ? std::optional(a == object::quick_stop_option ? signed_of(end.data)
                                                                      : static_cast<std::int64_t>(canopen::low_first(end.data)))
                       : std::nullopt);
    if (!wants()) drive_.feedback.tell_rates(t);
}

void Rates::take(Address address, std::optional<std::int64_t> value) noexcept {
    const auto it = std::ranges::find(objects, address);
    if (it != objects.end()) told_[static_cast<std::size_t>(it - objects.begin())] = value;
}

void Rates::written(Address address, std::int64_t value, bool by_order, drive::Turn& t) {
    if (!hang_on(address)) return;
    if (!by_order) return ask(t);
    take(address, value);
}

bool Rates::hang_on(Address a) noexcept {
    const auto in = [&](std::uint16_t from, std::uint16_t through) { return a.index >= from && a.index <= through; };
    return in(0x2000, 0x5FFF) || in(0x6080, 0x6097) || in(0x60A3, 0x60A4) || in(0x60C5, 0x60C6) || a.index == 0x605A || a.index == 0x607F ||
           a.index == 0x1011;
}

DriveRates Rates::in_force() const noexcept {
    const auto value = [&](std::size_t i) { return std::max<std::int64_t>(told_[i].value_or(0), 0); };
    const auto& option = told_[4];
    DriveRates r{value(0), value(1), value(2), 0};
    if (!option || *option == 2 || *option == 6) r.quick_stop = value(3);
    if (option && (*option == 1 || *option == 5)) r.quick_stop = value(2);
    if (wants()) r.quick_stop = 0;  // which of them it uses is not known yet
    return r;
}

}  // namespace axisgate::cia402_drive
