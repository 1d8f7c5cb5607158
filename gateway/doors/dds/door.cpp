// Every 20 ms, changed states are written. Samples are read when the bus reports them, a bounded number of each topic at a time, so that
// many samples of other participants cannot block the service thread.
#include "gateway/doors/dds/door.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cmath>
#include <thread>

#include "gateway/core/parameter_form.hpp"
#include "gateway/core/plain_text.hpp"
#include "gateway/doors/dds/axis_sample.hpp"
#include "gateway/doors/dds/words.hpp"

namespace axisgate::dds {
namespace {
constexpr std::size_t at_a_time = 64;  ///< samples of a topic, before other work is done

template <class T>
WishedNumber wished(const T* value) {
    return value ? WishedNumber(static_cast<double>(*value)) : WishedNumber();
}

CommandWish wish_of(const axisgate_AxisCommand& s) {
    CommandWish wish = CommandWish::named(s.command);
    wish.position = wished(s.position);
    wish.velocity = wished(s.velocity);
    wish.acceleration = wished(s.acceleration);
    wish.deceleration = wished(s.deceleration);
    wish.method = wished(s.method);
    wish.hold_ms = wished(s.hold_ms);
    wish.prepare = s.prepare ? WishedFlag::yes : WishedFlag::no;
    wish.renew = s.renew ? WishedFlag::yes : WishedFlag::no;
    return wish;
}

SetPointWish wish_of(const axisgate_SetPoint& s) {
    SetPointWish wish;
    wish.mode = set_point_mode_of(s.mode);
    wish.value = s.value;
    wish.velocity = wished(s.velocity);
    wish.acceleration = wished(s.acceleration);
    wish.deceleration = wished(s.deceleration);
    if (s.good_for_ms != 0) wish.good_for_ms = static_cast<double>(s.good_for_ms);
    return wish;
}

/// NaN and infinity are refused with a separate text.
bool is_finite(const axisgate_AxisCommand& s) {
    return std::ranges::all_of(std::array{s.position, s.velocity, s.acceleration, s.deceleration},
                               [](const double* d) { return !d || std::isfinite(*d); });
}
}  // namespace

struct DdsDoor::Asked {
    std::string axis, source, id;
    std::uint64_t instance = 0;
    bool renews = false;   ///< the renewal of a held move: repeating it is harmless and begins no motion, so it is not remembered
    bool stops = false;    ///< a stop is carried out even if its names are wrong, repeatedly if necessary, and never refused because of a
                           ///< limit
    Bus::Writer writer{};  ///< the writer that has sent it
};

DdsDoor::DdsDoor(boost::asio::io_context& context, const Needs& ports, std::function<Instant()> clock, DoorSettings settings)
    : context_(context),
      ports_(ports),
      clock_(std::move(clock)),
      settings_(std::move(settings)),
      timer_(context),
      look_timer_(context),
      fleet_(settings_.name, settings_.instance,
             [this](const axisgate_AxisCommand& s) {
                 if (open_) (void)bus_->write(s);
             }),
      refusals_([this](Event e, AxisId) { ports_.get<EventPort>().note(std::move(e)); }),
      bus_(std::make_shared<Bus>([wake = wake_] { wake->ring(); })) {
    wake_->door = this;
}

void DdsDoor::Wake::ring() {
    const std::scoped_lock lock(mutex);
    if (door && !door->woken_.exchange(true, std::memory_order_acq_rel)) boost::asio::post(door->context_, [door = door] { door->read(); });
}

DdsDoor::~DdsDoor() {
    {
        const std::scoped_lock lock(wake_->mutex);
        wake_->door = nullptr;
    }
    if (open_) ports_.get<EventPort>().unlisten(this);
}

std::string DdsDoor::start() {
    settings_.bus.gateway = settings_.name;
    std::string fault = bus_->open(
        settings_.bus, {Topic::gateway_state, Topic::axis_state, Topic::event, Topic::axis_command, Topic::command_result},
        {Topic::gateway_state, Topic::axis_state, Topic::axis_command, Topic::command_result, Topic::parameter_write, Topic::set_point});
    if (!fault.empty()) return fault;
    open_ = true;
    ports_.get<EventPort>().listen(this);
    on_turn();
    if (settings_.want_change) settings_.want_change();
    return {};
}

std::string DdsDoor::address() const {
    if (!open_) return {};
    return fmt::format("{}@{}:{}%{}", settings_.name, settings_.bus.partition, settings_.bus.domain, settings_.bus.interface_name);
}

void DdsDoor::stop(std::function<void()> done) {
    if (open_) {
        open_ = false;
        mirrors_.clear();
        timer_.cancel();
        look_timer_.cancel();
        ports_.get<EventPort>().unlisten(this);
        close_bus(std::move(done));
        return;
    }
    boost::asio::post(context_, std::move(done));
}

/// If its interface is down, the library waits without a limit for a thread of its own, which only a packet on that interface wakes.
void DdsDoor::close_bus(std::function<void()> done) {
    {
        const std::scoped_lock lock(wake_->mutex);
        wake_->door = nullptr;
    }
    std::thread([bus = bus_, closed = closed_] {
        bus->close();  // its states are disposed together with their writers
        closed->store(true);
    }).detach();
    closing_ = true;
    wait_for_end(clock_() + close_within, std::move(done));
}

void DdsDoor::wait_for_end(Instant limit, std::function<void()> done) {
    if (*closed_ || clock_() >= limit) {
        boost::asio::post(context_, std::move(done));
        return;
    }
    timer_.expires_after(std::chrono::milliseconds(5));
    timer_.async_wait(
        [this, limit, done = std::move(done)](const boost::system::error_code&) mutable { wait_for_end(limit, std::move(done)); });
}

std::string DdsDoor::metrics() const {
    std::string s;
    const auto put = [&s](std::string_view name, std::string_view help, std::uint64_t value) {
        s += fmt::format("# HELP axisgate_dds_{0} {1}\n# TYPE axisgate_dds_{0} counter\naxisgate_dds_{0} {2}\n", name, help, value);
    };
    put("commands_total", "Commands and parameter writes that came.", counters_.commands);
    put("commands_repeated_total", "Those of them that had come before.", counters_.repeated);
    put("commands_refused_total", "Those of them that this door refused.", counters_.refused);
    put("set_points_total", "Streamed set-points that came.", counters_.set_points);
    put("set_points_wrong_total", "Those of them that could not be read or had no axis.", counters_.set_points_wrong);
    put("unsent_total", "States, events and results that could not be sent at once.", counters_.unsent);
    put("turned_away_total", "Samples that came and had no room, or were lost on their way.", open_ ? bus_->turned_away() : 0);
    put("left_out_total", "States of gateways and axes beyond as many as are kept.", fleet_.left_out());
    return s;
}

// --- sending ----------------------------------------------------------------------------------------------------------

void DdsDoor::on_turn() {
    if (!open_) return;
    const Instant now = clock_();
    if (!gateway_published_.time_since_epoch().count() || now - gateway_published_ >= published_again) tell_gateway(now);
    tell_axes(now);
    refusals_.flush(now);
    for (auto& event : fleet_.on_turn(now))
        ports_.get<EventPort>().note(std::move(event));
    mirrors_.remove_if([](const MirrorEnd& m) { return !m.is_open(); });
    for (auto& m : mirrors_)
        m.on_turn();
    std::erase_if(namesakes_, [this](std::uint64_t instance) { return !fleet_.alive(instance); });
    for (const auto& writer : std::exchange(gone_before_, {}))
        on_gone(writer);
    timer_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(turn));
    timer_.async_wait([this](const boost::system::error_code& ec) {
        if (!ec) on_turn();
    });
}

