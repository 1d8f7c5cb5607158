// The rehearsal port for tests: the test answers the requested cells and specimens with give_all() and give_specimens(). A recipe is good
// unless the test has put faults into recipe_faults.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "gateway/services/ports/captures.hpp"
#include "gateway/services/ports/fleet.hpp"
#include "gateway/services/ports/recorder.hpp"
#include "gateway/services/ports/rehearsal.hpp"
#include "gateway/services/recipes/recipe_rehearsal.hpp"

namespace axisgate::http::test {

class FakeRehearsal : public RehearsalPort {
public:
    void rehearse(std::shared_ptr<const SiteState>, RehearsalWish wish, std::function<void(RehearsalCell)> then) override {
        RehearsalCell cell;
        cell.axis = wish.axis;
        cell.cause = wish.cause;
        cell.restart = wish.restart;
        wishes.push_back(std::move(wish));
        cells_wanted.emplace_back(std::move(cell), std::move(then));
    }
    [[nodiscard]] Duration watchdog() const override { return std::chrono::milliseconds(5000); }
    /// Answers all requested cells, and those requested because of that.
    void give_all(const std::function<void(RehearsalCell&)>& fill) {
        while (!cells_wanted.empty()) {
            auto [cell, then] = std::move(cells_wanted.front());
            cells_wanted.pop_front();
            fill(cell);
            then(std::move(cell));
        }
    }
    void prepare_recipe(RecipeRehearsalWish wish, Prepared then) override {
        recipes_wanted.push_back(std::move(wish));
        std::vector<SiteFault> none;
        auto made = std::make_shared<const RecipeRehearsal>(no_families, RecipeRehearsalWish{}, none);  // only handed back, never played
        to_prepare.emplace_back([then = std::move(then), made = recipe_faults.empty() ? made : nullptr,
                                 faults = std::exchange(recipe_faults, {})] { then(made, faults); });
        if (prepare_at_once) give_prepared();
    }
    void rehearse_recipe(std::shared_ptr<const RecipeRehearsal>, std::string specimen, std::shared_ptr<const std::atomic<bool>> ended,
                         std::function<void(RehearsedSpecimen)> then) override {
        RehearsedSpecimen row;
        row.specimen = std::move(specimen);
        specimens_wanted.push_back({std::move(row), std::move(ended), std::move(then)});
    }
    void give_prepared() {
        while (!to_prepare.empty()) {
            auto job = std::move(to_prepare.front());
            to_prepare.pop_front();
            job();
        }
    }
    /// Answers up to `most` specimens, and those requested because of that. Returns the number.
    std::size_t give_specimens(std::size_t most, const std::function<void(RehearsedSpecimen&)>& fill) {
        std::size_t n = 0;
        for (; n < most && !specimens_wanted.empty(); ++n) {
            auto wanted = std::move(specimens_wanted.front());
            specimens_wanted.pop_front();
            fill(wanted.row);
            wanted.then(std::move(wanted.row));
        }
        return n;
    }
    struct WantedSpecimen {
        RehearsedSpecimen row;
        std::shared_ptr<const std::atomic<bool>> ended;
        std::function<void(RehearsedSpecimen)> then;
    };
    std::deque<WantedSpecimen> specimens_wanted;
    std::vector<RecipeRehearsalWish> recipes_wanted;  ///< all requests so far
    std::deque<std::function<void()>> to_prepare;
    bool prepare_at_once = true;
    std::vector<SiteFault> recipe_faults;  ///< of the next recipe
    Families no_families;

