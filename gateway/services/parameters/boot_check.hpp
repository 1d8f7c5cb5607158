// Boot check: when a drive answers, its parameters are compared with those that were written through the gateway, where the site says so.
// In: events of drives, what was written, what the drive has. Out: an event for an axis that differs; what differs is written, if the
// site says that, too. Never writes what acts at once or what the drive is reached by, and never while the axis moves.
#pragma once

#include <memory>
#include <string>

#include "gateway/services/parameters/axis_jobs.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/parameters.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

class BootCheck final : public EventListener, public std::enable_shared_from_this<BootCheck> {
public:
    static constexpr std::size_t most_named = 5;  ///< differences that an event names; of the others it tells how many

    using Needs = PortSet<AxisPort, EventPort, ParameterPort, SitePort>;
    BootCheck(const Needs& ports, std::shared_ptr<AxisJobs> jobs);
    BootCheck(const BootCheck&) = delete;
    BootCheck& operator=(const BootCheck&) = delete;
    void begin();   ///< listens from now on
    void detach();  ///< listens no more

    void on_event(const Event& event) override;

private:
    void check(const std::string& axis);
    void compared(const std::string& axis, const std::vector<JobPoint>& stored, const JobEnd& end);
    void tell(Severity severity, const std::string& axis, std::string text);

    AxisPort& axes_;
    EventPort& events_;
    ParameterPort& parameters_;
    SitePort& sites_;
    std::shared_ptr<AxisJobs> jobs_;
    bool listening_ = false;
};

}  // namespace axisgate