void DdsDoor::on_change() {
    if (!open_) return;
    tell_axes(clock_());
    // Not after each frame of a busy line: changes within this time are found afterwards, or by the periodic turn.
    look_timer_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(look_again));
    look_timer_.async_wait([this](const boost::system::error_code& ec) {
        if (!ec && open_) settings_.want_change();
    });
}

void DdsDoor::tell_gateway(Instant now) {
    gateway_published_ = now;
    const auto site = ports_.get<SitePort>().site();
    axisgate_GatewayState s{};
    put_text(s.gateway, settings_.name);
    s.instance = settings_.instance;
    put_text(s.version, settings_.version);
    s.at_unix_ns = ports_.get<ClockPort>().now_unix_ns();
    s.uptime_ms = static_cast<std::uint64_t>(ports_.get<StatusPort>().uptime_s() * 1000);
    s.site_revision = static_cast<std::uint32_t>(site->revision);
    s.axes = static_cast<std::uint32_t>(site->site.axes.size());
    for (const AxisId id : site->axis_ids)
        s.axes_online += (ports_.get<AxisPort>().picture(id).flags & flag_online) != 0 ? 1u : 0u;
    if (settings_.page) put_text(s.http, settings_.page());
    (void)fleet_.on_gateway(s, true, s.at_unix_ns, now);
    if (!bus_->write(s)) ++counters_.unsent;
}

