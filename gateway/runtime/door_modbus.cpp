// The descriptor of the Modbus door: its keys, and one ModbusDoors for Modbus/TCP and Modbus RTU.
#include "gateway/runtime/door_modbus.hpp"

#include <fmt/core.h>
#include <sys/socket.h>

#include <array>

#include "gateway/doors/http/hosts.hpp"
#include "gateway/doors/modbus/access.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/runtime/late_doors.hpp"
#include "gateway/runtime/modbus_doors.hpp"
#include "gateway/runtime/warm_ports.hpp"
#include "gateway/store/store.hpp"

namespace axisgate {
namespace {
constexpr setting::Key modbus_keys[] = {
    {"modbus", "bind", [](Config& c, const std::string& s) { return setting::address(c.of<ModbusSettings>().bind, s); }},
    {"modbus", "idle_timeout_s",
     [](Config& c, const std::string& s) { return setting::whole_number(c.of<ModbusSettings>().idle_timeout_s, s, 1, 86400); },
     setting::Written::as_number},
    {"modbus", "max_connections",
     [](Config& c, const std::string& s) { return setting::whole_number(c.of<ModbusSettings>().max_connections, s, 1, 8192); },
     setting::Written::as_number},
    {"modbus", "allow",
     [](Config& config, const std::string& s) -> setting::Unfit {
         auto& c = config.of<ModbusSettings>();
         c.allow = setting::list_of(s);
         for (const auto& one : c.allow) {
             if (!modbus::parse_network(one))
                 return "write addresses or networks, such as [\"127.0.0.0/8\", \"192.168.1.20\", \"fd00::/8\"]";
         }
         return {};
     },
     setting::Written::as_list},
    {"modbus", "functions",
     [](Config& config, const std::string& s) -> setting::Unfit {
         auto& c = config.of<ModbusSettings>();
         c.functions = setting::list_of(s);
         for (const auto& one : c.functions) {
             std::int64_t ignored = 0;
             if (setting::whole_number(ignored, one, 1, 127)) return "write function codes from 1 to 127, such as [3, 4, 6, 16]";
         }
         return {};
     },
     setting::Written::as_list},
    {"modbus", "read_only", [](Config& c, const std::string& s) { return setting::on_or_off(c.of<ModbusSettings>().read_only, s); },
     setting::Written::as_switch},
    {"modbus_rtu", "port",
     [](Config& c, const std::string& s) { return setting::any_text(c.of<ModbusSettings>().rtu_port, s == "off" ? "" : s); }},
    {"modbus_rtu", "baud",
     [](Config& c, const std::string& s) {
         return setting::whole_number(c.of<ModbusSettings>().rtu_baud, s, SerialSettings::min_baud, SerialSettings::max_baud);
     },
     setting::Written::as_number},
    {"modbus_rtu", "format",
     [](Config& c, const std::string& s) -> setting::Unfit {
         const auto format = parse_serial_format(s);
         if (!format || format->data_bits != 8) return "write 8E1, 8O1, 8N1 or 8N2: Modbus RTU has 8 data bits";
         return setting::any_text(c.of<ModbusSettings>().rtu_format, s);
     }},
    {"modbus_rtu", "unit",
     [](Config& c, const std::string& s) { return setting::whole_number(c.of<ModbusSettings>().rtu_unit, s, 1, 247); },
     setting::Written::as_number},
};

class RunningModbus final : public RunningDoor {
public:
    RunningModbus(const DoorHouse& house, bool read_only)
        : bind_(house.config.of<ModbusSettings>().bind), doors_(house.hot, house.image, house.config, read_only) {
        if (doors_.any()) house.ports.modbus.use({[this] { return doors_.report(); }, [this](bool on) { doors_.set_read_only(on); }});
    }
    [[nodiscard]] std::string name() const override { return "Modbus"; }
    [[nodiscard]] bool on_hot() const override { return true; }
    [[nodiscard]] std::string open() override { return doors_.open(); }
    [[nodiscard]] bool is_late() const override { return address_is_late(bind_) || address_is_taken(bind_, SOCK_STREAM); }

private:
    std::string bind_;
    ModbusDoors doors_;
};

std::unique_ptr<RunningDoor> make_modbus_door(const DoorHouse& house, std::vector<ConfigFault>&) {
    bool read_only = house.config.of<ModbusSettings>().read_only;
    // A lock that was changed at run time is newer than the file.
    if (const auto kept = house.store.document("setting", "modbus.read_only"); kept && *kept) read_only = (*kept)->text == "true";
    return std::make_unique<RunningModbus>(house, read_only);
}

void check_modbus_door(const Config& c, const KeyPlace& place, std::vector<ConfigFault>& faults) {
    if (const RtuPort port = rtu_port(c); !port.fault.empty())
        faults.push_back({place("modbus_rtu", "port"), "modbus_rtu.port: " + port.fault,
                          "write the path of a serial port, such as /dev/ttyUSB0, or off"});
}

void warn_modbus_door(const Config& config, std::vector<ConfigFault>& out) {
    const auto& c = config.of<ModbusSettings>();
    if (c.bind.empty() || http::host_is_loopback(c.bind) || !c.allow.empty()) return;
    out.push_back({"modbus.allow",
                   fmt::format("Modbus/TCP listens beyond this machine ({}) and takes commands of every host that reaches it", c.bind),
                   "write the addresses or networks of the controllers, such as allow = [\"192.168.1.20\"]", true});
}
}  // namespace

RtuPort rtu_port(const Config& config) {
    const ModbusSettings& c = config.of<ModbusSettings>();
    RtuPort r;
    if (c.rtu_port.empty()) return r;
    r.used = true;
    const bool is_path = c.rtu_port.starts_with('/');
    const LineUriResult parsed =
        parse_line_uri(is_path ? "serial:" + c.rtu_port : c.rtu_port, static_cast<std::uint32_t>(c.rtu_baud), c.rtu_format);
    r.uri = parsed.uri;
    r.name = c.rtu_port.substr(0, c.rtu_port.find('?'));
    if (r.name.starts_with("serial:")) r.name = r.uri.path;
    r.fault = parsed.fault;
    if (!r.fault.empty()) return r;
    using Kind = LineUri::Kind;
    const bool says_rate = r.uri.kind == Kind::serial || (r.uri.kind == Kind::pty && r.uri.serial.baud != 0);
    r.baud = says_rate ? r.uri.serial.baud : static_cast<std::uint32_t>(c.rtu_baud);
    r.format = says_rate ? r.uri.serial.format : parse_serial_format(c.rtu_format).value_or(SerialFormat{});
    if (r.uri.kind == Kind::can || r.uri.kind == Kind::twin || r.uri.kind == Kind::udp || r.uri.kind == Kind::udp_listen) {
        r.fault = "Modbus RTU needs a line that carries bytes in order";
    } else if (r.format.data_bits != 8) {
        r.fault = "Modbus RTU has 8 data bits";
    }
    return r;
}

const DoorDescriptor modbus_door{
    .name = "modbus",
    .words = &modbus::door_words,
    .settings = modbus_keys,
    .wanted = [](const Config&) { return true; },  // made even without an address, because services ask it for its state
    .make = make_modbus_door,
    .clients = {.key = "[modbus] max_connections",
                .most =
                    [](const Config& config) {
                        const auto& c = config.of<ModbusSettings>();
                        return c.bind.empty() ? 0 : static_cast<std::uint64_t>(c.max_connections);
                    },
                .lessen = [](Config& config,
                             std::uint64_t most) { config.of<ModbusSettings>().max_connections = static_cast<std::int64_t>(most); }},
    .check = check_modbus_door,
    .warn = warn_modbus_door,
};

}  // namespace axisgate
