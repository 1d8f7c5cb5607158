// One cell of a rehearsal in virtual time: a client sets one axis in motion over the door of the cause, the selected disturbances follow,
// and the client is taken away. The result has figures, or the reason why there are none. The virtual time is bounded.
#include "gateway/engine/rehearsal.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "gateway/engine/rehearsal_models.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

/// The period in which a controller writes its registers, and a client its set-points.
constexpr Duration cycle = 20ms;
/// A gateway that is found dead is started at once, so the axis has no time to end its motion by itself.
constexpr Duration at_once = 300ms;
/// Smaller movements, in increments, are the settling of a shaft.
constexpr double settling = 3;

AxisSpec as_wished(const Site& site, const RehearsalWish& wish) {
    AxisSpec a = *std::ranges::find(site.axes, wish.axis, &AxisSpec::name);
    if (wish.cause == LossCause::lease_ended) a.authority_mode = AuthorityMode::lease;
    return a;
}

class Stage {
public:
    Stage(const Families& families, const Site& site, const SiteMemory& memory, const RehearsalWish& wish)
        : wish_(wish), models_(families, site, memory, as_wished(site, wish), {wish.watchdog, wish.lease}), spec_(models_.spec()) {
        models_.tend = [this] { tend(); };
        models_.on_axis_event = [this](const Event& e, Instant at) { note(e, at); };
    }

    RehearsalCell play() {
        cell_.axis = spec_.name;
        cell_.cause = wish_.cause;
        cell_.restart = wish_.restart;
        if (!gateway_gone()) cell_.chosen = spec_.fail_safe.of(rule());
        cell_.fault = set_off();
        if (!cell_.fault.empty()) return cell_;
        disturb();
        lose();
        watch();
        judge();
        come_back();
        return cell_;
    }

private:
    // --- the scenario
    [[nodiscard]] bool gateway_gone() const { return wish_.cause == LossCause::none && !wish_.restart; }
    /// The gateway is killed, and another one finds the axis in motion.
    [[nodiscard]] bool restarts() const { return wish_.restart || wish_.cause == LossCause::motion_unowned; }
    [[nodiscard]] Duration without_gateway() const { return wish_.restart ? wish_.gateway_away : at_once; }
    /// The cause whose action in the site applies.
    [[nodiscard]] LossCause rule() const { return wish_.restart ? LossCause::motion_unowned : wish_.cause; }
    [[nodiscard]] bool silent() const { return is_silence(wish_.cause); }
    [[nodiscard]] bool has(RehearsalStep step) const { return wish_.steps.has(step); }
    /// The loss does not concern the controller itself, which is present all the time.
    [[nodiscard]] bool client_stays() const {
        return wish_.cause == LossCause::line_lost || wish_.cause == LossCause::gateway_ends || restarts() || gateway_gone();
    }
    /// The way by which the client sets the axis in motion; for a cause that concerns every door, that of a controller.
    [[nodiscard]] static const WayIn& way_of(LossCause cause) {
        static constexpr WayIn by_name{};
        const bool anybodys = cause == LossCause::none || std::ranges::find(losses_of_anybody, cause) != losses_of_anybody.end();
        for (const DoorWords* door : known_doors()) {
            for (const WayIn& way : door->ways) {
                if (anybodys ? way.by_registers : tells(way, cause)) return way;
            }
        }
        return by_name;
    }
    /// True for clients that write registers, like controllers; other clients send commands by name.
    [[nodiscard]] bool by_registers() const { return way_.by_registers; }
    [[nodiscard]] Origin origin() const { return {way_.door, who_, {}}; }

    // --- clients
    void tend() {
        if (!tends_ || models_.now() < next_cycle_) return;
        next_cycle_ = models_.now() + cycle;
        if (!by_registers()) return stream();
        if (models_.has_gateway()) models_.say(image_, origin());
    }
    void stream() {
        const bool by_speed = models_.engine().catalogue(models_.axis())->offers_mode(9);
        SetPoint p;
        p.axis = models_.axis();
        p.mode = by_speed ? SetPoint::Mode::velocity : SetPoint::Mode::position;
        p.value = by_speed ? fast_ : place_ + fast_ / 50;
        if (!by_speed) p.velocity = 2 * fast_;
        p.acceleration = p.deceleration = ramp_;
        p.at = models_.now();
        p.origin = origin();
        const auto refused = models_.engine().on_set_point(p, models_.now());
        stream_fault_ = refused ? refused->text : "";
        if (!refused) place_ = p.value;
    }
    /// Empty if the drive has accepted it; otherwise the answer.
    std::string order(CommandBody body) {
        const std::string what(name_of(body));
        const auto r = models_.ask(std::move(body), origin(), 10s);
        if (!r) return what + ": no answer";
        refused_for_ = r->reason;
        return good(*r) ? "" : fmt::format("{}: {}", what, r->text);
    }

