// The fleet port is the DDS door, if there is one. Without it there is no fleet, and requests say so.
#pragma once

#include "gateway/services/ports/fleet.hpp"

namespace axisgate {

class WarmFleet final : public FleetPort {
public:
    /// Before the start; the door must outlive every call.
    void use(FleetPort& door) { door_ = &door; }
    [[nodiscard]] std::vector<FleetGateway> fleet() const override { return door_ ? door_->fleet() : std::vector<FleetGateway>{}; }
    void command(FleetOrder order, std::function<void(const Result&)> then) override {
        if (door_) return door_->command(std::move(order), std::move(then));
        Result none;
        none.outcome = Outcome::refused;
        none.reason = Reason::not_supported;
        none.text = "this gateway is in no fleet: [dds] enabled is false";
        then(none);
    }

private:
    FleetPort* door_ = nullptr;
};

}  // namespace axisgate