void DdsDoor::tell_axes(Instant now) {
    const auto site = ports_.get<SitePort>().site();
    if (site != site_) {
        for (const auto& old : axes_) {
            if (index_of_name(site->site.axes, old.name)) continue;
            axisgate_AxisState gone{};
            put_text(gone.gateway, settings_.name);
            put_text(gone.axis, old.name);
            fleet_.on_axis(gone, false, false);
            (void)bus_->dispose(gone);
        }
        axes_.assign(site->site.axes.size(), {});
        for (std::size_t i = 0; i < axes_.size(); ++i)
            axes_[i].name = site->site.axes[i].name;
        commanders_.keep([&site](const std::string& axis) { return index_of_name(site->site.axes, axis).has_value(); });
        site_ = site;
    }
    for (std::size_t i = 0; i < axes_.size() && i < site->axis_ids.size(); ++i) {
        Published& t = axes_[i];
        const auto revision = ports_.get<AxisPort>().picture_revision(site->axis_ids[i]);
        if (t.ever && now - t.at < (t.revision == revision ? published_again : turn)) continue;
        axisgate_AxisState s{};
        fill(s, axis_at(ports_.get<SitePort>(), site, i));
        fleet_.on_axis(s, true, true);
        if (!bus_->write(s)) {
            ++counters_.unsent;
            continue;  // repeated in the next turn
        }
        t.ever = true;
        t.revision = revision;
        t.at = now;
    }
}

void DdsDoor::fill(axisgate_AxisState& s, const AxisPlace& place) {
    const AxisPicture p = ports_.get<AxisPort>().picture(place.id());
    put_text(s.gateway, settings_.name);
    put_text(s.axis, place.spec().name);
    s.instance = settings_.instance;
    put_text(s.family, place.family);
    put_text(s.unit, place.spec().unit);
    s.increments_per_unit = place.spec().increments_per_unit;
    s.at_unix_ns = p.ever_seen ? ports_.get<ClockPort>().to_unix_ns(p.at) : 0;
    put_points<axis_point_table, axis_state_members>(s, p);
    s.count = ++sequence_;
}

void DdsDoor::on_event(const Event& e) {
    axisgate_Event s{};
    put_text(s.gateway, settings_.name);
    s.id = e.id;
    s.at_unix_ns = e.at_unix_ns;
    put_text(s.severity, axisgate::name_of(e.severity));
    put_text(s.kind, e.kind);
    put_text(s.axis, e.axis);
    put_text(s.drive, e.drive);
    put_text(s.line, e.line);
    s.code = e.code;
    put_text(s.text, e.text);
    put_text(s.who, e.who);
    put_text(s.door, e.door);
    put_text(s.parameter, e.parameter);
    put_text(s.old_value, e.old_value);
    put_text(s.new_value, e.new_value);
    if (!bus_->write(s)) ++counters_.unsent;
}

// --- reading ----------------------------------------------------------------------------------------------------------

