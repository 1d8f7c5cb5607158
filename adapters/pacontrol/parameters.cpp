// Drive, part values: reading and writing points, and exchanges in the control's own language.
// In: ReadParameter, WriteParameter, Native. Out: get and put commands; values, samples.
// Never lets a parameter of the home position wait for ever: it waits a bounded time if the option `when` says so, else it is refused.
#include <fmt/core.h>

#include <cmath>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {

void Drive::run_value(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const bool writes = j.kind == Job::Kind::write;
    const Binding* b = elements_.binding(j.point);
    const std::string id = b ? catalogue_.id_of(j.point) : std::string("this point");
    const CommandInfo* c = b ? (writes ? b->write : b->read) : nullptr;
    if (!c) {
        return refuse(a, b ? Reason::not_supported : Reason::unknown_point,
                      fmt::format("{}: the serial port has no command to {} it", id, writes ? "write" : "read"), t);
    }
    if (!reply || (reply->quit == quit::inadmissible && c->home_only)) {
        if (c->home_only && mode_ >= 0 && (!is_home(mode_) || reply)) {
            const std::string why = fmt::format("{} can be {} in home position alone; operating status {}", id, writes ? "written" : "read",
                                                status_text(mode_));
            if (!options_.parameters_wait) return refuse(a, Reason::wrong_state, why + " (option when = wait lets it wait)", t);
            j.text = why;
            for (const Axis& x : axes_) {
                if (!is_online(mode_) || !powered_at_home(x)) continue;
                j.text += fmt::format(
                    "; axis {} may have power there by its enable mode (AP[50]), so ONLINE is not left for it: online.give_back leaves it",
                    x.channel);
                break;
            }
            return wait(a, j.limit == never ? t.now + options_.wait_limit : j.limit);
        }
        j.text.clear();
        return ask(a, writes ? Elements::write(*b, j.point, a.channel, std::get<WriteParameter>(j.command.body).value)
                             : Elements::read(*b, j.point, a.channel));
    }
    // Not executable, unknown: this type of control does not have it (following error and temperature are an EP's [L3098, L3140]).
    const bool lacks = reply->quit == quit::not_executable || reply->quit == quit::unknown_command;
    if (ended_by_quit(a, *reply, t, id, lacks ? Reason::not_supported : Reason::drive_refused)) return;
    Value v = Elements::value(*b, *reply);
    std::string text;
    if (writes) {
        const Value wanted = std::get<WriteParameter>(j.command.body).value;
        const auto x = as_number(wanted), y = as_number(v);
        // Acknowledgements carry seven digits: what differs less is the same value.
        const bool same = x && y && std::fabs(*x - *y) <= 1e-6 * std::max(1.0, std::fabs(*x));
        if (same) v = wanted;
        if (!same && c->answer != Carries::nothing)
            text = fmt::format("{}: {} was written, the control took {}", id, to_text(wanted), to_text(v));
    }
    sample(a, j.point, v, t);
    if (!writes && b->drive) {
        // What all axes share is asked once for all that wait for it: sixteen snapshots read the control's own parameters one time.
        for (Axis& x : axes_) {
            const bool same = x.job.kind == Job::Kind::read && x.job.want == Job::Want::send && x.job.point == j.point;
            if (&x != &a && same) job_over(x, Outcome::done, Reason::none, {}, t, 0, v);
        }
    }
    job_over(a, Outcome::done, Reason::none, std::move(text), t, 0, std::move(v));
}

/// Text: "1900;5;0;0" is framed and gets its check; "EOT" is the poll. Bytes: one whole frame, or 04, as they are.
void Drive::start_native(Axis& a, const Native& n, Turn& t) {
    Job& j = a.job;
    std::string fault;
    if (n.is_text) {
        std::string text(n.send.begin(), n.send.end());
        while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
            text.pop_back();
        if (text == "EOT" || text == "eot") {
            j.poll = true;
            j.want = Job::Want::send;
            return;
        }
        const auto r = request_of(text, fault);
        if (!r) return refuse(a, Reason::out_of_range, fmt::format("{}; write for example 1900;5;0;0, or EOT for a poll", fault), t);
        return ask(a, *r);
    }
    if (n.send.size() == 1 && n.send[0] == EOT) {
        j.poll = true;
        j.want = Job::Want::send;
        return;
    }
    std::optional<Request> r;
    bool whole = false;
    std::size_t events = 0;
    Framer framer;
    framer.push(n.send, {[&](std::string_view text, std::string_view) {
                             r = request_of(text, fault);
                             whole = ++events == 1 && r;
                         },
                         [&] { ++events; },
                         [&](FrameFault f, std::span<const std::uint8_t>) {
                             ++events;
                             fault = name_of(f);
                         }});
    if (!whole || events != 1 || !framer.pending().empty() || n.send.size() > Frame::capacity) {
        return refuse(
            a, Reason::out_of_range,
            fmt::format("{}: bytes must be one frame, 01 02 text 03 check 04, or 04 alone", fault.empty() ? "not one frame" : fault), t);
    }
    ask(a, *r);
    j.raw = n.send;
}

void Drive::run_native(Axis& a, const Reply* reply, Turn& t) {
    if (!reply) return;  // ready to be sent
    if (reply->quit != 0 && a.job.request.code == code::abort_online) leaving_ = false;
    job_over(a, Outcome::done, Reason::none, text_of(*reply), t, reply->quit, {}, raw_reply_);
}

}  // namespace axisgate::pacontrol
