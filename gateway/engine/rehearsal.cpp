// Rehearsal: a world of twins in virtual time, one axis set in motion by a client of the cause's door, and that client taken away.
// In: a wish. Out: a cell with figures, or with the reason why there are none. Never runs for longer than its bounds of virtual time.
#include "gateway/engine/rehearsal.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "gateway/site/ways_in.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

/// Where a real line would be: nobody is there, and nobody is asked for.
class NoLine final : public Line {
public:
    void open(LineEvents&, Instant) override {}
    void close() override {}
    bool send(const Frame&, Priority, Instant) override { return false; }
    [[nodiscard]] Instant deadline() const override { return never; }
    void on_deadline(Instant) override {}
    [[nodiscard]] LineStatus status(Instant) const override { return {}; }
};

/// The axis' line with all of its drives, each by its twin. Limits of position are left out: they would end the motion first.
Site only_its_line(const Site& site, const AxisSpec& axis) {
    Site s;
    const auto drive = std::ranges::find(site.drives, axis.drive, &DriveSpec::name);
    for (const auto& l : site.lines) {
        if (l.name == drive->line) s.lines.push_back(l);
    }
    for (const auto& d : site.drives) {
        if (d.line != drive->line) continue;
        s.drives.push_back(d);
        s.drives.back().presence = PresenceRule::twin;
    }
    for (const auto& a : site.axes) {
        if (std::ranges::find(s.drives, a.drive, &DriveSpec::name) == s.drives.end()) continue;
        s.axes.push_back(a);
        s.axes.back().position_min = s.axes.back().position_max = std::nullopt;
    }
    return s;
}

class Stage final : public EngineHost {
public:
    Stage(const Families& families, const Site& site, const SiteMemory& memory, const RehearsalWish& wish)
        : wish_(wish), spec_(*std::ranges::find(site.axes, wish.axis, &AxisSpec::name)), engine_(families, *this, image_, 16) {
        engine_.set_watchdog(wish.watchdog);
        engine_.set_lease(wish.lease);
        Site small = only_its_line(site, spec_);
        if (wish.cause == LossCause::lease_ended)
            std::ranges::find(small.axes, wish.axis, &AxisSpec::name)->authority_mode = AuthorityMode::lease;
        const auto at = std::ranges::find(small.axes, wish.axis, &AxisSpec::name) - small.axes.begin();
        const auto drive_at = std::ranges::find(small.drives, spec_.drive, &DriveSpec::name) - small.drives.begin();
        const auto state = engine_.apply_site(std::move(small), memory, 1, now_);
        axis_ = state->axis_ids.at(static_cast<std::size_t>(at));
        drive_ = state->drive_ids.at(static_cast<std::size_t>(drive_at));
    }

    RehearsalCell play() {
        cell_.axis = spec_.name;
        cell_.cause = wish_.cause;
        if (!gateway_gone()) cell_.chosen = spec_.fail_safe.of(wish_.cause);
        cell_.fault = set_off();
        if (!cell_.fault.empty()) return cell_;
        lose();
        watch();
        return cell_;
    }

    // --- EngineHost
    std::unique_ptr<Line> make_line(const LineSpec&, const LineSetup&) override { return std::make_unique<NoLine>(); }
    void on_result(const Result& result) override { results_[result.ticket] = result; }
    void on_event(Event event, Instant at) override {
        if (event.kind == "fail_safe" && event.axis == spec_.name && !acted_) acted_ = at;
    }
    void on_sample(const Sample&) override {}
    void on_store(StoreOrder) override {}
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient&) const override { return lost_ ? received_ : now_; }
    void on_twin_memory(const std::string&, NonVolatile) override {}

