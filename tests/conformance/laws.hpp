// The common base of the conformance suites: one subject (a family on one of its wires) in a world of its own, and functions that start,
// enable and move its drives. Suites never name a family.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "tests/world/world.hpp"

namespace axisgate::test {

/// Every subject, and one family whose velocity mode was removed: the laws hold also for drives without one.
const std::vector<Subject>& law_subjects();

/// "refused no_answer: ..." of a result, or that there is none.
inline std::string published(const Result* r) {
    return r ? std::string(name_of(r->outcome)) + " " + std::string(name_of(r->reason)) + ": " + r->text : "no result";
}

/// Another adapter with every call passed on; a test overrides the calls that it wants to change.
class PassingAdapter : public Adapter {
public:
    explicit PassingAdapter(std::unique_ptr<Adapter> inner) : inner_(std::move(inner)) {}
    void configure(const LineSetup& setup, Instant now, Out& out) override { inner_->configure(setup, now, out); }
    void on_line(bool up, Instant now, Out& out) override { inner_->on_line(up, now, out); }
    void on_command(const Command& command, Instant now, Out& out) override { inner_->on_command(command, now, out); }
    void on_set_point(const SetPoint& p, Instant now, Out& out) override { inner_->on_set_point(p, now, out); }
    [[nodiscard]] Duration interpolation_time(AxisId axis) const override { return inner_->interpolation_time(axis); }
    void on_frame(const Frame& frame, Instant now, Out& out) override { inner_->on_frame(frame, now, out); }
    void on_deadline(Instant now, Out& out) override { inner_->on_deadline(now, out); }
    [[nodiscard]] Instant deadline() const override { return inner_->deadline(); }
    [[nodiscard]] AdapterCounters counters() const override { return inner_->counters(); }

private:
    std::unique_ptr<Adapter> inner_;
};

class Laws : public testing::TestWithParam<Subject> {
protected:
    const Subject& e = GetParam();
    std::unique_ptr<World> world = fresh();
    std::shared_ptr<const SiteState> site;
    AxisId a1 = no_axis;    ///< the first axis
    DriveId d1 = no_drive;  ///< and its drive

    [[nodiscard]] std::unique_ptr<World> fresh() const {
        Families mine = families();
        for (auto& entry : mine.entries) {
            if (entry.family->name == e.family->name) entry = e;
        }
        return std::make_unique<World>(1, std::make_shared<Plant>(), std::move(mine));
    }
    [[nodiscard]] AxisPicture now(AxisId axis) const { return world->picture(axis); }
    [[nodiscard]] AxisPicture now() const { return now(a1); }
    [[nodiscard]] bool online(AxisId axis) const { return (now(axis).flags & flag_online) && now(axis).ever_seen; }
    [[nodiscard]] bool moving(AxisId axis) const { return (now(axis).flags & flag_moving) != 0; }

    /// Puts a site in force and waits until every axis is online.
    void start(Site wanted) {
        site = world->apply(std::move(wanted));
        a1 = site->axis_ids.at(0);
        d1 = site->drive_ids.at(0);
        ASSERT_TRUE(world->run_until_true([&] { return std::ranges::all_of(site->axis_ids, [&](AxisId x) { return online(x); }); },
                                          std::chrono::seconds(60)))
            << "the twins do not come up";
        world->run_for(std::chrono::seconds(1));
    }
    void start(std::size_t drives = 1, int channels = 1) { start(world->twins(e, drives, channels)); }

    const Result* ask(AxisId axis, CommandBody body, bool until_done = true, Duration limit = std::chrono::seconds(60)) {
        return world->wait(world->command(axis, std::move(body), until_done), limit);
    }
    /// Gives an order, which must be accepted, or done.
    void order(AxisId axis, CommandBody body, bool until_done = true) {
        const std::string what(name_of(body));
        const Result* r = ask(axis, std::move(body), until_done);
        ASSERT_TRUE(r && good(*r)) << what << ": " << published(r);
    }
    [[nodiscard]] static Move move_to(std::int64_t target, Move::Kind kind = Move::Kind::absolute) {
        Move m;
        m.kind = kind;
        m.target = target;
        if (kind != Move::Kind::velocity) m.velocity = 4000;
        m.acceleration = m.deceleration = 20000;
        return m;
    }
    /// By a velocity move; if the drive has none, and says so, by a positioning that takes half a minute.
    void turn(AxisId axis, std::int64_t velocity = 4000) {
        const Result* r = ask(axis, move_to(velocity, Move::Kind::velocity), false);
        ASSERT_TRUE(r);
        has_velocity = r->reason != Reason::not_supported;
        if (!has_velocity) {
            lacks_velocity(*r);
            Move m = move_to(velocity * 30, Move::Kind::relative);
            m.velocity = std::llabs(velocity);
            r = ask(axis, m, false);
            ASSERT_TRUE(r);
        }
        ASSERT_TRUE(good(*r)) << published(r);
        ASSERT_TRUE(world->run_until_true([&] { return moving(axis) && std::llabs(now(axis).velocity) * 10 > std::llabs(velocity) * 9; },
                                          std::chrono::seconds(20)))
            << "it does not turn";
    }
    bool has_velocity = true;  ///< as turn() found it
    /// Checks a velocity move that was answered as not supported: with a text, and only if the drive's manual knows none.
    void lacks_velocity(const Result& r) const;
    /// The manual's answer to a question that the suites ask of every family: adapters/<family>/tests/facts.json.
    [[nodiscard]] bool fact(const std::string& name) const;

    [[nodiscard]] int channel_of(AxisId axis) const {
        for (std::size_t i = 0; i < site->axis_ids.size(); ++i) {
            if (site->axis_ids[i] == axis) return site->site.axes[i].channel;
        }
        return 0;
    }
    [[nodiscard]] DriveId drive_of(AxisId axis) const {
        for (std::size_t i = 0; i < site->axis_ids.size(); ++i) {
            for (std::size_t k = 0; site->axis_ids[i] == axis && k < site->site.drives.size(); ++k) {
                if (site->site.drives[k].name == site->site.axes[i].drive) return site->drive_ids[k];
            }
        }
        return no_drive;
    }
    /// The true state of its mechanics, independent of the wire.
    [[nodiscard]] TwinMechanics mechanics(AxisId axis) const {
        return world->engine.twin(drive_of(axis))->mechanics(channel_of(axis), world->now);
    }
    [[nodiscard]] double speed(AxisId axis) const { return std::fabs(mechanics(axis).velocity); }
    [[nodiscard]] std::string hand(const std::string& name, const Value& v) {
        return world->engine.set_hand(d1, {{name, v}}, {}, world->now);
    }

    [[nodiscard]] std::ptrdiff_t events(std::string_view kind) const {
        return std::ranges::count_if(world->events, [&](const Event& v) { return v.kind == kind; });
    }
    /// True if the page has settings; a drive that represents another gateway's axis may have none.
    [[nodiscard]] bool has_settings() const {
        return std::ranges::any_of(e.catalogue->parameters(), [](const Parameter& p) { return p.writable(); });
    }
    [[nodiscard]] Point first_point(std::uint16_t parameter) const {
        const Parameter& p = e.catalogue->parameters()[parameter];
        return {parameter, p.count ? p.first : std::uint16_t{0}};
    }
};

}  // namespace axisgate::test