void DdsDoor::read() {
    // An exchange, not a store: samples that were announced before are read below.
    (void)woken_.exchange(false, std::memory_order_acq_rel);
    if (!open_) return;
    bool more = false;
    const auto all = [this, &more](auto* kind, auto each) {
        using Sample = std::remove_pointer_t<decltype(kind)>;
        more = bus_->take<Sample>(at_a_time, each) == at_a_time || more;
    };
    const auto mine = [this](const auto& s) { return settings_.name == s.gateway; };
    all(static_cast<axisgate_GatewayState*>(nullptr), [this](const auto& s, const Bus::Seen& seen) { on_gateway(s, seen); });
    all(static_cast<axisgate_AxisState*>(nullptr), [this](const auto& s, const Bus::Seen& seen) {
        fleet_.on_axis(s, seen.valid, seen.alive);
        tell_mirrors(s.gateway, s.axis);
    });
    all(static_cast<axisgate_CommandResult*>(nullptr), [this](const auto& s, const Bus::Seen& seen) {
        if (seen.valid) fleet_.on_result(s);
    });
    all(static_cast<axisgate_AxisCommand*>(nullptr), [this, mine](const auto& s, const Bus::Seen& seen) {
        if (seen.valid && mine(s)) on_command(s, seen);
    });
    all(static_cast<axisgate_ParameterWrite*>(nullptr), [this, mine](const auto& s, const Bus::Seen& seen) {
        if (seen.valid && mine(s)) on_parameter_write(s, seen);
    });
    all(static_cast<axisgate_SetPoint*>(nullptr), [this, mine](const auto& s, const Bus::Seen& seen) {
        if (mine(s)) on_set_point(s, seen);
    });
    look_for_gone();
    // The remaining samples are read after all other waiting work.
    if (more && !woken_.exchange(true, std::memory_order_acq_rel)) boost::asio::post(context_, [this] { read(); });
}

void DdsDoor::on_gateway(const axisgate_GatewayState& s, const Bus::Seen& seen) {
    if (s.instance == settings_.instance) return;  // only this process reports its own state
    if (auto published = fleet_.on_gateway(s, seen.valid && seen.alive, ports_.get<ClockPort>().now_unix_ns(), clock_()))
        ports_.get<EventPort>().note(std::move(*published));
    if (settings_.name != s.gateway) return;
    if (!seen.alive) {
        namesakes_.erase(s.instance);
        return;
    }
    if (namesakes_.size() >= 64 || !namesakes_.insert(s.instance).second) return;
    Event e;
    e.severity = Severity::warning;
    e.kind = "fleet";
    e.door = "dds";
    e.text = fmt::format(
        "another gateway of the domain is called {} as well (its page: {}): commands over DDS must name the instance that they are for; "
        "give one of them another name ([dds] name)",
        settings_.name, s.http[0] ? s.http : "none");
    ports_.get<EventPort>().note(std::move(e));
}

namespace {
constexpr std::size_t whereabouts_most = 1024;
std::string name_for(const std::string& source) { return source.empty() ? "without a name" : one_line(source); }
}  // namespace

std::string DdsDoor::whereabouts(const Bus::Writer& writer) {
    auto known = whereabouts_.find(writer.handle);
    if (known != whereabouts_.end()) return known->second;
    std::string where = one_line(bus_->whereabouts(writer));
    if (where.empty()) return where;  // it may become known shortly
    if (whereabouts_.size() >= whereabouts_most) whereabouts_.clear();
    return whereabouts_.emplace(writer.handle, std::move(where)).first->second;
}

Origin DdsDoor::origin_of(const std::string& source, const Bus::Writer& writer) {
    Origin o{clients, nullptr, std::make_shared<const std::string>(name_for(source))};
    const std::string where = whereabouts(writer);
    o.who = where.empty() ? o.client : std::make_shared<const std::string>(fmt::format("{} ({})", *o.client, where));
    return o;
}

AuthorityClient DdsDoor::client_of(const std::string& source) {
    return AuthorityClient::of({clients, nullptr, std::make_shared<const std::string>(name_for(source))});
}

