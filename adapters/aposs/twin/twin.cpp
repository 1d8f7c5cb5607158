#include "adapters/aposs/twin/twin.hpp"

#include <algorithm>
#include <cstdlib>

#include "adapters/aposs/twin/bus_manners.hpp"
#include "adapters/aposs/twin/direct.hpp"
#include "adapters/cia402/twin/node.hpp"
#include "gateway/core/hand_table.hpp"

namespace axisgate::aposs {
namespace {

class MacsTwin final : public Twin {
public:
    MacsTwin(const Catalogue& catalogue, const TwinSetup& setup)
        : objects_(catalogue, number(setup), freedom(setup.freedoms, "extra_pdo_ms")),
          node_(number(setup), objects_.factory()),
          bus_manners_(Manners(setup.freedoms, setup.seed), number(setup)),
          macs_(objects_, node_.dictionary(), std::atof(option(setup.options, "travel", "0").c_str()),
                Manners(setup.freedoms, setup.seed)) {
        node_.attach(macs_);
    }

    void on_frame(const Frame& f, Instant now, Out& out) override {
        at_ = now;
        bus_manners_.receive(node_, f, now, out);
    }
    void on_deadline(Instant now, Out& out) override {
        at_ = now;
        if (node_.powered()) bus_manners_.run(node_, now, out);
    }
    [[nodiscard]] Instant deadline() const override { return std::min(node_.deadline(), bus_manners_.deadline()); }
    void power_on(const NonVolatile& memory, Instant now, Out& out) override {
        bus_manners_.power_on(now);
        node_.power_on(memory, now, out);
    }
    [[nodiscard]] NonVolatile non_volatile() const override { return node_.stored(); }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return node_.revision(); }
    [[nodiscard]] bool fit_axes(int wanted, Instant) override { return wanted <= axes; }

    [[nodiscard]] std::vector<HandItem> hand() const override;
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override {
        if (node_.powered()) bus_manners_.run(node_, now, out);
        at_ = now;
        Out own;
        std::string fault = set(name, value, now, own);
        if (node_.powered()) node_.after_hand(now, own);
        bus_manners_.pass(own, now, out);
        return fault;
    }
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override {
        const MacsAxis& a = macs_.axis(std::clamp(channel, 1, axes));
        TwinMechanics m = a.servo().mechanics(now);
        m.position = a.place(now);
        m.velocity = a.machine.velocity().value_or(m.velocity);
        m.powered = m.powered || (node_.powered() && a.holds_in_error());  // controlled, although in error
        return m;
    }

private:
    static std::uint8_t number(const TwinSetup& setup) {
        return static_cast<std::uint8_t>(std::clamp(std::atoi(setup.address.c_str()), 1, 127));
    }

