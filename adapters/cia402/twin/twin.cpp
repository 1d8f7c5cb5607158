#include "adapters/cia402/twin/twin.hpp"

#include <algorithm>
#include <cstdlib>

#include "adapters/cia402/twin/free_servo.hpp"
#include "adapters/cia402/twin/node.hpp"
#include "adapters/cia402/twin/objects.hpp"

namespace axisgate::cia402_drive::twin {
namespace {

/// The built-in dictionary with the values of a description; counts the entries that the model does not know. Where the description gives
/// no value, the model's stays; the identity is that of [DeviceInfo] where 1018h gives none.
canopen::Dictionary described(std::uint8_t node, const canopen::Eds* eds, std::int64_t& unmodelled) {
    canopen::Dictionary d = factory_dictionary(node);
    if (eds == nullptr) return d;
    const canopen::Dictionary own = canopen::dictionary_of(*eds, node);
    const auto silent = [eds](canopen::Address a) {
        const auto e = eds->entries.find(a);
        return e == eds->entries.end() || (!e->second.configured.given() && !e->second.fallback.given());
    };
    for (const auto& [address, entry] : own.entries()) {
        const canopen::Entry* known = d.find(address);
        if (known == nullptr) ++unmodelled;
        if (known == nullptr || known->type == entry.type) {
            canopen::Entry e = entry;
            if (known != nullptr && silent(address)) e.bytes = known->bytes;
            d.add(address, std::move(e));
        } else if (!silent(address)) {
            (void)d.set(address, own.value(address));  // another type than the standard's would be another object: its value alone
        }
    }
    std::uint8_t sub = 0;
    for (const auto& number : {eds->vendor_number, eds->product_number, eds->revision_number})
        if (const canopen::Address at{0x1018, ++sub}; number && silent(at)) (void)d.set(at, Value{std::int64_t{*number}});
    return d;
}

class CanServo final : public Twin {
public:
    CanServo(const TwinSetup& setup, const canopen::Eds* eds, std::span<const Freedom> freedoms)
        : node_(number(setup), described(number(setup), eds, unmodelled_)),
          servo_(node_.dictionary(), std::atof(option(setup.options, "travel", "0").c_str())) {
        node_.attach(servo_);
        freedoms_.assign(freedoms.begin(), freedoms.end());
        values_ = setup.freedoms;
        seed_ = setup.seed;
        be(Instant{});
    }

    void on_frame(const Frame& f, Instant now, Out& out) override { node_.on_frame(f, now, out); }
    void on_deadline(Instant now, Out& out) override {
        if (node_.powered()) node_.advance(now, out);
    }
    [[nodiscard]] Instant deadline() const override { return node_.deadline(); }
    [[nodiscard]] Acceptance acceptance() const noexcept override { return node_.acceptance(); }
    void power_on(const NonVolatile& memory, Instant now, Out& out) override { node_.power_on(memory, now, out); }
    [[nodiscard]] NonVolatile non_volatile() const override { return node_.stored(); }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return node_.revision(); }

