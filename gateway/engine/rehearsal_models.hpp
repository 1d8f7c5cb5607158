// One line of the site with all of its drives as models behind a cable, and a gateway at the other end, in virtual time. The gateway can be
// killed and another one started; the drives continue meanwhile. No real line is opened.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gateway/engine/engine.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate {

class RehearsalModels final : public EngineHost {
public:
    struct Times {
        Duration watchdog{}, lease{};
    };
    /// The first gateway exists and is about to begin. `site` contains the axis.
    RehearsalModels(const Families& families, const Site& site, const SiteMemory& memory, const AxisSpec& axis, Times times);
    ~RehearsalModels() override;
    RehearsalModels(const RehearsalModels&) = delete;
    RehearsalModels& operator=(const RehearsalModels&) = delete;

    void kill_gateway();
    void start_gateway();
    [[nodiscard]] bool has_gateway() const noexcept { return gateway_ != nullptr; }
    [[nodiscard]] Engine& engine() { return gateway_->engine; }
    [[nodiscard]] AxisPicture picture() const { return gateway_->image.picture(axis_id_); }
    [[nodiscard]] bool online() const;
    [[nodiscard]] AxisId axis() const noexcept { return axis_id_; }
    [[nodiscard]] const AxisSpec& spec() const noexcept { return spec_; }

    [[nodiscard]] Instant now() const noexcept { return now_; }
    [[nodiscard]] TwinMechanics mechanics() { return bus_->twin(drive_id_)->mechanics(spec_.channel, now_); }
    [[nodiscard]] double speed() { return std::fabs(mechanics().velocity); }
    /// The drive receives, and does not answer.
    void silence(bool on) { (void)bus_->set_hand(drive_id_, "silent", Value{on}, now_); }

    /// If set, it is called at every step of time: the actions of the clients.
    std::function<void()> tend;
    /// Receives the gateway's events and results for the axis.
    std::function<void(const Event&, Instant)> on_axis_event;
    /// Since when the commanding client is silent; empty while it is not.
    std::optional<Instant> silent_since;

    void step();
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
    /// The result of a command; empty if it did not arrive within the time.
    std::optional<Result> ask(CommandBody body, const Origin& by, Duration limit);
    /// The same without waiting for the answer.
    void say(CommandBody body, const Origin& by) { (void)give(std::move(body), by); }

    // --- EngineHost
    std::unique_ptr<Line> make_line(const LineSpec& spec, const LineSetup& setup) override;
    void on_result(const Result& result) override;
    void on_event(Event event, Instant at) override;
    void on_sample(const Sample&) override {}
    void on_store(StoreOrder) override {}
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient&) const override { return silent_since.value_or(now_); }
    void on_twin_memory(const std::string&, NonVolatile) override {}

private:
    struct Gateway {
        Gateway(const Families& families, EngineHost& host) : engine(families, host, image, 16) {}
        Image image;
        Engine engine;
    };
    Ticket give(CommandBody body, const Origin& by);
    void plug_in(const LineSetup& setup);

    const Families& families_;
    const SiteMemory& memory_;
    AxisSpec spec_;
    Times times_;
    Site site_;
    std::unique_ptr<TwinBus> bus_;  ///< outlives every gateway
    std::unique_ptr<Gateway> gateway_;
    AxisId axis_id_ = no_axis;
    DriveId drive_id_ = no_drive;
    Instant now_ = at_ns(1'000'000'000);
    Ticket awaited_ = no_ticket;
    std::optional<Result> answer_;
    std::uint64_t tickets_ = 0;
};

}  // namespace axisgate
