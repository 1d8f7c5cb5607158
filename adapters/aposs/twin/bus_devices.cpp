// Only the last orders of a device are stored.
#include "adapters/aposs/twin/bus_devices.hpp"

namespace axisgate::aposs {
namespace {
constexpr std::array by_names{"DRIVETYPE", "ENCODERTYPE", "MENCODERTYPE"};
struct BusUse {
    bool there = false, guarded = false;
};
BusUse use_of(BusDevices::By by, std::int64_t value) {
    if (by == BusDevices::By::drive) {
        const auto d = drive_of(value).value_or(DriveCode{});
        return {d.type != 0, d.guarded};
    }
    const auto e = encoder_of(value, by == BusDevices::By::master).value_or(EncoderCode{});
    return {e.source == Encoder::can, e.guarded};
}
}  // namespace

void BusDevices::set(int axis, By by, std::int64_t value) {
    Axis& a = of(axis);
    if (std::exchange(a.value.at(static_cast<std::size_t>(by)), value) == value) return;
    if (use_of(by, value).there) ++nmt0_;
    if (by != By::drive) return;
    a.word.reset();
    a.enabled = a.quick_stop = false;
}

bool BusDevices::guards() const {
    for (const Axis& a : axes_)
        for (std::size_t k = 0; k < a.value.size(); ++k)
            if (use_of(static_cast<By>(k), a.value.at(k)).guarded) return true;
    return false;
}
std::string BusDevices::objects() const {
    std::string all;
    const auto add = [&](const std::string& text) { all += (all.empty() ? "" : "; ") + text; };
    for (std::size_t n = 0; n < axes_.size(); ++n)
        for (std::size_t k = 0; k < by_names.size(); ++k) {
            const BusUse use = use_of(static_cast<By>(k), axes_.at(n).value.at(k));
            if (use.there)
                add(std::string(by_names.at(k)) + " x(" + std::to_string(n + 1) + "): PDO, SYNC" + (use.guarded ? ", GUARD" : ""));
        }
    if (of_application_ > 0) add("application: " + std::to_string(of_application_));
    return all.empty() ? "none" : all;
}

void BusDevices::send(int axis, std::uint16_t word) {
    Axis& a = of(axis);
    const auto code = drive_of(a.value[0]).value_or(DriveCode{});
    if (code.own_word || code.type != 11) return;
    a.word = word;
    if (word == 0x0F) a.enabled = !a.quick_stop;
    if (word != 0x0F) a.enabled = false;
    if (word == 0x02) a.quick_stop = true;
    if (word == 0x06) a.quick_stop = false;
}
bool BusDevices::outda(int axis, std::int64_t value) {
    Axis& a = of(axis);
    if (!drive_of(a.value[0]).value_or(DriveCode{}).own_word) return false;
    a.word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(value) >> 16);
    return true;
}

}  // namespace axisgate::aposs
