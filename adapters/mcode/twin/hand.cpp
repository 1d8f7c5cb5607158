// Device: the tester's hand: outside conditions by the names that all families share.
// In: names and values. Out: what they cause, or why they make no sense.
// Never writes a word of the drive.
#include <algorithm>

#include "adapters/mcode/twin/device.hpp"

namespace axisgate::mcode::twin {

std::vector<HandItem> Device::hand() const {
    std::vector<HandItem> items;
    items.push_back({"power", powered_, true, "supply; off loses everything that S has not saved"});
    items.push_back({"silent", tx_.silent, true, "the drive hears and acts, but nothing that it sends reaches the line"});
    items.push_back({"inject_error", std::int64_t{error_.code}, true, "ER and EF as if that error had come; 0 clears it"});
    if ((setup_.product & lmm) != 0)
        items.push_back({"address_input", address_input_, true, "a hardware address input is active: PY is 1; the name stays that of DN"});
    for (HandItem& i : motor_->hand(now_))
        items.push_back(std::move(i));
    return items;
}

std::string Device::set_hand(const std::string& name, const Value& value, Instant now, Out& out) {
    pass_until(now, out);
    const auto flag = as_flag(value);
    if (name == "power") {
        if (!flag) return name + ": " + axisgate::to_text(value) + " is not true or false";
        if (*flag == powered_) return {};
        if (*flag) {
            powered_ = true;
            boot();
        } else {
            stop_everything();
            waiting_.clear();
            command_due_ = never;
            powered_ = false;
        }
        settle(out);
        return {};
    }
    if (name == "silent") {
        if (!flag) return name + ": " + axisgate::to_text(value) + " is not true or false";
        tx_.silent = *flag;
        return {};
    }
    if (name == "address_input" && (setup_.product & lmm) != 0) {
        if (!flag) return name + ": " + axisgate::to_text(value) + " is not true or false";
        address_input_ = *flag;
        if (*flag && !comm_.flags.py) {
            comm_.disarm();
            comm_.flags.py = true;
        }
        return {};
    }
    if (name == "inject_error") {
        const auto code = as_integer(value);
        if (!code || *code < 0 || *code > 111)
            return "inject_error: " + axisgate::to_text(value) + " is not an MCode error, 1..111, or 0 to clear it";
        if (*code != 0 && !setup_.codes.empty() && std::ranges::find(setup_.codes, static_cast<int>(*code)) == setup_.codes.end())
            return "inject_error: MCode has no error " + std::to_string(*code) + "; the catalogue lists those that it has";
        if (!powered_) return "inject_error: the drive has no power";
        raise(static_cast<int>(*code));
        settle(out);
        return {};
    }
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
