// The lock is stored before it is given to the door, so that a lock that was seen as set is still set after a restart. An event names the
// client that has changed it.
#include "gateway/runtime/warm_modbus.hpp"

#include "gateway/runtime/clock.hpp"

namespace axisgate {

void WarmModbus::modbus_report(std::function<void(std::optional<ModbusReport>)> then) {
    auto job = [this, then](Engine&, Instant) { threads_.answer([then, report = door_.report()]() mutable { then(std::move(report)); }); };
    if (!door_.report || !threads_.on_hot(std::move(job))) threads_.answer([then] { then(std::nullopt); });
}

void WarmModbus::set_modbus_read_only(bool on, Origin origin, std::function<void(std::string, bool)> then) {
    if (!door_.set_read_only) return threads_.answer([then = std::move(then)] { then("there is no Modbus door: set modbus.bind", false); });
    threads_.on_cold([this, on, origin = std::move(origin), then = std::move(then)](Store& store) {
        const auto saved = store.save_document({"setting", "modbus.read_only", on ? "true" : "false", origin.text(), unix_now_ns()});
        threads_.answer([this, on, origin, then, fault = saved ? std::string() : saved.error().text] {
            if (!fault.empty()) return then(fault, true);
            put_in_force(on, origin, then);
        });
    });
}

void WarmModbus::put_in_force(bool on, const Origin& origin, const std::function<void(std::string, bool)>& then) {
    auto job = [this, on, origin, then](Engine&, Instant) {
        door_.set_read_only(on);
        threads_.answer([this, on, origin, then] {
            events_.note("modbus", on ? "the Modbus door is read-only now" : "the Modbus door takes writes again", origin,
                         on ? Severity::warning : Severity::info);
            then({}, false);
        });
    };
    if (!threads_.on_hot(std::move(job))) then("it is stored, but could not be put in force now: send it again", false);
}

}  // namespace axisgate