bool DdsDoor::to_be_done(const Asked& a) {
    if (a.source.empty() || a.id.empty()) {
        if (a.stops) return true;  // repeating a stop is harmless
        refuse(a, Reason::out_of_range, "a command over DDS has a source and an id, so that it is never carried out twice; name both");
        return false;
    }
    if (!is_plain(a.source) || !is_plain(a.id)) {
        if (a.stops) return true;
        refuse(a, Reason::out_of_range, "source and id are texts without line ends, control characters and changes of direction");
        return false;
    }
    const auto seen = a.renews ? CommandsSeen::Seen{} : seen_.begin(a.source, a.id, clock_(), a.writer.handle);
    switch (seen.stage) {
        case CommandsSeen::Stage::under_way:
            ++counters_.repeated;
            return false;  // its result is outstanding
        case CommandsSeen::Stage::answered:
            ++counters_.repeated;
            tell_again(a.axis);
            answer(a, *seen.result, true);
            return false;
        case CommandsSeen::Stage::no_room:
            if (a.stops) return true;
            refuse(a, Reason::busy, "too many commands came over DDS in the last minutes; send it again later");
            return false;
        case CommandsSeen::Stage::is_new:
            break;
    }
    const auto no = [this, &a](Outcome outcome, Reason reason, std::string text) {
        Result r;
        r.outcome = outcome;
        r.reason = reason;
        r.text = std::move(text);
        ++counters_.refused;
        seen_.end(a.source, a.id, r, clock_());
        answer(a, r, false);
        return false;
    };
    if (a.instance != 0 && a.instance != settings_.instance && !a.stops) {
        return no(
            Outcome::failed, Reason::no_answer,
            fmt::format("{} has been started anew since the command was made, and does not know whether it was carried out before; look "
                        "at the axis, and give a new command if it is still wanted",
                        settings_.name));
    }
    if (a.instance == 0 && !namesakes_.empty() && !a.stops) {
        return no(Outcome::refused, Reason::wrong_state,
                  fmt::format("two gateways of the domain are called {}; name the instance that the command is for", settings_.name));
    }
    return true;
}

void DdsDoor::on_command(const axisgate_AxisCommand& s, const Bus::Seen& seen) {
    const std::string_view name(s.command);
    const Asked a{s.axis, s.source, s.id, s.instance, s.renew, is_stop(name), {Topic::axis_command, seen.writer}};
    ++counters_.commands;
    if (!to_be_done(a)) return;
    const auto place = find_axis(ports_.get<SitePort>(), a.axis);
    if (!place) return refuse(a, Reason::unknown_point, fmt::format("{} has no axis {}", settings_.name, a.axis));
    if (!is_finite(s)) return refuse(a, Reason::out_of_range, fmt::format("{}: a value is infinite or not a number", s.command));
    auto made = make_command(wish_of(s), place->spec().increments_per_unit, place->spec().unit);
    if (!made.body) {
        const auto& f = made.faults.front();
        return refuse(a, Reason::out_of_range, f.text + (f.remedy.empty() ? "" : "; " + f.remedy));
    }
    if (!a.source.empty()) note_commander(a, a.writer);
    carry_out(a, *place, std::move(*made.body), s.until_done);
}

void DdsDoor::on_parameter_write(const axisgate_ParameterWrite& s, const Bus::Seen& seen) {
    const Asked a{s.axis, s.source, s.id, s.instance, false, false, {Topic::parameter_write, seen.writer}};
    ++counters_.commands;
    if (!to_be_done(a)) return;
    const auto place = find_axis(ports_.get<SitePort>(), a.axis);
    if (!place || !place->catalogue) return refuse(a, Reason::unknown_point, fmt::format("{} has no axis {}", settings_.name, a.axis));
    const auto point = place->catalogue->find(s.parameter);
    const Parameter* parameter = point ? place->catalogue->parameter(*point) : nullptr;
    if (!parameter) return refuse(a, Reason::unknown_point, fmt::format("{} has no parameter {}", a.axis, s.parameter));
    if (!parameter->writable()) return refuse(a, Reason::not_writable, fmt::format("{} can only be read", s.parameter));
    const auto value = parse_value(s.value, parameter->type);
    if (!value)
        return refuse(a, Reason::out_of_range,
                      fmt::format("{}: {} is no value of its type ({})", s.parameter, s.value, axisgate::name_of(parameter->type)));
    const auto& parameters = ports_.get<ParameterPort>();
    auto checked = check_write_now(*place->catalogue, *point, *value,
                                   [&parameters, id = place->id()](Point p) { return parameters.live(id, p).value; });
    if (!checked.fault.empty()) return refuse(a, Reason::out_of_range, checked.fault);
    note_commander(a, a.writer);
    carry_out(a, *place, WriteParameter{*point, std::move(checked.value)}, false);
}

