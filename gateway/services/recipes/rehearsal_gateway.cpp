// Results and stored values are handed over after the engine's call has returned, as between the threads of the service.
#include "gateway/services/recipes/rehearsal_gateway.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/line_uri.hpp"

namespace axisgate {
namespace {

/// A line that never opens. A simulated site has none; the engine must get one all the same.
class NoLine final : public Line {
public:
    void open(LineEvents&, Instant) override {}
    void close() override {}
    bool send(const Frame&, Priority, Instant) override { return false; }
    [[nodiscard]] Instant deadline() const override { return never; }
    void on_deadline(Instant) override {}
    [[nodiscard]] LineStatus status(Instant) const override { return {}; }
};

}  // namespace

Site simulated_site(Site site, const Families& families) {
    for (LineSpec& line : site.lines) {
        const Family* family = families.find(line.family).family;
        const LineKind kind = kind_of(line, families);
        const auto uri = parse_line_uri(line.uri, family ? family->default_bit_rate : 0, family ? family->default_format : "");
        const bool serial = uri.good() && (uri.uri.kind == LineUri::Kind::serial || uri.uri.kind == LineUri::Kind::pty);
        if (serial && line.bitrate == 0) line.bitrate = uri.uri.serial.baud;
        if (family && family->uses_can && kind == LineKind::bytes) line.options["kind"] = "bytes";
        line.uri = "twin";
    }
    for (DriveSpec& drive : site.drives)
        drive.presence = PresenceRule::twin;
    return site;
}

RehearsalGateway::RehearsalGateway(const Families& families, Site site, const SiteMemory& memory, Duration lease)
    : RehearsalGateway(families, std::move(site), memory, lease, Outside()) {}

RehearsalGateway::RehearsalGateway(const Families& families, Site site, const SiteMemory& memory, Duration lease, Outside outside)
    : families_(families), outside_(std::move(outside)), now_(outside_.begin), engine_(families, *this, image_, outside_.trace_frames) {
    engine_.set_lease(lease);
    (void)engine_.apply_site(std::move(site), memory, 1, now_);
    deliver();
}

void RehearsalGateway::step(Instant due) {
    now_ = std::max(now_ + std::chrono::microseconds(1), std::min(due, engine_.wake_at()));
    engine_.on_deadline(now_);
    deliver();
}

void RehearsalGateway::advance(Instant now) {
    now_ = std::max(now_, now);
    engine_.on_deadline(now_);
    deliver();
}

const NonVolatile& RehearsalGateway::twin_memory(const std::string& drive) const {
    static const NonVolatile none;
    const auto it = memories_.find(drive);
    return it == memories_.end() ? none : it->second;
}

void RehearsalGateway::deliver() {
    while (!stored_.empty() || !results_.empty() || !given_.empty()) {
        for (Command& command : std::exchange(given_, {}))
            engine_.on_command(std::move(command), now_);
        for (const Ticket order : std::exchange(stored_, {}))
            engine_.on_stored(order, "", now_);
        for (const Result& result : std::exchange(results_, {})) {
            if (doors_.on_result(result)) continue;
            auto found = waiting_.extract(result.ticket);
            if (!found.empty()) found.mapped()(result);
        }
    }
}

bool RehearsalGateway::online(AxisId axis) const {
    const AxisPicture p = picture(axis);
    return p.ever_seen && (p.flags & flag_online) != 0 && (p.flags & flag_stale) == 0;
}

AxisPicture RehearsalGateway::picture(AxisId axis) const { return index_of(axis) < image_.size() ? image_.picture(axis) : AxisPicture{}; }

std::uint64_t RehearsalGateway::picture_revision(AxisId axis) const {
    return index_of(axis) < image_.size() ? image_.cell(axis).revision() : 0;
}

Ticket RehearsalGateway::submit(Command command, std::function<void(const Result&)> then) {
    const Ticket ticket = command.ticket = make_ticket(first_service_door, ++tickets_);
    waiting_.emplace(ticket, std::move(then));
    engine_.on_command(std::move(command), now_);
    return ticket;
}

void RehearsalGateway::apply_site(Site, std::uint64_t, Origin, std::function<void(SiteAnswer)> then) {
    SiteAnswer answer;
    answer.fault = "a rehearsal does not change its site";
    answer.now = site();
    then(std::move(answer));
}

std::unique_ptr<Line> RehearsalGateway::make_line(const LineSpec& spec, const LineSetup& setup) {
    return outside_.make_line ? outside_.make_line(spec, setup) : std::make_unique<NoLine>();
}

void RehearsalGateway::on_event(Event event, Instant) {
    if (event.severity == Severity::info) return;
    const std::string& name = !event.axis.empty() ? event.axis : !event.drive.empty() ? event.drive : event.line;
    last_warning_ = name.empty() ? event.text : fmt::format("{}: {}", name, event.text);
}

}  // namespace axisgate
