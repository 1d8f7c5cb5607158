// The descriptor of the DDS door: its keys and settings.
#include "gateway/runtime/door_dds.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>

#include "gateway/doors/dds/door.hpp"
#include "gateway/doors/dds/words.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/runtime/late_doors.hpp"
#include "gateway/runtime/warm_ports.hpp"

namespace axisgate {
namespace {
constexpr setting::Key dds_keys[] = {
    {"dds", "enabled", [](Config& c, const std::string& s) { return setting::on_or_off(c.of<DdsSettings>().enabled, s); },
     setting::Written::as_switch},
    {"dds", "domain", [](Config& c, const std::string& s) { return setting::whole_number(c.of<DdsSettings>().domain, s, 0, 232); },
     setting::Written::as_number},
    {"dds", "partition", [](Config& c, const std::string& s) { return setting::plain_name(c.of<DdsSettings>().partition, s); }},
    {"dds", "name", [](Config& c, const std::string& s) { return setting::plain_name(c.of<DdsSettings>().name, s); }},
    {"dds", "interface", [](Config& c, const std::string& s) { return setting::plain_name(c.of<DdsSettings>().interface_name, s); }},
    {"dds", "security",
     [](Config& c, const std::string& s) { return setting::any_text(c.of<DdsSettings>().security, s == "off" ? "" : s); }},
};

/// The host name without its domain; "axisgate" if it has none.
std::string host_name() {
    char name[64] = {};
    if (gethostname(name, sizeof name - 1) != 0 || name[0] == 0) return "axisgate";
    std::string s(name);
    s.resize(std::min(s.find('.'), s.size()));
    return s.empty() ? "axisgate" : s;
}

dds::DoorSettings door_settings(const DoorHouse& house) {
    const auto& c = house.config.of<DdsSettings>();
    dds::DoorSettings s;
    s.bus.domain = static_cast<std::uint32_t>(c.domain);
    s.bus.partition = c.partition;
    s.bus.interface_name = c.interface_name;
    s.bus.security = c.security;
    s.name = c.name.empty() ? host_name() : c.name;
    s.version = AXISGATE_VERSION;
    s.page = house.page;
    s.instance = static_cast<std::uint64_t>(unix_now_ns());  // no two starts of one name in the same nanosecond
    s.want_change = [&hot = house.hot] { hot.want_change(); };
    return s;
}

class RunningDds final : public RunningDoor {
public:
    explicit RunningDds(const DoorHouse& house)
        : interface_name_(house.config.of<DdsSettings>().interface_name),
          door_(house.service, house.ports.all(), monotonic_now, door_settings(house)) {
        house.ports.fleet.use(door_);
    }
    [[nodiscard]] std::string name() const override { return std::string(door_.name()); }
    [[nodiscard]] std::string open() override { return door_.start(); }
    [[nodiscard]] bool is_late() const override { return interface_is_late(interface_name_); }
    [[nodiscard]] std::string address() const override { return door_.address(); }
    void on_change() override { door_.on_change(); }
    [[nodiscard]] bool take_mirror(int fd) override {
        door_.take_mirror(fd);
        return true;
    }
    [[nodiscard]] std::string metrics() const override { return door_.metrics(); }
    void stop(std::function<void()> done) override { door_.stop(std::move(done)); }
    [[nodiscard]] bool hangs() const override { return door_.hangs(); }

private:
    std::string interface_name_;
    dds::DdsDoor door_;
};

void warn_dds_door(const Config& config, std::vector<ConfigFault>& out) {
    const auto& c = config.of<DdsSettings>();
    if (!c.enabled || c.interface_name == "lo" || !c.security.empty()) return;
    out.push_back(
        {"dds.security",
         fmt::format("DDS runs on the interface {} without certificates: every program that reaches the domain commands axes, by any name",
                     c.interface_name),
         "make certificates with `axisgate pki` and name their folder with [dds] security", true});
}
}  // namespace

const DoorDescriptor dds_door{
    .name = "dds",
    .words = &dds::door_words,
    .settings = dds_keys,
    .wanted = [](const Config& config) { return config.of<DdsSettings>().enabled; },
    .make = [](const DoorHouse& house, std::vector<ConfigFault>&) -> std::unique_ptr<RunningDoor> {
        return std::make_unique<RunningDds>(house);
    },
    .warn = warn_dds_door,
    .carries_mirrors = true,
};

}  // namespace axisgate