void DdsDoor::note_commander(const Asked& asked, const Bus::Writer& writer) {
    if (commanders_.note(asked.axis, asked.source, writer) && !bus_->is_there(writer) && gone_before_.size() < Bus::gone_most)
        gone_before_.push_back(writer);
}

void DdsDoor::look_for_gone() {
    for (const auto& writer : bus_->take_gone([this] { return commanders_.writers(); }))
        on_gone(writer);
}

void DdsDoor::on_gone(const Bus::Writer& writer) {
    for (const auto& source : commanders_.gone(writer))
        ports_.get<AxisPort>().client_lost(client_of(source), loss_deadline);
}

void DdsDoor::carry_out(const Asked& asked, const AxisPlace& place, CommandBody body, bool until_done) {
    Command c;
    c.axis = place.id();
    c.body = std::move(body);
    c.until_done = until_done;
    c.origin = origin_of(asked.source, asked.writer);
    (void)ports_.get<AxisPort>().submit(std::move(c), [this, asked](const Result& r) {
        seen_.end(asked.source, asked.id, r, clock_());
        tell_again(asked.axis);
        answer(asked, r, false);
    });
}

/// Written in the next turn even without a change, for readers that wait for a state that is newer than an answer.
void DdsDoor::tell_again(const std::string& axis) {
    const auto it = std::ranges::find(axes_, axis, &Published::name);
    if (it != axes_.end()) it->ever = false;
}

void DdsDoor::tell_mirrors(std::string_view gateway, std::string_view axis) {
    for (auto& m : mirrors_)
        m.on_axis(gateway, axis);
}

void DdsDoor::take_mirror(int fd) {
    mirrors_.emplace_back(
        context_, fd, fleet_, [this] { return ports_.get<ClockPort>().now_unix_ns(); }, clock_);
    if (!open_) mirrors_.pop_back();  // the line detects that its other end is closed
}

void DdsDoor::refuse(const Asked& asked, Reason reason, std::string text) {
    ++counters_.refused;
    Result r;
    r.outcome = Outcome::refused;
    r.reason = reason;
    r.text = std::move(text);
    // A command that was refused for lack of space is not recorded and may be repeated.
    seen_.end(asked.source, asked.id, r, clock_());
    answer(asked, r, false);
}

void DdsDoor::answer(const Asked& asked, const Result& r, bool repeated) {
    if (r.outcome == Outcome::refused && !repeated) {
        Event e;
        e.kind = "refused";
        e.severity = Severity::warning;
        e.axis = one_line(asked.axis);
        e.who = *origin_of(asked.source, asked.writer).who;
        e.door = std::string(axisgate::name_of(clients));
        e.text = fmt::format("{} ({})", one_line(r.text), axisgate::name_of(r.reason));
        const std::string where = whereabouts(asked.writer);
        const std::string host = where.empty() ? e.who : where;
        refusals_.add(host, no_axis, std::move(e), {}, clock_());
    }
    axisgate_CommandResult s{};
    put_text(s.gateway, settings_.name);
    put_text(s.axis, asked.axis);
    put_text(s.source, asked.source);
    put_text(s.id, asked.id);
    s.instance = settings_.instance;
    put_text(s.outcome, axisgate::name_of(r.outcome));
    put_text(s.reason, axisgate::name_of(r.reason));
    s.code = r.code;
    put_text(s.text, r.text);
    s.repeated = repeated;
    s.count = sequence_;
    if (!bus_->write(s)) ++counters_.unsent;  // a sender that misses it repeats the command
}

