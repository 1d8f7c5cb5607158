// A write that would be refused over the bus is refused here, too.
#include "adapters/aposs/twin/direct.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace axisgate::aposs {
namespace {
constexpr std::size_t longest = 200;

/// Words, numbers and signs; `x(2)` is one word.
std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words(1);
    for (const char c : line.substr(0, line.find("//"))) {
        if (c == ' ' || c == '\t') {
            if (!words.back().empty()) words.emplace_back();
        } else if (c == '/' || c == '=') {
            if (!words.back().empty()) words.emplace_back();
            words.back() = c;
            words.emplace_back();
        } else {
            words.back() += c;
        }
    }
    if (words.back().empty()) words.pop_back();
    return words;
}
std::optional<std::int64_t> whole(std::string_view text) {
    std::int64_t v = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), v);
    return fault == std::errc{} && end == text.data() + text.size() && v >= INT32_MIN && v <= INT32_MAX ? std::optional(v) : std::nullopt;
}

class Line {
public:
    Line(Macs& macs, Instant now) : m_(macs), now_(now) {}
    DirectAnswer run(std::vector<std::string> words);

private:
    using Values = std::span<const std::int64_t>;
    DirectAnswer set(const std::vector<std::string>& words);
    DirectAnswer system_variable(const std::vector<std::string>& words);
    DirectAnswer motion(const std::string& word, Values values);
    DirectAnswer synchronise(const std::string& word);
    DirectAnswer take_axis(std::vector<std::string>& words);
    DirectAnswer motor(const std::string& what);
    DirectAnswer output(Values values);
    DirectAnswer virtual_master(const std::string& word, Values values);
    DirectAnswer define_origin(const std::string& word);
    DirectAnswer ask(const std::string& word);
    DirectAnswer write(Address address, std::int64_t v);
    void control(std::int64_t cw);
    [[nodiscard]] MacsAxis& axis() { return m_.axis(axis_ + 1); }
    [[nodiscard]] Address profile(std::uint16_t index) const { return {static_cast<std::uint16_t>(index + per_axis * axis_), 0}; }
    /// In the scale of VELRES: a fraction of the maximum speed or acceleration.
    [[nodiscard]] std::int64_t scaled(std::int64_t v, std::uint16_t most) {
        return axis().of(most) * v / std::max<std::int64_t>(1, axis().value("VELRES"));
    }
    DirectAnswer done() {
        const auto error = axis().of(0x603F) & 0xFFFF;
        const auto state = axis().servo().state();
        const bool failed = state == cia402_drive::twin::State::fault || state == cia402_drive::twin::State::fault_reaction;
        if (!failed) return {};
        return {"error " + std::to_string(error >= error_base ? error - error_base : error) + " of axis " + std::to_string(axis_ + 1), {}};
    }
    Macs& m_;
    Instant now_;
    int axis_ = 0;
};

DirectAnswer Line::write(Address address, std::int64_t v) {
    std::array<std::uint8_t, 4> bytes{};
    const canopen::Entry* e = m_.dictionary().find(address);
    if (e == nullptr) return {"there is no such object", {}};
    for (std::size_t i = 0; i < 4; ++i)
        bytes.at(i) = static_cast<std::uint8_t>(static_cast<std::uint64_t>(v) >> 8 * i);
    const auto refused = m_.dictionary().write(address, std::span(bytes).first(e->bytes.size()), true);
    return refused == canopen::Abort::none ? DirectAnswer{} : DirectAnswer{"refused: " + canopen::to_text(refused), {}};
}
void Line::control(std::int64_t cw) {
    (void)m_.dictionary().set(profile(0x6040), Value{cw});
    m_.written(profile(0x6040), now_);
}

DirectAnswer Line::set(const std::vector<std::string>& words) {
    if (words.size() < 3) return {"write SET NAME [x(n)] value", {}};
    std::vector<std::int64_t> values;
    for (std::size_t i = 2; i < words.size(); ++i) {
        if (words[i] == "/") continue;
        const auto v = whole(words[i]);
        if (!v) return {"'" + words[i] + "' is no whole number", {}};
        values.push_back(*v);
    }
    if (values.size() > axes) return {"there are " + std::to_string(axes) + " axes", {}};
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Row* row = m_.objects().named(words[1], axis_ + static_cast<int>(k));
        if (row == nullptr || row->storage == "state") return {"there is no parameter '" + words[1] + "'", {}};
        if (DirectAnswer a = write(row->address, values[k]); !a.fault.empty()) return a;
    }
    return {};
}
/// `SYSVAR[4315]`, `SYSVAR[4105] = 20`: variables whose object is known.
DirectAnswer Line::system_variable(const std::vector<std::string>& words) {
    const std::string& word = words[0];
    const auto n = word.ends_with("]") ? whole(std::string_view(word).substr(7, word.size() - 8)) : std::nullopt;
    if (!n || *n < 1 || *n > 4350) return {"write SYSVAR[n], n from 1 to 4350", {}};
    const Address address = *n >= 4096 ? Address{static_cast<std::uint16_t>(0x2500 + axis_), static_cast<std::uint8_t>(*n - 4095)}
                                       : Address{0x2202, static_cast<std::uint8_t>(std::min<std::int64_t>(*n, 255))};
    if (m_.dictionary().find(address) == nullptr) return {"SYSVAR " + std::to_string(*n) + " is not known here", {}};
    if (words.size() == 1) {
        m_.refresh(now_);
        return {{}, std::to_string(m_.dictionary().integer(address).value_or(0))};
    }
    const auto v = words.size() == 3 && words[1] == "=" ? whole(words[2]) : std::nullopt;
    return v ? write(address, *v) : DirectAnswer{"write SYSVAR[n] = value", {}};
}