    // --- the motion
    // Brings the axis up, enables it and starts the motion. Empty, or the reason why this is impossible.
    std::string set_off() {
        if (!models_.run_until([&] { return models_.online(); }, 60s)) return "its twin does not come up";
        models_.run_for(500ms);
        if ((models_.picture().flags & flag_fault) != 0) {
            if (auto fault = order(ResetFault{}); !fault.empty()) return fault;
            models_.run_for(500ms);
        }
        const double per_unit = spec_.increments_per_unit;
        const auto counts = [&](const std::optional<double>& most, double otherwise) {
            return static_cast<std::int64_t>(std::clamp(most ? *most * per_unit : otherwise, 1.0, 2e9));
        };
        fast_ = counts(spec_.velocity_max, 4000);
        ramp_ = counts(spec_.acceleration_max, 5 * static_cast<double>(fast_));
        if (auto fault = enable(); !fault.empty()) return fault;
        if (auto fault = begin(); !fault.empty()) return fault;
        return models_.speed() > 0 ? "" : "it does not move";
    }
    std::string enable() {
        image_.profile_velocity = static_cast<std::uint32_t>(fast_);
        image_.profile_acceleration = image_.profile_deceleration = static_cast<std::uint32_t>(ramp_);
        if (by_registers()) {
            for (const int word : {0x06, 0x07, 0x0F}) {
                image_.controlword = static_cast<std::uint16_t>(word);
                if (auto fault = order(image_); !fault.empty()) return fault;
            }
        } else if (auto fault = order(Enable{}); !fault.empty()) {
            return fault;
        }
        return models_.run_until([&] { return power_state_of(models_.picture().statusword) == PowerState::operation_enabled; }, 10s)
                   ? ""
                   : "it is not enabled";
    }
    std::string begin() {
        if (of_streams_alone(wish_.cause)) {
            cell_.motion = "set_points";
            place_ = models_.picture().position;
            stream();
            if (!stream_fault_.empty()) return "set-points: " + stream_fault_;
            tends_ = true;
            models_.run_for(2s);
            return stream_fault_.empty() ? "" : "set-points: " + stream_fault_;
        }
        const AtLoss runs{true, true, true};
        const bool goes_on = !gateway_gone() && spec_.fail_safe.action(rule(), runs) == FailSafeAction::nothing;
        cell_.motion = "velocity";
        std::string fault = goes_on ? "" : move_velocity();
        if (goes_on || (!fault.empty() && refused_for_ == Reason::not_supported)) {
            cell_.motion = "position";
            fault = move_by(std::min<std::int64_t>(fast_ * (goes_on ? 5 : 60), INT32_MAX));
        }
        if (!fault.empty()) return fault;
        tends_ = by_registers();
        (void)models_.run_until([&] { return models_.speed() >= 0.95 * static_cast<double>(fast_); }, 3s);
        models_.run_for(200ms);
        return "";
    }
    std::string move_velocity() {
        if (by_registers()) {
            image_.mode = cia402::mode_profile_velocity;
            image_.target_velocity = static_cast<std::int32_t>(fast_);
            return order(image_);
        }
        return order(move(Move::Kind::velocity, fast_));
    }
    std::string move_by(std::int64_t distance) {
        distance_ = distance;
        begun_at_ = models_.mechanics().position;
        if (by_registers()) {
            image_.mode = cia402::mode_profile_position;
            image_.target_velocity.reset();
            image_.target_position = static_cast<std::int32_t>(distance);
            image_.controlword = 0x0F;
            if (auto fault = order(image_); !fault.empty()) return fault;
            image_.controlword = 0x5F;  // relative, new set-point
            return order(image_);
        }
        Move m = move(Move::Kind::relative, distance);
        m.velocity = fast_;
        return order(m);
    }
    [[nodiscard]] Move move(Move::Kind kind, std::int64_t target) const {
        Move m;
        m.kind = kind;
        m.target = target;
        m.acceleration = m.deceleration = ramp_;
        return m;
    }

