// Verbs, part parameters: reading and writing points.
// In: ReadParameter, WriteParameter. Out: get and put commands; values, samples.
// Never lets a parameter of the home position wait for ever: it waits a bounded time if the option `when` says so, else it is refused.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {

/// It waits for home position, or is refused.
void Parameters::not_here(Axis& a, const std::string& id, Turn& t) {
    Job& j = a.job;
    j.text =
        fmt::format("{} can be {} in home position alone; {}", id, j.kind == Job::Kind::write ? "written" : "read", drive_.mode_text());
    if (!drive_.options.parameters_wait) return jobs_.refuse(a, Reason::wrong_state, j.text + " (option when = wait lets it wait)", t);
    const auto powered =
        std::ranges::find_if(drive_.axes, [&](const Axis& x) { return is_online(drive_.mode) && drive_.powered_at_home(x); });
    if (powered != drive_.axes.end())
        j.text += fmt::format(
            "; axis {} may have power there by its enable mode (AP[50]), so ONLINE is not left for it: online.give_back leaves it",
            powered->channel);
    jobs_.wait(a, j.limit == never ? t.now + drive_.options.wait_limit : j.limit);
}

void Parameters::run(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const auto* write = std::get_if<WriteParameter>(&j.command.body);
    j.point = write ? write->point : std::get<ReadParameter>(j.command.body).point;
    const Binding* b = drive_.bus.elements.binding(j.point);
    const std::string id = b ? drive_.bus.catalogue.id_of(j.point) : std::string("this point");
    const CommandInfo* c = b ? (write ? b->write : b->read) : nullptr;
    if (!c)
        return jobs_.refuse(a, b ? Reason::not_supported : Reason::unknown_point,
                            fmt::format("{}: the serial port has no command to {} it", id, write ? "write" : "read"), t);
    if (!reply || (reply->quit == quit::inadmissible && c->home_only)) {
        if (c->home_only && drive_.mode >= 0 && (!is_home(drive_.mode) || reply)) return not_here(a, id, t);
        j.text.clear();
        return jobs_.ask(a, write ? Elements::write(*b, j.point, a.channel, write->value) : Elements::read(*b, j.point, a.channel));
    }
    // Not executable, unknown: this type of control does not have it (following error and temperature are an EP's [L3098, L3140]).
    const bool lacks = reply->quit == quit::not_executable || reply->quit == quit::unknown_command;
    if (jobs_.ended_by_quit(a, *reply, t, id, lacks ? Reason::not_supported : Reason::drive_refused)) return;
    Value v = Elements::value(*b, *reply);
    std::string text;
    if (write) {
        const Value& wanted = write->value;
        const auto x = as_number(wanted), y = as_number(v);
        // Acknowledgements carry seven digits: what differs less is the same value.
        const bool same = x && y && std::fabs(*x - *y) <= 1e-6 * std::max(1.0, std::fabs(*x));
        if (same) v = wanted;
        if (!same && c->answer != Carries::nothing)
            text = fmt::format("{}: {} was written, the control took {}", id, to_text(wanted), to_text(v));
    }
    drive_.sample(a, j.point, v, t);
    if (!write && b->drive) {
        // What all axes share is asked once for all that wait for it: sixteen snapshots read the control's own parameters one time.
        for (Axis& x : drive_.axes) {
            const bool same = x.job.kind == Job::Kind::read && x.job.want == Job::Want::send && x.job.point == j.point;
            if (&x != &a && same) jobs_.over(x, Outcome::done, Reason::none, {}, t, 0, v);
        }
    }
    jobs_.over(a, Outcome::done, Reason::none, std::move(text), t, 0, std::move(v));
}

}  // namespace axisgate::pacontrol
