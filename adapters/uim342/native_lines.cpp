// NativeLines: lines of the drive's own language, whoever writes them: a person, or an action's row below.
// In: Native, Action. Out: exchanges; what the drive said to each, in words and as bytes.
// Never lets anything between MF and its value: group values go as a pair inside one job.
#include <fmt/core.h>

#include <algorithm>
#include <span>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
bool selects(const Message& m) { return m.function() == cw::MF && form_of(m) == Form::set && m.d[0] != 0; }
}  // namespace

void NativeLines::plan(const Command& command, Turn& t) {
    system_.reset();
    job().partial = true;
    NativeScript script;
    if (const auto* native = std::get_if<Native>(&command.body)) {
        const std::span<const std::uint8_t> bytes(native->send);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        script = native->is_text ? parse_native(drive_.address(), text) : parse_native(drive_.address(), bytes);
    } else if (const auto* action = std::get_if<Action>(&command.body)) {
        const std::string text = script_of(*action, drive_.bus.catalogue);
        if (text.empty()) {
            return refuse(Reason::unknown_point,
                          fmt::format("{} is not an action of the UIM342; there are reboot, factory_defaults, clear_status, clear_error, "
                                      "start_group, global_stop, and the instructions by name",
                                      action->name),
                          t);
        }
        script = parse_native(drive_.address(), text);
    } else {
        return refuse(Reason::not_supported, fmt::format("{} is nothing that a drive can do", name_of(command.body)), t);
    }
    if (!script.fault.empty()) return refuse(Reason::out_of_range, std::move(script.fault), t);
    plan_messages(script.messages, t);
}

std::string script_of(const Action& action, const Catalogue& catalogue) {
    if (action.name == "reboot") return "SY[1]";
    if (action.name == "factory_defaults") return "SY[2]";
    if (action.name == "clear_status") return "MS[0]=0";
    if (action.name == "clear_error") return "ER[0]=0";
    // Any instruction of the catalogue by its id or name; the argument is what follows it: "[1]", "=5", "[0]=16", or a number.
    const auto commands = catalogue.commands();
    const auto c = std::ranges::find_if(commands, [&](const auto& row) { return row.id == action.name || row.name == action.name; });
    if (c == commands.end()) return {};
    const std::string& a = action.argument;
    if (a.empty() || a.starts_with('[') || a.starts_with('=')) return c->id + a;
    const Instruction* i = instruction_named(c->id);
    return i && i->indexed ? fmt::format("{}[{}]", c->id, a) : fmt::format("{}={}", c->id, a);
}

void NativeLines::plan_messages(const std::vector<Message>& messages, Turn& t) {
    Job& j = job();
    bool blind = false;
    for (std::size_t n = 0; n < messages.size(); ++n) {
        const Message& m = messages[n];
        const Instruction* i = instruction(m.cw);
        Step step{m};
        if (n > 0 && selects(messages[n - 1])) step.mf = messages[n - 1].d[0];
        if (selects(m)) {
            const Instruction* next = n + 1 < messages.size() ? instruction(messages[n + 1].cw) : nullptr;
            if (!next || !next->takes_mf) {
                return refuse(
                    Reason::wrong_state,
                    fmt::format("MF={0} alone would be used up by anything that comes between: write MF={0};AC=1000 in one line", m.d[0]),
                    t);
            }
            step.select = m.wants_ack();
        }
        if (i && i->cw == cw::SY) {
            if (n + 1 != messages.size()) return refuse(Reason::wrong_state, "SY must be the last of a line", t);
            step.message.cw &= static_cast<std::uint8_t>(~ack_bit);  // it never acknowledges [L1216]
            system_ = m.d[0];
            blind = true;
        }
        blind = blind || !m.wants_ack();
        j.add_step(step);
    }
    if (!blind || system_ == 1) return;
    Step check{messages.back().function() == cw::MS ? drive_.get(cw::MO) : drive_.get(cw::MS, 1)};
    check.check = true;
    j.add_step(check);
}

void NativeLines::keep(const Message& m, std::vector<std::uint8_t>& bytes) {
    bytes.insert(bytes.end(), {m.cw, m.dl});
    bytes.insert(bytes.end(), m.d.begin(), m.d.begin() + m.dl);
}

void NativeLines::answered(const Step& step, const Message* answer, Turn& t) {
    if (step.check) return;
    std::string& s = job().text;
    if (!s.empty()) s += "; ";
    s += answer ? describe_answer(*answer) : describe_request(step.message) + " sent";
    if (answer) keep(*answer, job().bytes);
    if (step.message.function() == cw::BG) drive_.feedback.begin_motion({Motion::Kind::unknown}, t);
    if (!answer) {
        if (Known::changes_rates(step.message)) drive_.start.read_again();
        return;
    }
    if (step.message.function() == cw::OG) drive_.feedback.origin_set(false, t);
    drive_.polls.soon(t.now);
}

void NativeLines::done(Turn& t) {
    if (system_ == 1) return restart(t);
    if (system_) {
        drive_.start.read_all();  // the factory settings are in force now
        drive_.polls.soon(t.now);
    }
    const bool taken = std::holds_alternative<Action>(job().command.body) && !job().command.until_done;
    taken ? accept(job().text, t) : succeed(job().text, t);
}

/// SY[1] has been sent; nothing acknowledges it.
void NativeLines::restart(Turn& t) {
    const Job was = drive_.jobs.hand_over();
    const Ticket ticket = was.command.ticket;
    const bool action = std::holds_alternative<Action>(was.command.body);
    const bool watch = action && was.command.until_done && ticket != no_ticket;
    if (!watch) {
        (void)drive_.tickets.answer(ticket, action ? Outcome::accepted : Outcome::done, Reason::none,
                                    was.text + "; the drive does not acknowledge it and restarts", t.out);
    }
    drive_.start.reboot_begun(watch ? ticket : no_ticket, t);
}

}  // namespace axisgate::uim342
