// Twin of a MACS controller: setup, memory and hand.
// In: what a tester sets. Out: the node and the controller told. Never sets what the wire alone may set.
#include "adapters/aposs/twin/twin.hpp"

#include <algorithm>
#include <cstdlib>

#include "adapters/aposs/twin/direct.hpp"
#include "adapters/cia402/twin/node.hpp"

namespace axisgate::aposs {
namespace {

class MacsTwin final : public Twin {
public:
    MacsTwin(const Catalogue& catalogue, const TwinSetup& setup)
        : objects_(catalogue, number(setup)),
          node_(number(setup), objects_.factory()),
          macs_(objects_, node_.dictionary(), std::atof(option(setup.options, "travel", "0").c_str())) {
        node_.attach(macs_);
    }

    void on_frame(const Frame& f, Instant now, Out& out) override {
        at_ = now;
        node_.on_frame(f, now, out);
    }
    void on_deadline(Instant now, Out& out) override {
        at_ = now;
        if (node_.powered()) node_.advance(now, out);
    }
    [[nodiscard]] Instant deadline() const override { return node_.deadline(); }
    void power_on(const NonVolatile& memory, Instant now, Out& out) override { node_.power_on(memory, now, out); }
    [[nodiscard]] NonVolatile non_volatile() const override { return node_.stored(); }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return node_.revision(); }
    [[nodiscard]] bool fit_axes(int wanted, Instant) override { return wanted <= axes; }

    [[nodiscard]] std::vector<HandItem> hand() const override {
        static constexpr const char* gears[] = {"none", "velocity", "position", "marker"};
        std::vector<HandItem> items{
            {"power", Value{node_.powered()}, true, "supply of the controller"},
            {"silent", Value{node_.silent()}, true, "it hears and does not answer"},
            {"inputs", Value{static_cast<std::int64_t>(macs_.terminals().inputs)}, true,
             "digital inputs, bit mask: bit 0 is input 1; also those that parameters give a function or a marker; bits 16 to 31 of 60FDh"},
            {"outputs", Value{static_cast<std::int64_t>(macs_.outputs(at_))}, false, "digital outputs, bit mask: bit 0 is output 1"},
            {"program", Value{macs_.program().has_value()}, true,
             "a program runs; when it begins user values are in force again, when it ends program values die"},
            {"program_number", Value{std::int64_t{macs_.program().value_or(-1)}}, false,
             "of the program that runs: 0, or as I_PRGCHOICE or PRGPAR has chosen it; -1: none"},
            {"direct", Value{reply_}, true, "a statement of the direct mode, such as SYNCM x(2); it is shown with its answer"},
            {"gear", Value{std::string(gears[static_cast<std::size_t>(macs_.coupling().of(1).mode())])}, true,
             "the second axis follows the first: none, velocity (SYNCV), position (SYNCP) or marker (SYNCM), as a program would start it"},
            {"bus_silent", Value{macs_.bus_silent()}, true, "devices on the controller's own bus answer no guarding (error 88)"},
            {"can_objects", Value{macs_.bus().objects()}, false, "objects that there are on the controller's own bus"},
            {"nmt0", Value{macs_.bus().initialised()}, false, "how often the controller has initialised a device on its own bus"},
            {"reset_parameters", Value{false}, true, "Controller > Reset: all parameters as the firmware has them"},
            {"eprom_writes", Value{macs_.eprom_writes()}, false, "how often SAVEPROM has written; an EPROM lasts for about 10000"}};
        for (int n = 1; n <= axes; ++n) {
            const MacsAxis& a = macs_.axis(n);
            const Servo& s = a.servo();
            const std::string p = n == 1 ? "" : "axis" + std::to_string(n) + ".";
            items.push_back({p + "stall", Value{s.shaft().held()}, true, "the shaft is held"});
            items.push_back({p + "safe_voltage_enable", Value{s.safe_voltage}, true,
                             "the input that lets the motor have power (STO); bit 4 of the status word"});
            items.push_back({p + "load", Value{a.load}, true, "part of AMPMAXCUR that the motor takes, 0 to 1"});
            items.push_back({p + "encoder", Value{macs_.coupling().by_hand[static_cast<std::size_t>(n - 1)]}, true,
                             "master encoder turned by hand, qc"});
            items.push_back({p + "index", Value{a.index_pulses}, true, "the encoder gives index pulses"});
            if (const auto word = macs_.bus().control_word(n - 1)) {
                items.push_back({p + "drive_word", Value{std::int64_t{*word}}, false, "control word that the bus drive was sent"});
                items.push_back({p + "drive_enabled", Value{macs_.bus().drive_enabled(n - 1)}, false, "the bus drive is enabled by it"});
            }
            items.push_back(
                {p + "misread", Value{static_cast<std::int64_t>(a.misreading().by)}, true, "the encoder says so many qc too much"});
            items.push_back({p + "swing", Value{static_cast<std::int64_t>(s.shaft().swings())}, true,
                             "the shaft swings by so many qc to both sides in 7 ms"});
            items.push_back({p + "limit_positive", Value{s.limit_positive}, true, "the positive limit switch"});
            items.push_back({p + "limit_negative", Value{s.limit_negative}, true, "the negative limit switch"});
            items.push_back({p + "home_switch", Value{s.home_switch}, true, "the reference switch"});
            items.push_back({p + "inject_error", Value{std::int64_t{0}}, true,
                             "an error number of the manual (6, 88, 89, 98, 99); 0: its cause is gone"});
        }
        return items;
    }

    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override {
        if (node_.powered()) node_.advance(now, out);
        at_ = now;
        std::string fault = set(name, value, now, out);
        if (node_.powered()) node_.after_hand(now, out);
        return fault;
    }
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override {
        const MacsAxis& a = macs_.axis(std::clamp(channel, 1, axes));
        TwinMechanics m = a.servo().mechanics(now);
        m.powered = m.powered || (node_.powered() && a.holds_in_error());  // under control, though in error
        return m;
    }

private:
    static std::uint8_t number(const TwinSetup& setup) {
        return static_cast<std::uint8_t>(std::clamp(std::atoi(setup.address.c_str()), 1, 127));
    }

