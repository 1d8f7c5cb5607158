// A serial port that does not exist is not a fault: adapters are plugged in later.
#include "gateway/runtime/modbus_doors.hpp"

#include <utility>

#include "gateway/doors/modbus/words.hpp"
#include "gateway/lines/make_line.hpp"
#include "gateway/runtime/clock.hpp"

namespace axisgate {
namespace {
modbus::Responder::Settings responder_settings(const ModbusSettings& c, bool read_only) {
    modbus::Responder::Settings s;
    s.version = AXISGATE_VERSION;
    for (const auto& text : c.allow) {
        if (const auto network = modbus::parse_network(text)) s.access.allow.push_back(*network);
    }
    for (const auto& text : c.functions)
        s.access.functions.set(static_cast<std::size_t>(std::stoi(text)));
    s.access.read_only = read_only;
    return s;
}
}  // namespace

ModbusDoors::ModbusDoors(Hot& hot, registers::RegisterImage& image, const Config& config, bool read_only)
    : hot_(hot), settings_(config.of<ModbusSettings>()) {
    if (!settings_.bind.empty()) {
        modbus::ServerSettings s;
        s.responder = responder_settings(settings_, read_only);
        s.max_connections = static_cast<std::size_t>(settings_.max_connections);
        s.idle_timeout = std::chrono::seconds(settings_.idle_timeout_s);
        tcp_ = std::make_unique<modbus::Server>(hot.context(), hot, image, std::move(s));
    }
    if (const RtuPort port = rtu_port(config); port.used && port.fault.empty()) {
        modbus::RtuSettings s;
        s.responder = responder_settings(settings_, read_only);
        s.timing = modbus::RtuTiming::of(port.baud, port.format.bits_per_byte());
        s.address = static_cast<std::uint8_t>(settings_.rtu_unit);
        s.port = port.name;
        s.text = to_text(port.uri);
        const LineBase base{hot.context(), machine_clock(), {}, stale_send_limit};
        rtu_ = std::make_unique<modbus::RtuDoor>(hot.context(), hot, image, std::move(s), make_line(port.uri, base));
    }
}

std::string ModbusDoors::open() {
    if (rtu_ && !std::exchange(rtu_opened_, true)) rtu_->open();
    if (!tcp_) return {};
    const std::string binds[] = {settings_.bind};
    return tcp_->open(binds);
}

void ModbusDoors::add(ModbusReport& report, ModbusConnection connection, std::string_view host) const {
    const auto& site = *hot_.engine().site();
    for (std::size_t i = 0; i < site.axis_ids.size(); ++i) {
        const AxisPicture& p = hot_.image().picture(site.axis_ids[i]);
        if (p.authority == modbus::clients && p.authority_holder[0] != 0 && host == p.authority_holder.data())
            connection.holds.push_back(site.site.axes[i].name);
    }
    report.connections.push_back(std::move(connection));
}

ModbusReport ModbusDoors::report() const {
    ModbusReport r;
    r.allow = settings_.allow;
    r.functions = settings_.functions;
    if (tcp_) {
        const auto addresses = tcp_->addresses();
        if (!addresses.empty()) r.bind = addresses.front();
        r.read_only = tcp_->responder().access().read_only;
        for (const auto& c : tcp_->connections())
            add(r, {c.peer, c.requests, c.writes, c.exceptions, unix_ns_of(c.since), {}},
                std::string_view(c.peer).substr(0, c.peer.rfind(':')));
    }
    if (rtu_) {
        r.read_only = rtu_->responder().access().read_only;
        if (const auto c = rtu_->report(); c.up) {
            Origin origin;
            origin.door = modbus::clients;
            origin.who = std::make_shared<const std::string>(c.peer);
            add(r, {c.peer, c.requests, c.writes, c.exceptions, unix_ns_of(c.since), {}}, AuthorityClient::of(origin).name);
        }
    }
    return r;
}

void ModbusDoors::set_read_only(bool on) {
    if (tcp_) tcp_->responder().set_read_only(on);
    if (rtu_) rtu_->responder().set_read_only(on);
}

}  // namespace axisgate
