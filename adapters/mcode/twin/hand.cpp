// Device: the tester's hand: outside conditions by the names that all families share.
// In: names and values. Out: what they cause, or why they make no sense.
// Never writes a word of the drive.
#include <algorithm>

#include "adapters/mcode/twin/device.hpp"

namespace axisgate::mcode::twin {

const HandRow<Device> Device::conditions[] = {
    {"power", true, "supply; off loses everything that S has not saved", [](const Device& d, Instant) -> Value { return d.powered_; },
     [](Device& d, const HandWish& w) {
         return w.flag([&](bool on) {
             if (on == d.powered_) return;
             if (on) {
                 d.powered_ = true;
                 d.boot();
             } else {
                 d.stop_everything();
                 d.waiting_.clear();
                 d.command_due_ = never;
                 d.powered_ = false;
             }
             d.settle(*w.out);
         });
     }},
    {"silent", true, "the drive hears and acts, but nothing that it sends reaches the line",
     [](const Device& d, Instant) -> Value { return d.tx_.silent; },
     [](Device& d, const HandWish& w) { return w.flag([&](bool on) { d.tx_.silent = on; }); }},
    {"inject_error", true, "ER and EF as if that error had come; 0 clears it",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.error_.code}; },
     [](Device& d, const HandWish& w) {
         return w.whole(0, 111, "an MCode error, 1..111, or 0 to clear it", [&](std::int64_t n) -> std::string {
             const auto code = static_cast<int>(n);
             if (code != 0 && !d.setup_.codes.empty() && std::ranges::find(d.setup_.codes, code) == d.setup_.codes.end())
                 return "inject_error: MCode has no error " + std::to_string(code) + "; the catalogue lists those that it has";
             if (!d.powered_) return "inject_error: the drive has no power";
             d.raise(code);
             d.settle(*w.out);
             return {};
         });
     }},
    {"address_input", true, "a hardware address input is active: PY is 1; the name stays that of DN",
     [](const Device& d, Instant) -> Value { return d.address_input_; },
     [](Device& d, const HandWish& w) {
         return w.flag([&](bool on) {
             d.address_input_ = on;
             if (!on || d.comm_.flags.py) return;
             d.comm_.disarm();
             d.comm_.flags.py = true;
         });
     },
     [](const Device& d) { return (d.setup_.product & lmm) != 0; }},
};

std::vector<HandItem> Device::hand() const {
    std::vector<HandItem> items = hand_items(conditions, *this, now_);
    for (HandItem& i : motor_->hand(now_))
        items.push_back(std::move(i));
    return items;
}

std::string Device::set_hand(const std::string& name, const Value& value, Instant now, Out& out) {
    pass_until(now, out);
    if (auto answer = set_hand_row(conditions, *this, *this, {name, value, now_, &out})) return *std::move(answer);
    if (auto fault = motor_->set_hand(name, value, now_)) {
        settle(out);
        return *fault;
    }
    std::string names;
    for (const HandItem& i : hand())
        names += (names.empty() ? "" : ", ") + i.name;
    return "there is no '" + name + "' here; there are: " + names;
}

}  // namespace axisgate::mcode::twin