    std::string set(const std::string& name, const Value& value, Instant now, Out& out) {
        if (name == "gear" || name == "direct") {
            if (!node_.powered()) return name + ": the controller is off";
            const std::string text = to_text(value);
            if (name == "direct") {
                DirectAnswer answer = direct(macs_, text, now);
                if (answer.fault.empty()) reply_ = answer.text.empty() ? text : text + ": " + answer.text;
                return answer.fault.empty() ? "" : "direct: " + answer.fault;
            }
            const auto mode = text == "velocity"   ? std::optional(SyncMode::velocity)
                              : text == "position" ? std::optional(SyncMode::position)
                              : text == "marker"   ? std::optional(SyncMode::marker)
                              : text == "none"     ? std::optional(SyncMode::none)
                                                   : std::nullopt;
            if (!mode) return "gear: write none, velocity, position or marker";
            std::string fault = macs_.coupling().synchronise(1, *mode, now);
            macs_.begin_ticks(now);
            return fault;
        }
        if (name == "load" || name.ends_with(".load")) {
            const auto load = as_number(value);
            const int k = name == "load" ? 1 : name == "axis2.load" ? 2 : 0;
            if (k == 0) return "there is no '" + name + "' here";
            if (!load || *load < 0 || *load > 1) return name + ": write 0 to 1";
            macs_.axis(k).load = *load;
            return {};
        }
        const auto n = as_integer(value);
        if (!n) return name + ": write true, false or a whole number";
        if (name == "inputs") {
            if (*n < 0 || *n > 0xFFFF) return "inputs: write a bit mask, 0 to 65535";
            macs_.set_inputs(static_cast<std::uint32_t>(*n), now);
            return {};
        }
        if (const auto dot = name.find('.'); dot != std::string::npos) {
            const int k = name.starts_with("axis") ? std::atoi(name.c_str() + 4) : 0;
            if (k < 1 || k > axes) return "there is no '" + name + "' here; axes are axis1 to axis" + std::to_string(axes);
            return set_axis(k, name.substr(dot + 1), *n, now);
        }
        const bool on = *n != 0;
        if (name != "power" && name != "silent" && name != "program" && name != "reset_parameters" && name != "bus_silent")
            return set_axis(1, name, *n, now);
        if (*n < 0 || *n > 1) return name + ": write true or false";
        if (name == "power") {
            if (!on && node_.powered()) node_.power_off(now);
            if (on && !node_.powered()) node_.power_on(node_.stored(), now, out);
        } else if (name == "silent") {
            node_.set_silent(on);
        } else if (name == "program") {
            if (on && !macs_.program()) macs_.start_program(0);
            if (!on && macs_.program()) macs_.end_program(true);
        } else if (name == "bus_silent") {
            macs_.set_bus_silent(on, now);
        } else if (on) {
            macs_.reset_parameters();
        }
        return {};
    }

    std::string set_axis(int k, const std::string& name, std::int64_t n, Instant now) {
        MacsAxis& a = macs_.axis(k);
        Servo& s = a.servo();
        const bool on = n != 0;
        if (name == "encoder") {
            if (n < INT32_MIN || n > INT32_MAX) return "encoder: write quad counts of 32 bits";
            macs_.coupling().by_hand[static_cast<std::size_t>(k - 1)] = n;
            return {};
        }
        if (name == "misread" || name == "swing") {
            if (n < INT32_MIN || n > INT32_MAX) return name + ": write quad counts of 32 bits";
            if (name == "swing" && (n < 0 || n > 100'000)) return "swing: write 0 to 100000";
            if (name == "swing") {
                s.shaft().swing(static_cast<double>(n));
            } else {
                a.misread(static_cast<double>(n), now);
            }
            macs_.begin_ticks(now);
            return {};
        }
        if (name == "inject_error") {
            static constexpr std::int64_t numbers[] = {0, 6, 88, 89, 98, 99};
            if (std::ranges::find(numbers, n) == std::end(numbers)) return "inject_error: write 6, 88, 89, 98 or 99, or 0";
            if (!node_.powered()) return "inject_error: the controller is off";
            const auto code = static_cast<std::uint16_t>(n == 0 ? 0 : error_base + n);
            s.set_cause(code);
            if (on) a.raise(code, now);
            macs_.begin_ticks(now);
            return {};
        }
        if (n < 0 || n > 1) return name + ": write true or false";
        if (name == "stall") {
            s.hold(on, now);
        } else if (name == "safe_voltage_enable") {
            s.safe_voltage = on;
            s.inputs_changed(now);
            macs_.begin_ticks(now);
        } else if (name == "index") {
            a.index_pulses = on;
        } else if (name == "limit_positive" || name == "limit_negative" || name == "home_switch") {
            (name == "limit_positive" ? s.limit_positive : name == "limit_negative" ? s.limit_negative : s.home_switch) = on;
            a.inputs_changed(now);
            macs_.begin_ticks(now);
        } else {
            return name + " is nothing that a hand can do here";
        }
        return {};
    }

    Objects objects_;
    cia402_drive::twin::Node node_;
    Macs macs_;
    std::string reply_;  ///< of the direct mode
    Instant at_{};
};

}  // namespace

std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup) { return std::make_unique<MacsTwin>(catalogue, setup); }

}  // namespace axisgate::aposs