private:
    [[nodiscard]] AxisPicture picture() const { return image_.picture(axis_); }
    [[nodiscard]] TwinMechanics mechanics() { return engine_.twin(drive_)->mechanics(spec_.channel, now_); }
    [[nodiscard]] double speed() { return std::fabs(mechanics().velocity); }
    [[nodiscard]] Door door() const { return door_that_tells(wish_.cause); }
    [[nodiscard]] Origin origin() const { return {door(), who_, {}}; }

    [[nodiscard]] bool silent() const { return wish_.cause == LossCause::modbus_silent || wish_.cause == LossCause::enip_silent; }
    [[nodiscard]] bool gateway_gone() const { return wish_.cause == LossCause::none; }

    void step() {
        if (lost_ && gateway_gone()) return step_alone();
        now_ = std::clamp(engine_.deadline(), now_ + 10us, now_ + 1ms);
        engine_.on_deadline(now_);
    }
    /// The drive with nobody who speaks to it; what it says is heard by nobody.
    void step_alone() {
        Twin& twin = *engine_.twin(drive_);
        now_ = std::clamp(twin.deadline(), now_ + 10us, now_ + 1ms);
        Out unreceived;
        if (twin.deadline() <= now_) twin.on_deadline(now_, unreceived);
    }
    void run_for(Duration time) {
        for (const Instant end = now_ + time; now_ < end;)
            step();
    }
    template <class F>
    bool run_until(F&& true_now, Duration limit) {
        for (const Instant end = now_ + limit; !true_now();) {
            if (now_ >= end) return false;
            step();
        }
        return true;
    }
    /// Empty: taken by the drive; else what was answered.
    std::string order(CommandBody body) {
        Command c;
        c.ticket = make_ticket(1, ++tickets_);
        c.axis = axis_;
        c.origin = origin();
        const std::string what(name_of(body));
        c.body = std::move(body);
        const Ticket t = c.ticket;
        engine_.on_command(std::move(c), now_);
        if (!run_until([&] { return results_.contains(t); }, 10s)) return what + ": no answer";
        const Result r = results_.extract(t).mapped();
        refused_for_ = r.reason;
        return r.outcome == Outcome::accepted || r.outcome == Outcome::done ? "" : fmt::format("{}: {}", what, r.text);
    }
    void stream() {
        const bool by_speed = streams_velocity();
        SetPoint p;
        p.axis = axis_;
        p.mode = by_speed ? SetPoint::Mode::velocity : SetPoint::Mode::position;
        p.value = by_speed ? fast_ : place_ += fast_ / 50;
        if (!by_speed) p.velocity = 2 * fast_;
        p.acceleration = p.deceleration = ramp_;
        p.at = now_;
        p.origin = origin();
        const auto refused = engine_.on_set_point(p, now_);
        stream_fault_ = refused ? refused->text : "";
    }
    [[nodiscard]] bool streams_velocity() const { return engine_.catalogue(axis_)->offers_mode(9); }

    /// Brings the axis up, enables it and lets it run. Empty, or why that cannot be.
    std::string set_off() {
        if (!run_until([&] { return (picture().flags & flag_online) != 0 && picture().ever_seen; }, 60s))
            return "its twin does not come up";
        run_for(500ms);
        if ((picture().flags & flag_fault) != 0) {
            if (auto fault = order(ResetFault{}); !fault.empty()) return fault;
            run_for(500ms);
        }
        if (auto fault = order(Enable{}); !fault.empty()) return fault;
        if (!run_until([&] { return power_state_of(picture().statusword) == PowerState::operation_enabled; }, 10s))
            return "it is not enabled";
        const double per_unit = spec_.increments_per_unit;
        fast_ = spec_.velocity_max ? static_cast<std::int64_t>(*spec_.velocity_max * per_unit) : 4000;
        ramp_ = spec_.acceleration_max ? static_cast<std::int64_t>(*spec_.acceleration_max * per_unit) : 5 * fast_;
        fast_ = std::max<std::int64_t>(fast_, 1);
        ramp_ = std::max<std::int64_t>(ramp_, 1);
        const AtLoss runs{true, true, true};
        const bool goes_on = !gateway_gone() && spec_.fail_safe.action(wish_.cause, runs) == FailSafeAction::nothing;
        if (of_streams_alone(wish_.cause)) {
            cell_.motion = "set_points";
            place_ = picture().position;
            for (int i = 0; i < 100; ++i) {
                stream();
                if (!stream_fault_.empty()) return "set-points: " + stream_fault_;
                run_for(20ms);
            }
        } else {
            Move m;
            m.acceleration = m.deceleration = ramp_;
            m.kind = Move::Kind::velocity;
            m.target = fast_;
            cell_.motion = "velocity";
            std::string fault = goes_on ? "" : order(m);
            if (goes_on || (!fault.empty() && refused_for_ == Reason::not_supported)) {
                cell_.motion = "position";
                m.kind = Move::Kind::relative;
                m.target = fast_ * (goes_on ? 4 : 60);
                m.velocity = fast_;
                fault = order(m);
            }
            if (!fault.empty()) return fault;
            (void)run_until([&] { return speed() >= 0.95 * static_cast<double>(fast_); }, 3s);
            run_for(200ms);
        }
        return speed() > 0 ? "" : "it does not move";
    }

    void lose() {
        if (wish_.cause == LossCause::lease_ended) {  // the same motion again would disturb it; a lease that is renewed does not
            HoldAxis again;
            again.lease_s = std::max<std::int64_t>(1, std::chrono::duration_cast<std::chrono::seconds>(wish_.lease).count());
            (void)order(again);
        }
        if (of_streams_alone(wish_.cause)) stream();
        at_ = now_;
        lost_ = true;
        if (silent()) received_ = now_;  // the connection stays; else there is none
        place_at_loss_ = mechanics().position;
        speed_at_loss_ = speed();
        cell_.speed = speed_at_loss_ / spec_.increments_per_unit;
        const AuthorityClient who = AuthorityClient::of(origin());
        switch (wish_.cause) {
            case LossCause::modbus_silent:
            case LossCause::enip_silent:
            case LossCause::lease_ended:
            case LossCause::set_points_silent:
                return;  // nothing more comes
            case LossCause::line_lost:
                (void)engine_.set_hand(drive_, {{"silent", Value{true}}}, {}, now_);
                return;
            case LossCause::gateway_ends:
                return engine_.shut_down(now_);
            case LossCause::none:
                return;
            default:
                engine_.on_client_lost(who, wish_.cause, now_);
        }
    }

    void watch() {
        const Duration silence = wish_.cause == LossCause::lease_ended ? wish_.lease
                                 : silent()                            ? spec_.fail_safe.watchdog(wish_.watchdog)
                                 : wish_.cause == LossCause::line_lost ? wish_.line_away + 10s
                                                                       : Duration::zero();
        const Instant end = at_ + silence + 15s;
        bool back = wish_.cause != LossCause::line_lost;
        std::optional<Instant> slower, still;
        while (now_ < end) {
            if (!back && now_ - at_ >= wish_.line_away) {
                (void)engine_.set_hand(drive_, {{"silent", Value{false}}}, {}, now_);
                back = true;
            }
            const double v = speed();
            if (!slower && v < 0.9 * speed_at_loss_) slower = now_;
            if (v > 0) still.reset();
            if (v == 0 && !still) still = now_;
            if (still && back && now_ - *still > 100ms) break;
            step();
        }
        const auto ms = [&](Instant t) { return static_cast<double>((t - at_).count()) / 1e6; };
        if (acted_) {
            const AtLoss runs{true, true, true};
            cell_.taken = spec_.fail_safe.action(wish_.cause, runs);
            cell_.noticed_ms = ms(*acted_);
        }
        if (slower) cell_.reaction_ms = ms(*slower);
        if (still) cell_.standstill_ms = ms(*still);
        cell_.watched_ms = ms(now_);
        cell_.travel = std::fabs(mechanics().position - place_at_loss_) / spec_.increments_per_unit;
    }

    RehearsalWish wish_;
    AxisSpec spec_;
    Image image_;
    Engine engine_;
    RehearsalCell cell_;
    const std::shared_ptr<const std::string> who_ = std::make_shared<const std::string>("rehearsal:1");
    AxisId axis_ = no_axis;
    DriveId drive_ = no_drive;
    Instant now_ = at_ns(1'000'000'000), at_{};
    bool lost_ = false;
    std::optional<Instant> received_, acted_;
    std::map<Ticket, Result> results_;
    Reason refused_for_ = Reason::none;
    std::string stream_fault_;
    std::uint64_t tickets_ = 0;
    std::int64_t fast_ = 0, ramp_ = 0, place_ = 0;
    double place_at_loss_ = 0, speed_at_loss_ = 0;
};
}  // namespace

RehearsalCell rehearse(const Families& families, const Site& site, const SiteMemory& memory, const RehearsalWish& wish) {
    const auto axis = std::ranges::find(site.axes, wish.axis, &AxisSpec::name);
    if (axis == site.axes.end()) {
        RehearsalCell none;
        none.axis = wish.axis;
        none.cause = wish.cause;
        none.fault = "there is no such axis";
        return none;
    }
    return Stage(families, site, memory, wish).play();
}

}  // namespace axisgate
