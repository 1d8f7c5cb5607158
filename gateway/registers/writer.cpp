// A write becomes one ticket per command; results that a map gets itself are not waited for. Faults of address and state are reported
// before "busy", so that a fault always has the same answer.
#include "gateway/registers/writer.hpp"

#include <utility>

namespace axisgate::registers {
namespace {
/// A command that is answered when it is done may take as long as the machine takes.
constexpr Duration task_timeout = std::chrono::hours(24);
}  // namespace

RegisterWriter::RegisterWriter(DoorPort& port, RegisterImage& image, Settings settings)
    : port_(port),
      image_(image),
      settings_(settings),
      tickets_(settings.max_commands),
      refusals_(settings.door, [&port](Event event, AxisId axis) { port.note(std::move(event), axis); }) {
    plan_.commands.reserve(WritePlan::max_commands);
    image_.add_user(*this);
}

RegisterWriter::~RegisterWriter() { image_.remove_user(*this); }

RegisterWriter::Begun RegisterWriter::write(const Client& client, std::uint8_t slot, UnitMap& map, Table table, std::uint16_t address,
                                            std::uint16_t count, const std::uint8_t* data, const RequestNote& note, Instant now) {
    if (const auto e = map.check_write(table, address, count); e != Verdict::good) return {e, 0};
    if (tickets_.free() == 0) return {Verdict::busy, 0};
    plan_.commands.clear();
    if (const auto e = map.write(table, address, count, data, plan_); e != Verdict::good) return {e, 0};
    return give(client, slot, map, plan_, note, now);
}

RegisterWriter::Begun RegisterWriter::give(const Client& client, std::uint8_t slot, UnitMap& map, WritePlan& plan, const RequestNote& note,
                                           Instant now) {
    if (plan.commands.size() > tickets_.free()) {
        Result refused;
        refused.outcome = Outcome::refused;
        refused.reason = Reason::busy;
        for (const auto& c : plan.commands) {
            if (c.own || c.reported) map.on_own_result(c.note, refused);
        }
        return {Verdict::busy, 0};
    }
    Begun begun;
    const Instant deadline = now + settings_.result_timeout;
    for (auto& c : plan.commands) {
        TicketTable::Waiting waiting;
        waiting.axis = c.axis;
        if (c.own || c.reported) {
            waiting.map = &map;
            waiting.note = c.note;
            waiting.own = c.own;
        }
        if (!c.own) {
            waiting.owner = client.owner;
            waiting.slot = slot;
            ++begun.outstanding;
        }
        waiting.who = client.who;
        waiting.request = note;
        Command command;
        command.ticket = tickets_.open(waiting, c.until_done ? now + task_timeout : deadline);
        command.until_done = c.until_done;
        command.axis = c.axis;
        command.body = std::move(c.body);
        command.origin = {settings_.door, client.who, client.client};
        counters_.commands.add();
        port_.submit(std::move(command));
    }
    return begun;
}

void RegisterWriter::refused(const std::string& who, Refused why, const RequestNote& note, std::string_view answer, Instant now) {
    if (why.axis != no_axis && note.write) image_.standard().note_refusal(why.axis, why.reason);
    refusals_.add(who, std::move(why), note, answer, now);
}

void RegisterWriter::on_result(const Result& result) {
    auto waiting = tickets_.close(result.ticket);
    if (waiting && waiting->map && !waiting->own) waiting->map->on_own_result(waiting->note, result);
    if (waiting && waiting->who && !waiting->own && !good(result)) {  // also if the client has gone meanwhile
        const Verdict verdict = verdict_of(result);
        std::string text = !result.text.empty()            ? result.text
                           : verdict == Verdict::no_answer ? std::string("the drive did not answer in time")
                           : verdict == Verdict::busy      ? std::string("too many writes wait for their drives: wait for their answers")
                                                           : std::string("the write failed");
        refused(*waiting->who, {waiting->axis, result.reason == Reason::none ? Reason::internal : result.reason, std::move(text), {}, {}},
                waiting->request, settings_.answer(verdict), port_.now());
    }
    if (!waiting || (!waiting->owner && !waiting->map)) {
        counters_.results_unclaimed.add();
        return;
    }
    if (waiting->owner) {
        waiting->owner->on_written(waiting->slot, waiting->axis, verdict_of(result));
    } else if (waiting->own) {
        own_result(*waiting, result);
    }
}

void RegisterWriter::own_result(const TicketTable::Waiting& waiting, const Result& result) {
    waiting.map->on_own_result(waiting.note, result);
    Refused why = waiting.map->take_refused();
    // A language shows the refusal in a register of its own; people need an event.
    if (why.reason == Reason::none && result.outcome == Outcome::refused)
        why = {waiting.axis, result.reason == Reason::none ? Reason::internal : result.reason, result.text, {}, {}};
    if (waiting.who && why.reason != Reason::none) refused(*waiting.who, std::move(why), waiting.request, {}, port_.now());
}

void RegisterWriter::sweep(Instant now) {
    while (const auto waiting = tickets_.expired(now)) {
        counters_.results_timed_out.add();
        Result result;
        result.axis = waiting->axis;
        result.outcome = Outcome::failed;
        result.reason = Reason::no_answer;
        if (waiting->map && !waiting->own) waiting->map->on_own_result(waiting->note, result);
        if (waiting->who && !waiting->own) {
            refused(*waiting->who, {waiting->axis, Reason::no_answer, "the drive did not answer in time", {}, {}}, waiting->request,
                    settings_.answer(Verdict::no_answer), now);
        }
        if (waiting->owner) {
            waiting->owner->on_written(waiting->slot, waiting->axis, Verdict::no_answer);
        } else if (waiting->map && waiting->own) {
            own_result(*waiting, result);
        }
    }
    refusals_.flush(now);
}

}  // namespace axisgate::registers
