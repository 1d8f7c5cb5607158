// A gateway by itself, with the ports that a service needs, and a place for doors of a program outside: an engine without store and
// threads. Usually its time is virtual and all its drives are simulated; a comparison gives it real lines and real time. It has no
// connection to the running gateway. Bounds: the events are not kept, only the newest warning of a drive.
#pragma once

#include <boost/json/object.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/engine/engine.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/recipes/rehearsal_doors.hpp"
#include "gateway/services/recipes/rehearsal_ports.hpp"

namespace axisgate {

/// The site with every drive simulated: lines become twin lines with the same medium and bit rate.
[[nodiscard]] Site simulated_site(Site site, const Families& families);

class RehearsalGateway final : public EngineHost, public AxisPort, public ClockPort, public NoDocuments, public NoEvents, public SitePort {
public:
    /// What it gets from outside if it is not only simulated.
    struct Outside {
        std::function<std::unique_ptr<Line>(const LineSpec&, const LineSetup&)> make_line{};  ///< empty: lines never open
        Instant begin = time_zero + std::chrono::seconds(1);
        std::size_t trace_frames = 16;
    };
    /// `site` is one of simulated_site, unless `outside` makes lines. The drives are switched on at once; they are searched for and
    /// identified in the first steps.
    RehearsalGateway(const Families& families, Site site, const SiteMemory& memory, Duration lease);
    RehearsalGateway(const Families& families, Site site, const SiteMemory& memory, Duration lease, Outside outside);

    [[nodiscard]] Instant now() const noexcept { return now_; }
    /// Advances to the next event of the gateway, `due` at the latest, and delivers the results of commands.
    void step(Instant due);
    /// Real time: everything that is due at `now`. It is called again when engine().wake_at() has come, or a line has received something.
    void advance(Instant now);
    [[nodiscard]] const Engine& engine() const noexcept { return engine_; }
    /// The memory of a simulated drive: as it was changed last, empty if it never was.
    [[nodiscard]] const NonVolatile& twin_memory(const std::string& drive) const;
    [[nodiscard]] bool online(AxisId axis) const;
    [[nodiscard]] const Image& image() const noexcept { return image_; }
    [[nodiscard]] Engine& engine() noexcept { return engine_; }
    /// Its drive answers, whether or not it has reported a state.
    [[nodiscard]] bool answers(AxisId axis) const { return (picture(axis).flags & flag_online) != 0; }
    /// The newest warning or error of an axis, a drive or a line, with its name; empty: none.
    [[nodiscard]] const std::string& last_warning() const noexcept { return last_warning_; }
    void forget_warning() { last_warning_.clear(); }

    /// Doors beside the recipe service, to which results with their numbers and all samples are given.
    [[nodiscard]] RehearsalDoors& doors() noexcept { return doors_; }
    /// A command of a door; its result comes in the next step.
    void give(Command command) { given_.push_back(std::move(command)); }

    // --- AxisPort
    [[nodiscard]] AxisPicture picture(AxisId axis) const override;
    [[nodiscard]] std::uint64_t picture_revision(AxisId axis) const override;
    Ticket submit(Command command, std::function<void(const Result&)> then) override;
    void set_point(SetPoint set_point) override { (void)engine_.on_set_point(set_point, now_); }
    void client_lost(const AuthorityClient& who, LossCause cause) override { engine_.on_client_lost(who, cause, now_); }
    // --- ClockPort: the wall clock begins at 1970-01-01
    [[nodiscard]] std::int64_t now_unix_ns() const override { return to_unix_ns(now_); }
    [[nodiscard]] std::int64_t to_unix_ns(Instant instant) const override { return (instant - time_zero).count(); }
    // --- SitePort: the site does not change
    using NoEvents::listen;
    using NoEvents::unlisten;
    [[nodiscard]] std::shared_ptr<const SiteState> site() const override { return engine_.site(); }
    [[nodiscard]] const Families& families() const override { return families_; }
    void apply_site(Site, std::uint64_t, Origin, std::function<void(SiteAnswer)> then) override;
    [[nodiscard]] std::vector<SiteRevision> site_history(std::size_t, std::uint64_t) const override { return {}; }
    [[nodiscard]] std::optional<SiteRevision> site_revision(std::uint64_t) const override { return {}; }
    void listen(SiteListener*) override {}
    void unlisten(SiteListener*) override {}
    // --- EngineHost
    std::unique_ptr<Line> make_line(const LineSpec& spec, const LineSetup& setup) override;
    void on_result(const Result& result) override { results_.push_back(result); }
    void on_event(Event event, Instant at) override;
    void on_sample(const Sample& sample) override { doors_.on_sample(sample); }
    void on_store(StoreOrder order) override { stored_.push_back(order.ticket); }
    void on_twin_memory(const std::string& drive, NonVolatile memory) override { memories_[drive] = std::move(memory); }
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient& who) const override { return doors_.last_received(who); }

private:
    void deliver();

    const Families& families_;
    Outside outside_;
    Image image_;
    Instant now_;
    Engine engine_;
    std::uint64_t tickets_ = 0;
    std::map<Ticket, std::function<void(const Result&)>> waiting_;
    std::vector<Result> results_;
    std::vector<Ticket> stored_;
    std::vector<Command> given_;
    RehearsalDoors doors_;
    std::string last_warning_;
    std::map<std::string, NonVolatile> memories_;
};

}  // namespace axisgate
