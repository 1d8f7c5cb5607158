// When a drive answers, compares its parameters with those that were written through the gateway, and with those of its DCF, if the site
// says so. An event reports an axis with differences, and the stored values are written if the site says that, too. Parameters that act at
// once or by which the drive is reached are never written, and nothing is written while the axis moves.
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
    static constexpr std::size_t most_named = 5;  ///< number of differences that an event names; the others are counted

    using Needs = PortSet<AxisPort, EventPort, ParameterPort, SitePort>;
    BootCheck(const Needs& ports, std::shared_ptr<AxisJobs> jobs);
    BootCheck(const BootCheck&) = delete;
    BootCheck& operator=(const BootCheck&) = delete;
    void begin();   ///< starts listening
    void detach();  ///< stops listening

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