    static const HandRow<MacsTwin> conditions[];
    /// A condition with two states.
    template <class Then>
    static std::string flag(const HandWish& w, Then&& then) {
        const auto n = as_integer(w.value);
        if (!n) return w.name + ": write true, false or a whole number";
        if (*n < 0 || *n > 1) return w.name + ": write true or false";
        return then(*n != 0), std::string();
    }
    std::string set(const std::string& name, const Value& value, Instant now, Out& out);
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
    BusManners bus_manners_;
    Macs macs_;
    std::string reply_;  ///< of the direct mode
    Instant at_{};
};

constexpr std::string_view gears[] = {"none", "velocity", "position", "marker"};

const HandRow<MacsTwin> MacsTwin::conditions[] = {
    {"power", true, "supply of the controller", [](const MacsTwin& m, Instant) -> Value { return m.node_.powered(); },
     [](MacsTwin& m, const HandWish& w) {
         return flag(w, [&](bool on) {
             if (!on && m.node_.powered()) {
                 m.node_.power_off(w.now);
                 m.bus_manners_.power_off();
             }
             if (on && !m.node_.powered()) {
                 m.bus_manners_.power_on(w.now);
                 m.node_.power_on(m.node_.stored(), w.now, *w.out);
             }
         });
     }},
    {"silent", true, "it hears and does not answer", [](const MacsTwin& m, Instant) -> Value { return m.node_.silent(); },
     [](MacsTwin& m, const HandWish& w) { return flag(w, [&](bool on) { m.node_.set_silent(on); }); }},
    {"inputs", true,
     "digital inputs, bit mask: bit 0 is input 1; also those that parameters give a function or a marker; bits 16 to 31 of 60FDh",
     [](const MacsTwin& m, Instant) -> Value { return static_cast<std::int64_t>(m.macs_.terminals().inputs); },
     [](MacsTwin& m, const HandWish& w) -> std::string {
         const auto n = as_integer(w.value);
         if (!n) return w.name + ": write true, false or a whole number";
         if (*n < 0 || *n > 0xFFFF) return "inputs: write a bit mask, 0 to 65535";
         m.macs_.set_inputs(static_cast<std::uint32_t>(*n), w.now);
         return {};
     }},
    {"outputs", false, "digital outputs, bit mask: bit 0 is output 1",
     [](const MacsTwin& m, Instant) -> Value { return static_cast<std::int64_t>(m.macs_.outputs(m.at_)); }},
    {"program", true, "a program runs; when it begins user values are in force again, when it ends program values die",
     [](const MacsTwin& m, Instant) -> Value { return m.macs_.program().has_value(); },
     [](MacsTwin& m, const HandWish& w) {
         return flag(w, [&](bool on) {
             if (on && !m.macs_.program()) m.macs_.start_program(0);
             if (!on && m.macs_.program()) m.macs_.end_program(true);
         });
     }},
    {"program_number", false, "of the program that runs: 0, or as I_PRGCHOICE or PRGPAR has chosen it; -1: none",
     [](const MacsTwin& m, Instant) -> Value { return std::int64_t{m.macs_.program().value_or(-1)}; }},
    {"direct", true, "a statement of the direct mode, such as SYNCM x(2); it is shown with its answer",
     [](const MacsTwin& m, Instant) -> Value { return m.reply_; },
     [](MacsTwin& m, const HandWish& w) -> std::string {
         if (!m.node_.powered()) return w.name + ": the controller is off";
         const std::string text = to_text(w.value);
         const DirectAnswer answer = axisgate::aposs::direct(m.macs_, text, w.now);
         if (!answer.fault.empty()) return "direct: " + answer.fault;
         m.reply_ = answer.text.empty() ? text : text + ": " + answer.text;
         return {};
     }},
    {"gear", true,
     "the second axis follows the first: none, velocity (SYNCV), position (SYNCP) or marker (SYNCM), as a program would start it",
     [](const MacsTwin& m, Instant) -> Value { return std::string(gears[static_cast<std::size_t>(m.macs_.coupling().of(1).mode())]); },
     [](MacsTwin& m, const HandWish& w) -> std::string {
         if (!m.node_.powered()) return w.name + ": the controller is off";
         const std::string text = to_text(w.value);
         const auto* gear = std::ranges::find(gears, std::string_view(text));
         if (gear == std::end(gears)) return "gear: write none, velocity, position or marker";
         std::string fault = m.macs_.coupling().synchronise(1, static_cast<SyncMode>(gear - std::begin(gears)), w.now);
         m.macs_.begin_ticks(w.now);
         return fault;
     }},
    {"bus_silent", true, "devices on the controller's own bus answer no guarding (error 88)",
     [](const MacsTwin& m, Instant) -> Value { return m.macs_.bus_silent(); },
     [](MacsTwin& m, const HandWish& w) { return flag(w, [&](bool on) { m.macs_.set_bus_silent(on, w.now); }); }},
    {"can_objects", false, "objects that there are on the controller's own bus",
     [](const MacsTwin& m, Instant) -> Value { return m.macs_.bus().objects(); }},
    {"nmt0", false, "how often the controller has initialised a device on its own bus",
     [](const MacsTwin& m, Instant) -> Value { return m.macs_.bus().initialised(); }},
    {"reset_parameters", true, "Controller > Reset: all parameters as the firmware has them",
     [](const MacsTwin&, Instant) -> Value { return false; },
     [](MacsTwin& m, const HandWish& w) {
         return flag(w, [&](bool on) {
             if (on) m.macs_.reset_parameters();
         });
     }},
    {"eprom_writes", false, "how often SAVEPROM has written; an EPROM lasts for about 10000",
     [](const MacsTwin& m, Instant) -> Value { return m.macs_.eprom_writes(); }},
};

std::vector<HandItem> MacsTwin::hand() const {
    std::vector<HandItem> items = hand_items(conditions, *this, at_);
    for (int n = 1; n <= axes; ++n) {
        const MacsAxis& a = macs_.axis(n);
        const Servo& s = a.servo();
        const std::string p = n == 1 ? "" : "axis" + std::to_string(n) + ".";
        items.push_back({p + "stall", Value{s.shaft().held()}, true, "the shaft is held"});
        items.push_back({p + "safe_voltage_enable", Value{s.safe_voltage}, true,
                         "the input that lets the motor have power (STO); bit 4 of the status word"});
        items.push_back({p + "load", Value{a.load}, true, "part of AMPMAXCUR that the motor takes, 0 to 1"});
        items.push_back(
            {p + "encoder", Value{macs_.coupling().by_hand[static_cast<std::size_t>(n - 1)]}, true, "master encoder turned by hand, qc"});
        items.push_back({p + "index", Value{a.index_pulses}, true, "the encoder gives index pulses"});
        if (const auto word = macs_.bus().control_word(n - 1)) {
            items.push_back({p + "drive_word", Value{std::int64_t{*word}}, false, "control word that the bus drive was sent"});
            items.push_back({p + "drive_enabled", Value{macs_.bus().drive_enabled(n - 1)}, false, "the bus drive is enabled by it"});
        }
        items.push_back({p + "misread", Value{static_cast<std::int64_t>(a.misreading().by)}, true, "the encoder says so many qc too much"});
        items.push_back({p + "swing", Value{static_cast<std::int64_t>(s.shaft().swings())}, true,
                         "the shaft swings by so many qc to both sides in 7 ms"});
        items.push_back({p + "limit_positive", Value{s.limit_positive}, true, "the positive limit switch"});
        items.push_back({p + "limit_negative", Value{s.limit_negative}, true, "the negative limit switch"});
        items.push_back({p + "home_switch", Value{s.home_switch}, true, "the reference switch"});
        items.push_back(
            {p + "inject_error", Value{std::int64_t{0}}, true, "an error number of the manual (6, 88, 89, 98, 99); 0: its cause is gone"});
    }
    return items;
}

std::string MacsTwin::set(const std::string& name, const Value& value, Instant now, Out& out) {
    if (auto answer = set_hand_row(conditions, *this, *this, {name, value, now, &out})) return *std::move(answer);
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
    const auto dot = name.find('.');
    if (dot == std::string::npos) return set_axis(1, name, *n, now);
    const int k = name.starts_with("axis") ? std::atoi(name.c_str() + 4) : 0;
    if (k < 1 || k > axes) return "there is no '" + name + "' here; axes are axis1 to axis" + std::to_string(axes);
    return set_axis(k, name.substr(dot + 1), *n, now);
}

}  // namespace

std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup) { return std::make_unique<MacsTwin>(catalogue, setup); }

}  // namespace axisgate::aposs
