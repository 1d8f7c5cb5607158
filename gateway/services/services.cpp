// Composes the services and gives them one deadline. After the end has begun, no listener is called.
#include "gateway/services/services.hpp"

#include <algorithm>

namespace axisgate {

Services::Services(const Ports& ports, std::function<Instant()> clock, std::shared_ptr<AccessPort> access_port)
    : access(std::move(access_port)),
      recipes(std::make_shared<RecipeService>(ports, clock)),
      alarms(std::make_shared<AlarmService>(ports, clock)),
      rehearsals(std::make_shared<Rehearsals>(ports)),
      recipe_rehearsals(std::make_shared<RecipeRehearsals>(ports)),
      boot_check(std::make_shared<BootCheck>(ports, jobs)) {
    recipes->rearm = [this] {
        if (rearm) rearm();
    };
    recipes->publish = [this](const std::string& recipe, const boost::json::object& report) {
        const auto listeners = listeners_;
        for (auto* l : listeners)
            l->on_recipe(recipe, report);
    };
    alarms->rearm = recipes->rearm;
    alarms->publish = [this](const boost::json::object& list) {
        const auto listeners = listeners_;
        for (auto* l : listeners)
            l->on_alarms(list);
    };
    alarms->begin();
    recipes->begin();
    boot_check->begin();
}

Services::~Services() {
    recipes->rearm = nullptr;
    recipes->publish = nullptr;
    alarms->detach();
    boot_check->detach();
}

Instant Services::deadline() const { return std::min(recipes->deadline(), alarms->deadline()); }

void Services::on_deadline(Instant now) {
    // Each checks itself what is due: the alarms' deadline depends on the wall clock, and may have changed meanwhile.
    recipes->on_deadline(now);
    alarms->on_deadline(now);
}

}  // namespace axisgate