    [[nodiscard]] std::vector<HandItem> hand() const override {
        const FreeServo& s = servo_;
        return {
            {"power", Value{node_.powered()}, true, "supply of the drive"},
            {"silent", Value{node_.silent()}, true, "it hears and does not answer"},
            {"stall", Value{stalled_}, true, "the shaft is held"},
            {"safe_voltage_enable", Value{s.safe_voltage}, true,
             "the input that lets the motor have power (STO); bit 4 of the status word"},
            {"inputs", Value{static_cast<std::int64_t>(s.inputs >> 16)}, true, "digital inputs, bit mask; they are bits 16 to 31 of 60FDh"},
            {"outputs", Value{outputs()}, false, "60FEh:01 as the mask of 60FEh:02 lets it through"},
            {"limit_positive", Value{s.limit_positive}, true, "the upper limit switch"},
            {"limit_negative", Value{s.limit_negative}, true, "the lower limit switch"},
            {"home_switch", Value{s.home_switch}, true, "the home switch"},
            {"inject_error", Value{std::int64_t{0}}, true,
             "an error code of CiA 402 (8976: short circuit at the output); 0: its cause is gone"},
            {"unmodelled", Value{unmodelled_}, false, "entries of the description that are stored and do nothing here"}};
    }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override {
        const auto n = as_integer(value);
        if (!n) return name + ": write true, false or a whole number";
        if (node_.powered()) node_.advance(now, out);
        Servo& s = servo_;
        const bool on = *n != 0, flag = *n == 0 || *n == 1;
        if (const auto f = std::ranges::find(freedoms_, name, &Freedom::name); f != freedoms_.end()) return set_freedom(*f, *n, now);
        if (name == "inject_error") {
            const auto& codes = error_codes();
            if (on && std::ranges::find(codes, *n) == codes.end())
                return "inject_error: write one of the error codes of the catalogue, or 0";
            if (!node_.powered()) return "inject_error: the drive is off";
            s.set_cause(static_cast<std::uint16_t>(*n));
            if (on) s.fail(static_cast<std::uint16_t>(*n), now);
        } else if (name == "inputs") {
            if (*n < 0 || *n > 0xFFFF) return "inputs: write a bit mask, 0 to 65535";
            s.inputs = static_cast<std::uint32_t>(*n) << 16;
            s.inputs_changed(now);
        } else if (!flag) {
            return name + ": write true or false";
        } else if (name == "power") {
            if (!on && node_.powered()) node_.power_off(now);
            if (on && !node_.powered()) node_.power_on(node_.stored(), now, out);
        } else if (name == "silent") {
            node_.set_silent(on);
        } else if (name == "stall") {
            stalled_ = on;
            s.hold(on, now);
        } else if (name == "safe_voltage_enable") {
            s.safe_voltage = on;
            s.inputs_changed(now);
        } else if (name == "limit_positive" || name == "limit_negative" || name == "home_switch") {
            (name == "limit_positive" ? s.limit_positive : name == "limit_negative" ? s.limit_negative : s.home_switch) = on;
            s.inputs_changed(now);
        } else {
            return name + " is nothing that a hand can do here";
        }
        if (node_.powered()) node_.after_hand(now, out);
        return {};
    }
    [[nodiscard]] TwinMechanics mechanics(int, Instant now) const override { return servo_.mechanics(now); }

private:
    /// Another behaviour from now on, as of a drive with another firmware.
    std::string set_freedom(const Freedom& f, std::int64_t value, Instant now) {
        if (f.name == "flash_silence_ms") return f.name + " is an option of the twin; it cannot be changed here";
        const bool listed = f.values.empty() || std::ranges::any_of(f.values, [value](const auto& v) { return v.first == value; });
        if (value < f.min || value > f.max || !listed)
            return f.name + ": write " + std::to_string(f.min) + " to " + std::to_string(f.max) +
                   (listed ? "" : ", as the page lists them");
        values_[f.name] = value;
        be(now);
        return {};
    }
    void be(Instant now) {
        const Freedoms all(values_, seed_);
        node_.set_freedoms(all);
        servo_.set_freedoms(all, now);
    }
    /// 60FEh, limited by its mask.
    [[nodiscard]] std::int64_t outputs() const {
        const auto of = [&](std::uint8_t sub) { return node_.dictionary().integer({0x60FE, sub}).value_or(0); };
        return of(1) & of(2);
    }
    static std::uint8_t number(const TwinSetup& setup) {
        return static_cast<std::uint8_t>(std::clamp(std::atoi(setup.address.c_str()), 1, 127));
    }
    std::int64_t unmodelled_ = 0;  ///< counted when the node is made
    Node node_;
    FreeServo servo_;
    std::vector<Freedom> freedoms_;  ///< with their ranges, for the hand
    FreedomValues values_;
    std::uint64_t seed_ = 0;
    bool stalled_ = false;
};

}  // namespace

std::unique_ptr<Twin> make_twin(const TwinSetup& setup, const canopen::Eds* description, std::span<const Freedom> freedoms) {
    return std::make_unique<CanServo>(setup, description, freedoms);
}

}  // namespace axisgate::cia402_drive::twin