DirectAnswer Line::motion(const std::string& word, Values values) {
    const bool no_value = word == "CSTART" || word == "HOME";
    if (values.size() != (no_value ? 0u : 1u)) return {word + (no_value ? " takes no value" : " takes one value"), {}};
    const auto mode = [&](std::int64_t to) {
        (void)m_.dictionary().set(profile(0x6060), Value{to});
        m_.written(profile(0x6060), now_);
    };
    if (word == "VEL") return write(profile(0x6081), scaled(values[0], 0x607F));
    if (word == "ACC") return write(profile(0x6083), scaled(values[0], 0x60C5));
    if (word == "DEC") return write(profile(0x6084), scaled(values[0], 0x60C6));
    if (!axis().servo().powered()) return {"the axis is off: MOTOR ON first", {}};
    if (word == "POSA" || word == "POSR") {
        control(0x0F);
        mode(1);
        (void)m_.dictionary().set(profile(0x607A), Value{values[0]});
        control(word == "POSR" ? 0x7F : 0x3F);
        if (axis().servo().takes_orders()) control(0x0F);
        return done();
    }
    if (word == "CVEL") {
        (void)m_.dictionary().set(profile(0x60FF), Value{scaled(values[0], 0x607F)});
        m_.written(profile(0x60FF), now_);
        return done();
    }
    if (word == "CSTART") {
        control(0x0F);
        mode(3);
        return done();
    }
    control(0x0F);
    const auto method = axis().of(0x6098);
    axis().put(0x6098, 0, -1);
    mode(6);
    control(0x1F);
    axis().put(0x6098, 0, static_cast<double>(method));
    return done();
}

DirectAnswer Line::synchronise(const std::string& word) {
    const SyncMode mode = word == "SYNCV" ? SyncMode::velocity : word == "SYNCP" ? SyncMode::position : SyncMode::marker;
    std::string fault = m_.coupling().synchronise(axis_, mode, now_);
    m_.begin_ticks(now_);
    return {std::move(fault), {}};
}

DirectAnswer Line::ask(const std::string& word) {
    m_.refresh(now_);
    if (word == "APOS") return {{}, std::to_string(axis().of(0x6064))};
    if (word == "CPOS") return {{}, std::to_string(axis().of(0x6062))};
    const Synchronisation& s = m_.coupling().of(axis_);
    if (word == "SYNCERR") return {{}, std::to_string(std::llround(axis().servo().units().way_in_units(s.error())))};
    if (word == "MAPOS") {  // MU: qc * SYNCFACTS / SYNCFACTM if MENCODER is negative [L3300]
        const auto qc = m_.coupling().master(axis_, now_);
        const bool units = axis().value("MENCODER") < 0;
        return {{}, std::to_string(units ? qc * axis().value("SYNCFACTS") / axis().value("SYNCFACTM") : qc)};
    }
    std::string flags;
    const SyncStatus& f = s.status();
    for (const auto& [on, name] : {std::pair{f.accuracy, "ACCURACY"},
                                   {f.ready, "READY"},
                                   {f.fault, "FAULT"},
                                   {f.master_window, "MASTER_WINDOW"},
                                   {f.slave_window, "SLAVE_WINDOW"}})
        if (on) flags += (flags.empty() ? "" : " ") + std::string(name);
    return {{}, flags.empty() ? "none" : flags};
}

/// `x(2)` selects the axis and is removed from the statement.
DirectAnswer Line::take_axis(std::vector<std::string>& words) {
    for (const std::string& w : words) {
        if (!w.starts_with("x(")) continue;
        const auto n = w.ends_with(")") ? whole(std::string_view(w).substr(2, w.size() - 3)) : std::nullopt;
        if (!n || *n < 1 || *n > axes) return {"there is no axis " + w + ": x(1) to x(" + std::to_string(axes) + ")", {}};
        axis_ = static_cast<int>(*n) - 1;
    }
    std::erase_if(words, [](const std::string& w) { return w.starts_with("x("); });
    return {};
}

