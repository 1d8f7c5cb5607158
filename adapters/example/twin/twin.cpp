// Requests are answered at once, at their own instant. Requests with a wrong checksum or for another drive are ignored, and all while the
// twin is silent or off. A specimen may send the state of its first axis unasked.
#include "adapters/example/twin/twin.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "adapters/example/twin/axis.hpp"

namespace axisgate::example::twin {
namespace {

class ExampleTwin final : public Twin {
public:
    explicit ExampleTwin(const TwinSetup& setup)
        : address_(std::atoi(setup.address.c_str())), report_period_(std::chrono::milliseconds(freedom(setup.freedoms, "report_ms"))) {
        for (std::size_t a = 0; a < axes_.size(); ++a)
            axes_[a] = Axis(setup.freedoms, setup.seed + a);
    }

    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (f.kind != Frame::Kind::bytes) return;
        for (const std::uint8_t c : f.data()) {
            if (c == '@' || c == '#' || line_.size() > 63) line_.clear();
            line_ += static_cast<char>(c);
            if (c == '\r') take(now, out);
        }
    }
    void on_deadline(Instant now, Out& out) override {
        while (report_at_ <= now) {
            char address[4];
            std::snprintf(address, sizeof address, "%02d1", address_ % 100);
            if (!silent_) say("#" + std::string(address) + "S00=" + axes_[0].state(report_at_), report_at_, out);
            report_at_ += report_period_;
        }
    }
    [[nodiscard]] Instant deadline() const override { return report_at_; }

    void power_on(const NonVolatile& memory, Instant now, Out&) override {
        for (std::size_t a = 0; a < axes_.size(); ++a)
            for (std::size_t i = 0; i < Axis::settings; ++i) {
                const auto kept = memory.find(name_of(a, i));
                axes_[a].values[i] = kept == memory.end() ? Axis::factory[i] : as_integer(kept->second).value_or(Axis::factory[i]);
            }
        set_power(true, now);
    }
    [[nodiscard]] NonVolatile non_volatile() const override {
        NonVolatile m;
        for (std::size_t a = 0; a < axes_.size(); ++a)
            for (std::size_t i = 0; i < Axis::settings; ++i)
                if (axes_[a].values[i] != Axis::factory[i]) m[name_of(a, i)] = axes_[a].values[i];
        return m;
    }
    [[nodiscard]] bool fit_axes(int, Instant) override { return true; }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return revision_; }

    [[nodiscard]] std::vector<HandItem> hand() const override {
        return {{"power", Value{powered_}, true, "supply of the drive"},
                {"silent", Value{silent_}, true, "it hears and does not answer"},
                {"stall", Value{stalled_}, true, "every shaft is held"},
                {"inject_error", Value{std::int64_t{0}}, true, "1 over-current, 2 over-temperature, 3 following error; 0 clears"}};
    }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out&) override {
        const auto n = as_integer(value);
        if (!n || *n < 0 || *n > (name == "inject_error" ? 3 : 1)) return name + ": write true or false, or for inject_error 0 to 3";
        if (name == "silent") silent_ = *n != 0;
        if (name == "stall") stalled_ = *n != 0;
        for (Axis& a : axes_) {
            a.advance(now);
            if (name == "stall") a.hold(stalled_, now);
            if (name == "inject_error") a.fail(static_cast<int>(*n), now);
            if (name == "power" && *n == 0) a.power_off(now);
        }
        if (name == "power") set_power(*n != 0, now);
        return name == "silent" || name == "stall" || name == "inject_error" || name == "power"
                   ? ""
                   : name + " is nothing that a hand can do here";
    }
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override {
        Axis copy = axes_[static_cast<std::size_t>(channel) - 1];  // a query must not change the axis
        return copy.mechanics(now);
    }

private:
    void set_power(bool on, Instant now) {
        if (!on || !powered_) report_at_ = on && report_period_ != Duration::zero() ? now + report_period_ : never;
        powered_ = on;
    }
    static std::string name_of(std::size_t axis, std::size_t i) { return std::to_string(axis + 1) + ".R" + std::to_string(i + 6); }
    static std::string check(const std::string& s) {
        unsigned sum = 0;
        for (const unsigned char c : s)
            sum += c;
        constexpr const char* hex = "0123456789ABCDEF";
        return {'*', hex[sum >> 4 & 15], hex[sum & 15]};
    }
    /// @AAXINN?*HH or @AAXINN=value*HH.
    void take(Instant now, Out& out) {
        std::string s = std::exchange(line_, {});
        if (s.size() < 12 || s[0] != '@' || s.substr(s.size() - 4, 3) != check(s.substr(0, s.size() - 4))) return;
        s.resize(s.size() - 4);
        const std::size_t axis = static_cast<std::size_t>(s[3] - '1');
        if (!powered_ || std::atoi(s.substr(1, 2).c_str()) != address_ || axis >= axes_.size()) return;
        Axis& a = axes_[axis];
        const std::string item = s.substr(4, 3), text = s.substr(8);
        const int number = std::atoi(item.c_str() + 1);
        int refused = 11;
        std::string answer;
        if (item == "S00" && s[7] == '?') {
            answer = a.state(now);
            refused = 0;
        } else if (item[0] == 'R' && s[7] == '?') {
            std::int64_t v = 0;
            a.advance(now);
            refused = a.read(number, v);
            answer = std::to_string(v);
        } else if (item[0] == 'R' && s[7] == '=') {
            const auto before = a.values;
            char* end = nullptr;
            const long long v = std::strtoll(text.c_str(), &end, 10);
            refused = text.empty() || *end != 0 ? 12 : a.write(number, v, now);
            answer = text;
            if (a.values != before) ++revision_;
        }
        if (silent_) return;
        say("#" + s.substr(1, 6) + (refused ? "!" + std::to_string(refused) : "=" + answer), now, out);
    }
    static void say(std::string r, Instant now, Out& out) {
        r += check(r) + '\r';
        Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(r.data()), r.size()});
        f.at = now;
        out.send(f);
    }

    int address_;
    Duration report_period_;
    Instant report_at_ = never;
    std::string line_;
    std::array<Axis, 4> axes_;
    bool powered_ = false, silent_ = false, stalled_ = false;
    std::uint64_t revision_ = 0;
};

}  // namespace

std::unique_ptr<Twin> make_twin(const TwinSetup& setup) { return std::make_unique<ExampleTwin>(setup); }

}  // namespace axisgate::example::twin
