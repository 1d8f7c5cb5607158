// Requests are answered at once, at their own instant. Requests with a wrong checksum or for another axis are ignored, and all while the
// twin is silent or off.
#include "adapters/remote/twin/twin.hpp"

#include <map>

#include "adapters/remote/twin/axis.hpp"

namespace axisgate::remote::twin {
using mirror::Telegram;
namespace {

class RemoteTwin final : public Twin {
public:
    explicit RemoteTwin(const TwinSetup& setup) : address_(setup.address) {}

    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (f.kind != Frame::Kind::bytes) return;
        framer_.push({reinterpret_cast<const char*>(f.data().data()), f.size}, [&](std::string_view line) {
            const auto t = mirror::telegram_of(line);
            if (t && t->kind == Telegram::Kind::request && t->address == address_ && powered_) take(*t, now, out);
        });
    }
    void on_deadline(Instant, Out&) override {}
    [[nodiscard]] Instant deadline() const override { return never; }

    void power_on(const NonVolatile&, Instant, Out&) override { powered_ = true; }
    [[nodiscard]] NonVolatile non_volatile() const override { return {}; }
    [[nodiscard]] bool fit_axes(int, Instant) override { return true; }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return 0; }

    [[nodiscard]] std::vector<HandItem> hand() const override {
        return {{"power", Value{powered_}, true, "supply of the other gateway and its drive"},
                {"silent", Value{silent_}, true, "it hears and does not answer"},
                {"gone", Value{gone_}, true, "the other gateway has left the fleet, and that is told"},
                {"stall", Value{stalled_}, true, "the shaft is held"},
                {"inject_error", Value{std::int64_t{0}}, true, "65535 a fault of the drive behind the other gateway; 0 clears"}};
    }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out&) override {
        const auto n = as_integer(value);
        if (!n || (*n != 0 && *n != (name == "inject_error" ? Axis::fault_code : 1)))
            return name + ": write true or false, or for inject_error 65535 or 0";
        const bool on = *n != 0;
        if (name == "power") {
            if (!on) axis_.power_off(now);
            powered_ = on;
        } else if (name == "silent") {
            silent_ = on;
        } else if (name == "gone") {
            gone_ = on;
        } else if (name == "stall") {
            axis_.hold(stalled_ = on, now);
        } else if (name == "inject_error") {
            axis_.fail(on, now);
        } else {
            return name + " is nothing that a hand can do here";
        }
        return {};
    }
    [[nodiscard]] TwinMechanics mechanics(int, Instant now) const override { return axis_.mechanics(now); }

private:
    void take(const Telegram& request, Instant now, Out& out) {
        const auto order = mirror::order_of(request.body);
        if (!order) return;
        axis_.advance(now);
        if (gone_) return say({Telegram::Kind::gone, request.number, address_, "the gateway is gone"}, now, out);
        if (order->verb == "state") return say({Telegram::Kind::state, request.number, address_, body_of(axis_.state(now))}, now, out);
        say({Telegram::Kind::answer, request.number, address_,
             body_of(order->verb == "read" ? read(order->name, now) : axis_.order(*order, now))},
            now, out);
    }
    [[nodiscard]] mirror::Answer read(const std::string& name, Instant now) const {
        const mirror::State s = axis_.state(now);
        const auto number = [](std::int64_t n) { return std::to_string(n); };
        const std::map<std::string, std::string> values{
            {"VERSION", "0"},
            {"FAMILY", "cia402"},
            {"NUMBER", "1"},
            {"UNIT", "mm"},
            {"INCREMENTS_PER_UNIT", "1000"},
            {"ONLINE", "1"},
            {"SIMULATED", "1"},
            {"STATUSWORD", number(s.statusword)},
            {"MODE", number(s.mode)},
            {"POSITION", number(s.position)},
            {"DEMAND", number(s.demand)},
            {"VELOCITY", number(s.velocity)},
            {"ERROR_CODE", number(s.error_code)},
            {"FAIL_SAFE_CAUSE", "0"},
            {"AGE", "0"},
            {"CLOCK_AHEAD", "0"},
            {"UPTIME", number(now.time_since_epoch() / std::chrono::seconds(1))},
            {"AUTHORITY", "none"},
            {"HOLDER", "-"},
        };
        const auto it = values.find(name);
        if (it == values.end()) return {Outcome::refused, Reason::unknown_point, 0, "there is no " + name};
        return {Outcome::done, Reason::none, 0, it->second};
    }
    void say(const Telegram& t, Instant now, Out& out) const {
        if (silent_) return;
        const std::string text = text_of(t);
        for_each_run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, [&](Frame f) {
            f.at = now;
            out.send(f);
        });
    }

    std::string address_;
    mirror::Framer framer_;
    Axis axis_;
    bool powered_ = false, silent_ = false, gone_ = false, stalled_ = false;
};

}  // namespace

std::unique_ptr<Twin> make_twin(const TwinSetup& setup) { return std::make_unique<RemoteTwin>(setup); }

}  // namespace axisgate::remote::twin
