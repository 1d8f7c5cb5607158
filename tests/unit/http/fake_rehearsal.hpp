// The rehearsal port of tests of the HTTP door: cells that the test gives when it likes.
// In: what the door asked for. Out: those requests; the test answers with give(). Never plays anything.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "gateway/services/ports/fleet.hpp"
#include "gateway/services/ports/rehearsal.hpp"

namespace axisgate::http::test {

class FakeRehearsal : public RehearsalPort {
public:
    void rehearse(std::shared_ptr<const SiteState>, std::string axis, LossCause cause, std::function<void(RehearsalCell)> then) override {
        RehearsalCell cell;
        cell.axis = std::move(axis);
        cell.cause = cause;
        cells_wanted.emplace_back(std::move(cell), std::move(then));
    }
    [[nodiscard]] Duration watchdog() const override { return std::chrono::milliseconds(5000); }
    /// Answers all that is asked, and what is asked for that.
    void give_all(const std::function<void(RehearsalCell&)>& fill) {
        while (!cells_wanted.empty()) {
            auto [cell, then] = std::move(cells_wanted.front());
            cells_wanted.pop_front();
            fill(cell);
            then(std::move(cell));
        }
    }
    std::deque<std::pair<RehearsalCell, std::function<void(RehearsalCell)>>> cells_wanted;
};

class FakeFleet : public FleetPort {
public:
    std::vector<FleetGateway> gateways;
    std::vector<FleetOrder> orders;
    Result fleet_result;
    std::vector<FleetGateway> fleet() const override { return gateways; }
    void command(FleetOrder order, std::function<void(const Result&)> then) override {
        orders.push_back(std::move(order));
        then(fleet_result);
    }
};

}  // namespace axisgate::http::test