void DdsDoor::command(FleetOrder order, std::function<void(const Result&)> then) {
    const bool stops = is_stop(order.wish.word);
    if (order.gateway != settings_.name) return fleet_.command(order, std::move(then), clock_());
    if (!stops) {
        Result fault;
        const FleetGateway* g = fleet_.target(order, fault);
        return g && g->here ? command_here(std::move(order), std::move(then)) : fleet_.command(order, std::move(then), clock_());
    }
    // Carried out here and at all other gateways with this name: both give one result.
    if (!fleet_.has_other(order.gateway)) return command_here(std::move(order), std::move(then));
    const auto both = [answers = std::make_shared<std::vector<Result>>(), then = std::move(then), name = settings_.name](const Result& r) {
        answers->push_back(r);
        if (answers->size() < 2) return;
        // A gateway that does not exist any more may be a previous start of a running one.
        const auto silent = std::ranges::find(*answers, Reason::no_answer, &Result::reason);
        const auto stopped = std::ranges::find_if(*answers, [](const Result& one) { return good(one); });
        if (silent == answers->end() || stopped == answers->end()) return then(Fleet::together(*answers, name));
        Result mixed = *stopped;
        mixed.text += fmt::format("{}another gateway called {} has not answered", mixed.text.empty() ? "" : "; ", name);
        then(mixed);
    };
    command_here(order, both);
    fleet_.command(order, both, clock_());
}

void DdsDoor::command_here(FleetOrder order, std::function<void(const Result&)> then) {
    Result fault;
    const auto place = find_axis(ports_.get<SitePort>(), order.axis);
    auto made = place ? make_command(order.wish, place->spec().increments_per_unit, place->spec().unit) : ReadCommand{};
    if (!made.body) {
        fault.outcome = Outcome::refused;
        fault.reason = place ? Reason::out_of_range : Reason::unknown_point;
        fault.text = place ? made.faults.front().text : fmt::format("{} has no axis {}", settings_.name, order.axis);
        return then(fault);
    }
    Command c;
    c.axis = place->id();
    c.body = std::move(*made.body);
    c.until_done = order.until_done;
    c.origin = std::move(order.origin);
    (void)ports_.get<AxisPort>().submit(std::move(c), std::move(then));
}

void DdsDoor::on_set_point(const axisgate_SetPoint& s, const Bus::Seen& seen) {
    if (!seen.alive) {
        // It has no writer any more, or the host of its writer is gone: the streamed motion ends by the fail-safe rule of the axis.
        if (const auto it = set_points_.find(s.axis); it != set_points_.end()) {
            ports_.get<AxisPort>().client_lost(client_of(it->second), LossCause::set_points_silent);
            set_points_.erase(it);
        }
    }
    if (!seen.valid) return;
    ++counters_.set_points;
    const auto place = find_axis(ports_.get<SitePort>(), s.axis);
    const bool numbers = std::ranges::all_of(std::array<const double*, 4>{&s.value, s.velocity, s.acceleration, s.deceleration},
                                             [](const double* d) { return !d || std::isfinite(*d); });
    if (!place || s.source[0] == 0 || !is_plain(s.source) || !numbers) {
        ++counters_.set_points_wrong;
        return;
    }
    auto made = make_set_point(wish_of(s), place->spec().increments_per_unit, place->spec().unit);
    if (!made.set_point) {
        ++counters_.set_points_wrong;
        return;
    }
    made.set_point->axis = place->id();
    made.set_point->at = clock_();
    made.set_point->origin = origin_of(s.source, {Topic::set_point, seen.writer});
    if (set_points_.size() < set_point_clients_most || set_points_.contains(s.axis)) set_points_[s.axis] = s.source;
    ports_.get<AxisPort>().set_point(std::move(*made.set_point));
}

}  // namespace axisgate::dds
