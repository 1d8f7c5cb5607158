// Requests are answered at once, at their own instant. Requests with a wrong checksum or for another axis are ignored, and all while the
// twin is silent or off. A specimen answers motions late, shows states of some time ago or unasked, and restarts once.
#include "adapters/remote/twin/twin.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include "adapters/remote/twin/axis.hpp"

namespace axisgate::remote::twin {
using mirror::Telegram;
namespace {

class RemoteTwin final : public Twin {
public:
    explicit RemoteTwin(const TwinSetup& setup)
        : address_(setup.address),
          axis_(setup.freedoms, setup.seed),
          sample_(ms(setup, "sample_ms")),
          result_late_(ms(setup, "result_late_ms")),
          unasked_(ms(setup, "unasked_ms")),
          restart_after_(ms(setup, "restart_after_ms")),
          restart_(ms(setup, "restart_ms", 3000)),
          restart_told_(freedom(setup.freedoms, "restart_told", 1) != 0),
          reads_(freedom(setup.freedoms, "reads", 1) != 0) {}

    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (f.kind != Frame::Kind::bytes) return;
        on_deadline(now, out);
        framer_.push({reinterpret_cast<const char*>(f.data().data()), f.size}, [&](std::string_view line) {
            const auto t = mirror::telegram_of(line);
            if (t && t->kind == Telegram::Kind::request && t->address == address_ && powered_) take(*t, now, out);
        });
    }
    void on_deadline(Instant now, Out& out) override {
        for (Instant at = deadline(); at <= now; at = deadline()) {
            if (restart_at_ <= at) {
                keep_sample(at);
                (void)axis_.order({.verb = "halt"}, at);  // a gateway stops its axes before it ends
                late_.clear();
                restart_at_ = never;
                back_at_ = at + restart_;
            } else if (!late_.empty() && late_.front().first <= at) {
                const Telegram t = std::move(late_.front().second);
                late_.pop_front();
                say(t, at, out);
            } else {
                if (!away(at) && !gone_) say({Telegram::Kind::state, 0, address_, body_of(state(at))}, at, out);
                unasked_at_ += unasked_;
            }
        }
    }
    [[nodiscard]] Instant deadline() const override {
        return std::min({restart_at_, unasked_at_, late_.empty() ? never : late_.front().first});
    }

    void power_on(const NonVolatile&, Instant now, Out&) override {
        if (restart_after_ != Duration::zero()) restart_at_ = now + restart_after_;
        set_power(true, now);
    }
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
        keep_sample(now);
        if (name == "power") {
            if (!on) axis_.power_off(now);
            set_power(on, now);
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
    static constexpr std::size_t most_late = 64;  ///< answers that wait; further ones are sent at once

    static Duration ms(const TwinSetup& setup, std::string_view name, std::int64_t fallback = 0) {
        return std::chrono::milliseconds(freedom(setup.freedoms, name, fallback));
    }
    void set_power(bool on, Instant now) {
        if (!on) late_.clear();
        if (!on || !powered_) unasked_at_ = on && unasked_ != Duration::zero() ? now + unasked_ : never;
        powered_ = on;
    }
    [[nodiscard]] bool away(Instant now) const { return now < back_at_; }
    /// The state as it was when the other gateway last sampled its axis. To be called before the axis changes.
    void keep_sample(Instant now) {
        if (sample_ == Duration::zero()) return;
        const Instant at = time_zero + (now - time_zero) / sample_ * sample_;
        if (at <= sampled_at_) return;
        Axis then = axis_;
        then.advance(at);
        sampled_ = then.state(at);
        sampled_at_ = at;
    }
    [[nodiscard]] mirror::State state(Instant now) {
        keep_sample(now);
        axis_.advance(now);
        if (sample_ == Duration::zero()) return axis_.state(now);
        mirror::State s = sampled_;
        s.age_ms = milliseconds_of(now - sampled_at_);
        return s;
    }
    void take(const Telegram& request, Instant now, Out& out) {
        const auto order = mirror::order_of(request.body);
        if (!order || (away(now) && !restart_told_)) return;
        keep_sample(now);
        axis_.advance(now);
        if (gone_ || away(now)) return say({Telegram::Kind::gone, request.number, address_, "the gateway is gone"}, now, out);
        if (order->verb == "state") return say({Telegram::Kind::state, request.number, address_, body_of(state(now))}, now, out);
        const bool motion = order->verb.starts_with("move_") || order->verb == "home";
        const Telegram answer{Telegram::Kind::answer, request.number, address_,
                              body_of(order->verb == "read" ? read(order->name, now) : axis_.order(*order, now))};
        if (!motion || result_late_ == Duration::zero() || late_.size() >= most_late) return say(answer, now, out);
        late_.emplace_back(now + result_late_, answer);
    }
    [[nodiscard]] mirror::Answer read(const std::string& name, Instant now) {
        if (!reads_) return {Outcome::refused, Reason::not_supported, 0, "this gateway does not give values of its axes"};
        const mirror::State s = state(now);
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
            {"AGE", number(s.age_ms)},
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
    // The specimen.
    Duration sample_, result_late_, unasked_, restart_after_, restart_;
    bool restart_told_, reads_;
    mirror::State sampled_;
    Instant sampled_at_ = Instant::min(), restart_at_ = never, back_at_{}, unasked_at_ = never;
    std::deque<std::pair<Instant, Telegram>> late_;  ///< in order of time
    bool powered_ = false, silent_ = false, gone_ = false, stalled_ = false;
};

}  // namespace

std::unique_ptr<Twin> make_twin(const TwinSetup& setup) { return std::make_unique<RemoteTwin>(setup); }

}  // namespace axisgate::remote::twin
