// The services that outlive a request and belong to no door: alarms, recipes, jobs on parameters, the owner of the staged site, access.
// They exist with any doors, or with none. Service thread only; the owner calls on_deadline.
#pragma once

#include <boost/json/object.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/services/access/access_port.hpp"
#include "gateway/services/alarms/alarm_service.hpp"
#include "gateway/services/change_queue.hpp"
#include "gateway/services/fail_safe/rehearsals.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"
#include "gateway/services/parameters/boot_check.hpp"
#include "gateway/services/ports.hpp"
#include "gateway/services/recipes/recipe_rehearsals.hpp"
#include "gateway/services/recipes/recipe_service.hpp"
#include "gateway/services/site/stage_owner.hpp"

namespace axisgate {

/// The reports of the services, on the service thread.
struct ServiceListener {
    /// The list of alarms has changed.
    virtual void on_alarms(const boost::json::object& /*list*/) {}
    /// A run of a recipe has changed, or has ended.
    virtual void on_recipe(const std::string& /*recipe*/, const boost::json::object& /*report*/) {}
    virtual ~ServiceListener() = default;
};

/// Parameters that are being written, (axis, parameter): number of writes.
using WritesUnderWay = std::map<std::pair<std::string, std::string>, int>;

class Services {
public:
    /// `access` provides users; without it there is only local access.
    Services(const Ports& ports, std::function<Instant()> clock, std::shared_ptr<AccessPort> access = nullptr);
    ~Services();
    Services(const Services&) = delete;
    Services& operator=(const Services&) = delete;

    const std::shared_ptr<AccessPort> access;
    const std::shared_ptr<RecipeService> recipes;
    const std::shared_ptr<AlarmService> alarms;
    const std::shared_ptr<Rehearsals> rehearsals;                         ///< of loss of command, on models
    const std::shared_ptr<RecipeRehearsals> recipe_rehearsals;            ///< of recipes, against specimens
    const std::shared_ptr<AxisJobs> jobs = std::make_shared<AxisJobs>();  ///< many parameters of one axis, one after the other
    const std::shared_ptr<BootCheck> boot_check;                          ///< of stored parameters, when a drive answers
    const std::shared_ptr<ChangeQueue> site_changes = std::make_shared<ChangeQueue>();
    const std::shared_ptr<StageOwner> stages = std::make_shared<StageOwner>();  ///< the owner of the staged site
    const std::shared_ptr<WritesUnderWay> writes =
        std::make_shared<WritesUnderWay>();  ///< of parameters, each until the drive has answered

    void listen(ServiceListener& listener) { listeners_.push_back(&listener); }
    void unlisten(ServiceListener& listener) { std::erase(listeners_, &listener); }

    [[nodiscard]] Instant deadline() const;
    void on_deadline(Instant now);
    /// Called when deadline() may have changed for another reason than on_deadline.
    std::function<void()> rearm;

private:
    std::vector<ServiceListener*> listeners_;
};

}  // namespace axisgate
