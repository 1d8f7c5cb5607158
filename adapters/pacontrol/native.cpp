// Verbs, part native: exchanges in the control's own language.
// In: Native as text or as bytes. Out: one exchange as it is given; its acknowledgement as text and as bytes.
// Never judges a command: any code goes out, and QUIT is an answer like others.
#include <fmt/core.h>

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {

void NativeText::run(Axis& a, const Reply* reply, Turn& t) {
    if (!reply) return start(a, Native(std::get<Native>(a.job.command.body)), t);
    if (reply->quit != 0 && a.job.request.code == code::abort_online) drive_.leaving = false;
    jobs_.over(a, Outcome::done, Reason::none, text_of(*reply), t, reply->quit, {}, drive_.port.raw_reply());
}

/// Text: "1900;5;0;0" is framed and gets its check; "EOT" is the poll. Bytes: one whole frame, or 04, as they are.
void NativeText::start(Axis& a, const Native& n, Turn& t) {
    std::string fault;
    if (n.is_text) {
        std::string text(n.send.begin(), n.send.end());
        while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
            text.pop_back();
        if (text == "EOT" || text == "eot") {
            return jobs_.ask_poll(a);
        }
        const auto r = request_of(text, fault);
        if (!r) return jobs_.refuse(a, Reason::out_of_range, fmt::format("{}; write for example 1900;5;0;0, or EOT for a poll", fault), t);
        return jobs_.ask(a, *r);
    }
    if (n.send.size() == 1 && n.send[0] == EOT) {
        return jobs_.ask_poll(a);
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
        return jobs_.refuse(
            a, Reason::out_of_range,
            fmt::format("{}: bytes must be one frame, 01 02 text 03 check 04, or 04 alone", fault.empty() ? "not one frame" : fault), t);
    }
    jobs_.ask(a, *r);
    a.job.raw = n.send;
}

}  // namespace axisgate::pacontrol