    std::deque<std::pair<RehearsalCell, std::function<void(RehearsalCell)>>> cells_wanted;
    std::deque<RehearsalWish> wishes;  ///< all requests so far
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

/// Trends that a test fills, and recordings without a disk.
class FakeRecorder : public RecorderPort {
public:
    Trends trends{1u << 20, std::chrono::hours(1)};
    std::vector<RecordingInfo> recorded;
    RecordingFault next_fault;  ///< of the next request
    TrendStretch trend(AxisId axis, Instant from, Instant to, std::size_t columns) override { return trends.read(axis, from, to, columns); }
    RecorderState recorder_state() override { return {}; }
    std::vector<RecordingInfo> recordings() const override { return recorded; }
    void freeze(std::string name, std::string why, std::string who, std::function<void(RecordingFault, RecordingInfo)> then) override {
        if (next_fault.kind != RecordingFault::Kind::none) return then(std::exchange(next_fault, {}), {});
        RecordingInfo info;
        info.name = std::move(name);
        info.why = std::move(why);
        info.who = std::move(who);
        recorded.push_back(info);
        then({}, info);
    }
    FlightLog stretch{1u << 20, true};
    void read_stretch(Instant from, std::function<void(const FlightRecord&)> each, std::function<void()> then) override {
        for (const auto& chunk : stretch.chunks()) {
            FlightReader reader(chunk->bytes);
            while (const auto r = reader.next())
                if (r->at >= from) each(*r);
        }
        then();
    }
    void load_recording(const std::string&, std::function<void(std::optional<std::string>)> then) override { then("the file"); }
    void play_back(const std::string& name, PlaybackWish wish, std::function<void(RecordingFault, boost::json::object)> then) override {
        played = wish;
        then(next_fault.kind == RecordingFault::Kind::none ? RecordingFault{} : std::exchange(next_fault, {}), {{"name", name}});
    }
    PlaybackWish played;
    void rename_recording(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) override {
        for (auto& r : recorded)
            if (r.name == name) return r.name = to, then({});
        then({RecordingFault::Kind::no_such, ""});
    }
    void remove_recording(const std::string& name, std::function<void(RecordingFault)> then) override {
        const bool gone = std::erase_if(recorded, [&](const auto& r) { return r.name == name; }) > 0;
        then(gone ? RecordingFault{} : RecordingFault{RecordingFault::Kind::no_such, ""});
    }
};

/// Captures that the test feeds; they are kept in memory.
class FakeCaptures : public CapturePort {
public:
    std::vector<std::pair<CaptureOrder, Capture>> running;
    RecordingFault capture_fault;  ///< of the next request
    CaptureRoom capture_room() const override { return {1000, 2000, ""}; }
    std::vector<CaptureInfo> captures() override {
        std::vector<CaptureInfo> out;
        for (const auto& [order, capture] : running) {
            CaptureInfo i;
            i.name = order.name;
            i.summary = capture_summary(order, capture, 0);
            out.push_back(std::move(i));
        }
        return out;
    }
    void arm(CaptureOrder order, std::function<void(RecordingFault, CaptureInfo)> then) override {
        if (capture_fault.kind != RecordingFault::Kind::none) return then(std::exchange(capture_fault, {}), {});
        Capture capture(order.wish, Instant(std::chrono::seconds(1)));
        running.emplace_back(std::move(order), std::move(capture));
        then({}, captures().back());
    }
    void load_capture(const std::string& name, std::function<void(RecordingFault, boost::json::array)> then) override {
        for (const auto& [order, capture] : running)
            if (order.name == name) return then(std::exchange(capture_fault, {}), capture_columns(order, capture));
        then({RecordingFault::Kind::no_such, ""}, {});
    }
    void rename_capture(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) override {
        for (auto& r : running)
            if (r.first.name == name) return r.first.name = to, then({});
        then({RecordingFault::Kind::no_such, ""});
    }
    void remove_capture(const std::string& name, std::function<void(RecordingFault)> then) override {
        const bool gone = std::erase_if(running, [&](const auto& r) { return r.first.name == name; }) > 0;
        then(gone ? RecordingFault{} : RecordingFault{RecordingFault::Kind::no_such, ""});
    }
};

}  // namespace axisgate::http::test
