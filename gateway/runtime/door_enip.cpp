// The descriptor of the EtherNet/IP door: its keys, and its EDS for the service thread.
#include "gateway/runtime/door_enip.hpp"

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>

#include "gateway/doors/enip/server.hpp"
#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/http/hosts.hpp"
#include "gateway/protocols/cip/adapter.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/runtime/late_doors.hpp"
#include "gateway/runtime/warm_ports.hpp"

namespace axisgate {
namespace {
constexpr setting::Key enip_keys[] = {
    {"enip", "bind",
     [](Config& config, const std::string& s) {
         auto& c = config.of<EnipSettings>();
         c.bind_named = true;
         return setting::address(c.bind, s);
     }},
    {"enip", "io_port",
     [](Config& config, const std::string& s) {
         auto& c = config.of<EnipSettings>();
         c.io_port_named = true;
         return setting::whole_number(c.io_port, s, 0, 65535);
     },
     setting::Written::as_number},
};

/// Built from the site like the door's own layout, but on the calling thread.
std::string data_sheet(const SiteState& state, const Families& families, const enip::HostFacts& facts) {
    std::vector<std::shared_ptr<const Catalogue>> kept;
    std::vector<enip::LayoutAxis> axes;
    for (std::size_t i = 0; i < state.site.axes.size() && i < state.axis_ids.size(); ++i) {
        const AxisSpec& a = state.site.axes[i];
        const auto drive = std::ranges::find(state.site.drives, a.drive, &DriveSpec::name);
        if (drive == state.site.drives.end()) continue;
        kept.push_back(catalogue_of(state.site, *drive, families));
        axes.push_back({static_cast<std::uint16_t>(a.number), state.axis_ids[i], a.name, kept.back().get()});
    }
    return enip::eds_of(enip::Layout(std::move(axes), mapping_revision(state.site), facts, enip::windows_of(state)));
}

enip::ServerSettings server_settings(const Config& config) {
    const auto& c = config.of<EnipSettings>();
    enip::ServerSettings s;
    s.io_port = static_cast<std::uint16_t>(c.io_port);
    s.another_io_port = !c.io_port_named;
    s.lease_s = config.authority_lease_s;
    s.incarnation = static_cast<std::uint16_t>(unix_now_ns() / 1'000'000'000);
    return s;
}

class RunningEnip final : public RunningDoor {
public:
    explicit RunningEnip(const DoorHouse& house)
        : settings_(house.config.of<EnipSettings>()),
          families_(house.families),
          ports_(house.ports),
          server_(house.hot.context(), house.hot, house.image, server_settings(house.config)) {}
    [[nodiscard]] std::string name() const override { return "EtherNet/IP"; }
    [[nodiscard]] bool on_hot() const override { return true; }
    [[nodiscard]] std::string open() override { return server_.open(settings_.bind); }
    [[nodiscard]] bool is_late() const override {
        const std::string& bind = settings_.bind;
        return address_is_late(bind) || address_is_taken(bind, SOCK_STREAM) || address_is_taken(bind, SOCK_DGRAM);
    }
    [[nodiscard]] std::string left_out() const override {
        // Another program on this host uses the standard ports, and the configuration does not name other ones.
        return settings_.bind_named ? "" : "there is no EtherNet/IP door: name an address with [enip] bind, or \"off\"";
    }
    void opened() override {
        ports_.status.door_eds = [this] { return data_sheet(*ports_.site.site(), families_, server_.facts()); };
        if (const auto port = server_.facts().io_port; port != settings_.io_port)
            spdlog::warn("[enip] UDP {} is taken by another program: implicit data come on UDP {}, which each Forward_Open is told",
                         settings_.io_port, port);
    }

private:
    EnipSettings settings_;
    const Families& families_;
    WarmPorts& ports_;
    enip::Server server_;
};

void warn_enip_door(const Config& config, std::vector<ConfigFault>& out) {
    const auto& c = config.of<EnipSettings>();
    if (c.bind.empty() || http::host_is_loopback(c.bind)) return;
    out.push_back(
        {"enip.bind",
         fmt::format(
             "EtherNet/IP listens beyond this machine ({}) and takes commands of every host that reaches it; the protocol knows no users",
             c.bind),
         "listen on the address of the machine network alone and keep others out of it by a firewall, or set [enip] bind = \"off\"", true});
}
}  // namespace

const DoorDescriptor enip_door{
    .name = "ethernet_ip",
    .words = &enip::door_words,
    .settings = enip_keys,
    .wanted = [](const Config& config) { return !config.of<EnipSettings>().bind.empty(); },
    .make = [](const DoorHouse& house, std::vector<ConfigFault>&) -> std::unique_ptr<RunningDoor> {
        return std::make_unique<RunningEnip>(house);
    },
    .clients = {.most =
                    [](const Config& config) {
                        return config.of<EnipSettings>().bind.empty() ? 0 : static_cast<std::uint64_t>(cip::Adapter::most_sessions);
                    }},
    .warn = warn_enip_door,
};

}  // namespace axisgate
