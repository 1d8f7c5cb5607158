// The axis and the parameter port for tests: pictures and values are set by the test; each command waits until the test ends it, or is
// answered at once.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "gateway/doors/http/words.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/parameters.hpp"
#include "tests/unit/http/fake_site.hpp"

namespace axisgate::http::test {

class FakeAxes : public AxisPort {
public:
    explicit FakeAxes(FakeSite& sites) : sites_(sites) {}
    void set_picture(const std::string& name, AxisPicture p) {
        pictures[sites_.axis(name)] = p;
        ++revisions[sites_.axis(name)];
    }
    /// Answers the oldest waiting command.
    void finish(Result r) {
        if (waiting.empty()) throw std::logic_error("no command waits");
        auto w = std::move(waiting.front());
        waiting.pop_front();
        r.ticket = w.ticket;
        r.axis = w.command.axis;
        w.then(r);
    }

    std::map<AxisId, AxisPicture> pictures;
    std::map<AxisId, std::uint64_t> revisions;
    std::vector<SetPoint> set_points;
    mutable int pictures_read = 0;

    struct Waiting {
        Ticket ticket;
        Command command;
        std::function<void(const Result&)> then;
    };
    std::deque<Waiting> waiting;
    std::vector<Command> submitted;
    /// If set, commands are answered inside submit.
    std::function<Result(const Command&)> at_once;
    Ticket last_ticket = (std::uint64_t{3} << 56) + 16;

    AxisPicture picture(AxisId id) const override {
        ++pictures_read;
        const auto it = pictures.find(id);
        return it == pictures.end() ? AxisPicture{} : it->second;
    }
    std::uint64_t picture_revision(AxisId id) const override {
        const auto it = revisions.find(id);
        return it == revisions.end() ? 0 : it->second;
    }
    void set_point(SetPoint p) override { set_points.push_back(std::move(p)); }
    Ticket submit(Command command, std::function<void(const Result&)> then) override {
        command.ticket = ++last_ticket;
        submitted.push_back(command);
        if (at_once) {
            Result r = at_once(command);
            r.ticket = command.ticket;
            then(r);
        } else {
            waiting.push_back({command.ticket, command, std::move(then)});
        }
        return command.ticket;
    }
    std::vector<std::pair<AuthorityClient, LossCause>> lost;
    void client_lost(const AuthorityClient& who, LossCause cause) override { lost.emplace_back(who, cause); }

private:
    FakeSite& sites_;
};

class FakeParameters : public ParameterPort {
public:
    std::map<std::pair<AxisId, Point>, LiveParameter> live_values;
    std::map<std::string, std::vector<StoredParameter>> stored_values;
    std::set<SampleListener*> sample_listeners;

    LiveParameter live(AxisId id, Point p) const override {
        const auto it = live_values.find({id, p});
        return it == live_values.end() ? LiveParameter{} : it->second;
    }
    std::vector<StoredParameter> stored(const std::string& name) const override {
        const auto it = stored_values.find(name);
        return it == stored_values.end() ? std::vector<StoredParameter>{} : it->second;
    }
    std::vector<StoredParameter> history(const std::string& name, const std::string& parameter, std::size_t limit) const override {
        std::vector<StoredParameter> out;
        for (const auto& s : stored(name)) {
            if (s.parameter == parameter && out.size() < limit) out.push_back(s);
        }
        return out;
    }
    void listen(SampleListener* l) override { sample_listeners.insert(l); }
    void unlisten(SampleListener* l) override { sample_listeners.erase(l); }
};

/// The picture of an enabled, referenced axis at rest.
inline AxisPicture standing(std::int64_t position, std::int64_t at_ms = 600) {
    AxisPicture p;
    p.number = 1;
    p.family_number = 7;
    p.position = position;
    p.position_demand = position;
    p.demand_source = DemandSource::drive;
    p.statusword = 0x9637;  // operation enabled, simulated, remote, target reached, set-point acknowledged, referenced
    p.mode_display = 1;
    p.flags = flag_online | flag_simulated | flag_referenced | flag_target_reached;
    p.presence = Presence::twin;
    p.target_position = static_cast<std::int32_t>(position);
    p.authority = http::clients;
    p.setpoints_accepted = 3;
    p.native_status = 0x1234;
    p.ever_seen = true;
    p.at = at_ns(at_ms * 1'000'000);
    return p;
}

}  // namespace axisgate::http::test