DirectAnswer Line::motor(const std::string& what) {
    if (what == "ON") {
        for (const int cw : {0x06, 0x07, 0x0F})
            control(cw);
        return done();
    }
    if (what == "OFF") return control(0x00), DirectAnswer{};
    if (what == "STOP") return control(0x10F), done();
    return {"write MOTOR ON, OFF or STOP", {}};
}

DirectAnswer Line::output(Values values) {
    if (values.size() != 2) return {"write OUT n v", {}};
    if (values[0] < 1 || values[0] > 8) return {"outputs are 1 to 8", {}};
    return m_.terminals().set(values[0], values[1] != 0), DirectAnswer{};
}

DirectAnswer Line::virtual_master(const std::string& word, Values values) {
    if (values.size() != 1) return {"write " + word + " v", {}};
    auto& master = m_.coupling().virtual_master();
    if (word == "PULSACC" && values[0] < 0) return {"PULSACC -1 (input by DDS) is not supported", {}};
    if (word == "PULSACC") {
        master.accelerate(values[0]);
    } else {
        master.run(values[0], virtual_master_of(axis().value("VMENCTYP")).value_or(VirtualMasterCode{}));
    }
    return m_.begin_ticks(now_), DirectAnswer{};
}

DirectAnswer Line::define_origin(const std::string& word) {
    const bool of_master = word == "DEFMORIGIN";
    const auto code = encoder_of(axis().value(of_master ? "MENCODERTYPE" : "ENCODERTYPE"), of_master).value_or(EncoderCode{});
    if (code.absolute()) return {word + " is not for absolute encoders", {}};
    if (of_master) {
        m_.coupling().define_master_origin(axis_, now_);
    } else {
        m_.coupling().define_origin(axis_, now_);
    }
    return {};
}

DirectAnswer Line::run(std::vector<std::string> words) {
    if (DirectAnswer no = take_axis(words); !no.fault.empty()) return no;
    if (words.empty()) return {"write a statement", {}};
    const std::string& word = words[0];
    if (word == "SET") return set(words);
    if (word.starts_with("SYSVAR[")) return system_variable(words);
    if (word == "GET") {
        m_.refresh(now_);
        const Row* row = words.size() == 2 ? m_.objects().named(words[1], axis_) : nullptr;
        return row ? DirectAnswer{{}, std::to_string(axis().value(words[1]))} : DirectAnswer{"write GET NAME [x(n)] of a parameter", {}};
    }
    if (word == "MOTOR") return motor(words.size() == 2 ? words[1] : "");
    std::vector<std::int64_t> values;
    for (std::size_t i = 1; i < words.size(); ++i) {
        const auto v = whole(words[i]);
        if (!v) return {"'" + words[i] + "' is no whole number", {}};
        values.push_back(*v);
    }
    const auto among = [&](std::initializer_list<std::string_view> names) { return std::ranges::find(names, word) != names.end(); };
    if (among({"POSA", "POSR", "CVEL", "CSTART", "VEL", "ACC", "DEC", "HOME"})) return motion(word, values);
    if (word == "OUTDA") {
        if (values.size() != 1) return {"write OUTDA [x(n)] v", {}};
        return m_.bus().outda(axis_, values[0]) ? DirectAnswer{}
                                                : DirectAnswer{"the controller keeps the control word itself: DRIVETYPE +/-100", {}};
    }
    if (word == "CANDEL" && values.size() == 1 && values[0] == -1) return m_.bus().candel_all(), DirectAnswer{};
    if (word == "CANINI" && values.empty()) return m_.bus().canini(), DirectAnswer{};
    if (word == "OUT") return output(values);
    if (among({"PULSACC", "PULSVEL"})) return virtual_master(word, values);
    if (!values.empty()) return {"'" + word + "' with a value is not supported", {}};
    if (among({"SYNCV", "SYNCP", "SYNCM"})) return synchronise(word);
    if (among({"APOS", "CPOS", "MAPOS", "SYNCERR", "SYNCSTAT"})) return ask(word);
    if (word == "SAVEPROM") return write({0x1010, 1}, 0x65766173);
    if (word == "ERRCLR") {
        for (int k = 1; k <= axes; ++k)
            if (m_.axis(k).servo().state() == cia402_drive::twin::State::fault) m_.axis(k).clear_error(now_);
        return {};
    }
    if (among({"DEFORIGIN", "DEFMORIGIN"})) return define_origin(word);
    return {"'" + word + "' is not supported in direct mode here", {}};
}
}  // namespace

DirectAnswer direct(Macs& macs, std::string_view line, Instant now) {
    if (line.size() > longest) return {"a statement has at most " + std::to_string(longest) + " characters", {}};
    return Line(macs, now).run(words_of(line));
}

}  // namespace axisgate::aposs