    // --- the disturbances
    void disturb() {
        if (has(RehearsalStep::second_client)) {
            second_client_speaks();
            note_disturbed(RehearsalStep::second_client);
        }
        if (has(RehearsalStep::refused_commands)) {
            are_refused(origin());
            note_disturbed(RehearsalStep::refused_commands);
        }
    }
    /// Actions of a client without a part in the motion: a question, a reset, commands that are refused, and the end of its connection.
    void second_client_speaks() {
        const WayIn& way = way_of(LossCause::none);
        const Origin other{way.door, other_, {}};
        const auto parameters = models_.engine().catalogue(models_.axis())->parameters();
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            if (!parameters[i].readable()) continue;
            (void)models_.ask(ReadParameter{{static_cast<std::uint16_t>(i), parameters[i].count ? parameters[i].first : std::uint16_t{0}}},
                              other, 2s);
            break;
        }
        (void)models_.ask(ResetFault{}, other, 2s);
        are_refused(other);
        if (!way.losses.empty()) models_.engine().on_client_lost(AuthorityClient::of(other), way.losses.front(), models_.now());
    }
    /// Each of these commands requests another motion, and each is refused.
    void are_refused(const Origin& by) {
        Move renewal = move(Move::Kind::velocity, fast_ / 2 + 1);
        renewal.hold_ms = 500;
        renewal.renew_only = true;
        const Move beyond = move(Move::Kind::absolute, std::int64_t{INT32_MAX} + 1);
        constexpr std::int16_t no_such_method = 127;
        for (const CommandBody& body : {CommandBody{renewal}, CommandBody{beyond}, CommandBody{Home{no_such_method}}}) {
            const auto r = models_.ask(body, by, 2s);
            if (r && good(*r)) taken_ = true;
        }
    }
    void note_disturbed(RehearsalStep step) {
        models_.run_for(300ms);
        const bool slower = models_.speed() < 0.9 * static_cast<double>(fast_);
        if (cell_.ended_by.empty() && (slower || taken_)) cell_.ended_by = name_of(step);
    }

    // --- the loss
    void lose() {
        if (wish_.cause == LossCause::lease_ended) {  // the same motion again would disturb it; a renewed lease does not
            HoldAxis again;
            again.lease_s = std::max<std::int64_t>(1, std::chrono::duration_cast<std::chrono::seconds>(wish_.lease).count());
            (void)order(again);
        }
        tends_ = client_stays() && by_registers() && has(RehearsalStep::old_image);
        if (of_streams_alone(wish_.cause)) stream();
        at_ = models_.now();
        lost_ = true;
        if (silent()) models_.silent_since = at_;  // the connection stays open; for the other causes there is none
        place_at_loss_ = models_.mechanics().position;
        speed_at_loss_ = models_.speed();
        cell_.speed = speed_at_loss_ / spec_.increments_per_unit;
        if (silent()) return;  // nothing more comes
        switch (wish_.cause) {
            case LossCause::lease_ended:
            case LossCause::set_points_silent:
                return;  // the client sends nothing more
            case LossCause::line_lost:
                return models_.silence(true);
            case LossCause::gateway_ends:
                return models_.engine().shut_down(at_);
            case LossCause::none:
            case LossCause::motion_unowned:
                return models_.kill_gateway();
            default:
                models_.engine().on_client_lost(AuthorityClient::of(origin()), wish_.cause, at_);
        }
    }

    [[nodiscard]] Duration until_noticed() const {
        if (wish_.cause == LossCause::lease_ended) return wish_.lease;
        if (silent()) return spec_.fail_safe.watchdog(wish_.watchdog);
        if (wish_.cause == LossCause::line_lost) return wish_.line_away + 10s;
        return restarts() ? without_gateway() + 10s : Duration::zero();
    }
    void watch() {
        const Instant end = at_ + until_noticed() + 15s;
        const bool line_lost = wish_.cause == LossCause::line_lost;
        bool away = line_lost || restarts();
        while (models_.now() < end) {
            if (away && models_.now() - at_ >= (line_lost ? wish_.line_away : without_gateway())) {
                if (line_lost) {
                    models_.silence(false);
                } else {
                    models_.start_gateway();
                }
                away = false;
            }
            const double v = models_.speed();
            if (!slower_ && v < 0.9 * speed_at_loss_) slower_ = models_.now();
            if (v > 0) still_.reset();
            if (v == 0 && !still_) still_ = models_.now();
            if (still_ && !away && models_.now() - *still_ > 100ms) break;
            models_.step();
        }
        const auto ms = [&](Instant t) { return static_cast<double>((t - at_).count()) / 1e6; };
        if (acted_) {
            const AtLoss runs{true, true, true};
            cell_.taken = spec_.fail_safe.action(acted_for_, runs);
            cell_.noticed_ms = ms(*acted_);
        }
        if (slower_) cell_.reaction_ms = ms(*slower_);
        if (still_) cell_.standstill_ms = ms(*still_);
        cell_.watched_ms = ms(models_.now());
        cell_.travel = std::fabs(models_.mechanics().position - place_at_loss_) / spec_.increments_per_unit;
    }
    /// Observes the gateway's reaction after the loss: the first event that stops the axis is the end of the motion.
    void note(const Event& e, Instant at) {
        if (!lost_) return;
        const bool by_supervisor = e.kind == "limit" || (e.severity == Severity::alarm && (e.kind == "state" || e.kind == "motion"));
        if (e.kind != "fail_safe" && !by_supervisor) return;
        if (e.kind == "fail_safe" && !acted_) {
            acted_ = at;
            acted_for_ = static_cast<LossCause>(e.code);
        }
        if (!stopped_) {
            stopped_ = at;
            stopped_by_ = by_supervisor ? std::string_view("supervisor") : name_of(static_cast<LossCause>(e.code));
        }
    }
    void judge() {
        if (!cell_.ended_by.empty() || !still_) return;
        // If the motor became slower before anybody acted, or nobody has stopped it, the motor has ended the motion by itself.
        if (stopped_ && (!slower_ || *stopped_ <= *slower_)) {
            cell_.ended_by = stopped_by_;
        } else {
            cell_.ended_by = arrived() ? "target" : "drive";
        }
    }
    [[nodiscard]] bool arrived() {
        if (cell_.motion != "position") return false;
        const double gone = std::fabs(models_.mechanics().position - begun_at_), wanted = static_cast<double>(distance_);
        return gone >= wanted - std::max(settling, wanted / 1000);
    }

    // --- afterwards
    // The controller has returned, or was never away, and writes the same registers as before the loss, because it has noticed nothing.
    void come_back() {
        if (!has(RehearsalStep::old_image) || !by_registers() || gateway_gone() || !still_) return;
        const double place = models_.mechanics().position;
        if (wish_.cause == LossCause::gateway_ends) {
            models_.kill_gateway();
            models_.run_for(1s);
            models_.start_gateway();
        }
        models_.silent_since.reset();
        tends_ = true;
        (void)models_.run_until([&] { return models_.online(); }, 20s);
        models_.run_for(2s);
        cell_.moved_again = std::fabs(models_.mechanics().position - place) > settling;
    }

    RehearsalWish wish_;
    const WayIn& way_ = way_of(wish_.cause);
    RehearsalModels models_;
    const AxisSpec& spec_;
    RehearsalCell cell_;
    const std::shared_ptr<const std::string> who_ = std::make_shared<const std::string>("rehearsal:1");
    const std::shared_ptr<const std::string> other_ = std::make_shared<const std::string>("another:1");
    ProcessData image_;  ///< the whole image that the controller writes in every cycle
    bool tends_ = false;
    Instant next_cycle_{};
    Instant at_{};
    bool lost_ = false, taken_ = false;
    std::optional<Instant> acted_, stopped_, slower_, still_;
    LossCause acted_for_ = LossCause::none;
    std::string_view stopped_by_;
    Reason refused_for_ = Reason::none;
    std::string stream_fault_;
    std::int64_t fast_ = 0, ramp_ = 0, place_ = 0, distance_ = 0;
    double place_at_loss_ = 0, speed_at_loss_ = 0, begun_at_ = 0;
};
}  // namespace

RehearsalCell rehearse(const Families& families, const Site& site, const SiteMemory& memory, const RehearsalWish& wish) {
    const auto axis = std::ranges::find(site.axes, wish.axis, &AxisSpec::name);
    if (axis == site.axes.end()) {
        RehearsalCell none;
        none.axis = wish.axis;
        none.cause = wish.cause;
        none.restart = wish.restart;
        none.fault = "there is no such axis";
        return none;
    }
    return Stage(families, site, memory, wish).play();
}

}  // namespace axisgate
