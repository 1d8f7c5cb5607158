// Adapter, part joint orders: StartTogether, the action start_group, and the action global_stop.
// In: the command, each node's news of its own part. Out: one BG or ST to a group or to all, and one result for the whole.
// Never starts an axis that was not named: the receivers of a group or of the global ID are counted first, and named if they are too many.
#include <fmt/format.h>

#include <algorithm>

#include "adapters/uim342/adapter.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::uim342 {
void LineAdapter::start_together(const Command& command, const StartTogether& what, Turn& t) {
    std::vector<Drive*> members;
    for (const AxisId axis : what.axes) {
        Drive* n = drives().of(axis);
        if (!n) {
            return drive::Tickets::refuse(command, Reason::line_down,
                                          fmt::format("axis {} of the list is not on this line", index_of(axis)), t.out);
        }
        if (std::ranges::find(members, n) == members.end()) members.push_back(n);
    }
    if (members.empty()) return drive::Tickets::refuse(command, Reason::out_of_range, "the list of axes is empty", t.out);
    if (members.size() == 1) {
        Command own = command;  // one drive: its own BG, acknowledged
        own.axis = members.front()->axis();
        members.front()->submit(own, t);
        return drive::settle(turns, *members.front(), t.now);
    }
    gather(command, Joint::Kind::start, std::move(members), t);
}

void LineAdapter::start_group(const Command& command, const std::string& argument, Turn& t) {
    const auto given = parse_whole(argument, first_node, last_node);
    if (!given) {
        return drive::Tickets::refuse(command, Reason::out_of_range,
                                      fmt::format("start_group takes a group ID {}..{}", first_node, last_node), t.out);
    }
    const auto group = static_cast<std::uint8_t>(*given);
    if (const Drive* n = by_id_[group]) {
        return drive::Tickets::refuse(command, Reason::wrong_state, fmt::format("{} is {}'s node ID, not a group", group, n->name()),
                                      t.out);
    }
    std::vector<Drive*> members;
    drives().each([&](Drive& d) {
        if (d.presence.ever_found() && d.known.group == group) members.push_back(&d);
    });
    if (members.empty()) {
        return drive::Tickets::refuse(command, Reason::wrong_state, fmt::format("no drive of this line is known to be in group {}", group),
                                      t.out);
    }
    gather(command, Joint::Kind::start_group, std::move(members), t);
    joint_.group = group;
}

void LineAdapter::gather(const Command& command, Joint::Kind how, std::vector<Drive*> members, Turn& t) {
    if (joint_.kind != Joint::Kind::none) {
        return drive::Tickets::refuse(command, Reason::busy, "another joint start of this line is in progress", t.out);
    }
    for (const Drive* n : members) {
        if (!n->presence.online())
            return drive::Tickets::refuse(command, Reason::no_answer, fmt::format("{} does not answer", n->name()), t.out);
    }
    if (!tickets_.open(command, t.out)) return;
    joint_ = Joint{};
    joint_.kind = how;
    joint_.command = command;
    joint_.open = members;
    joint_.members = std::move(members);
    for (Drive* n : joint_.members) {
        if (!n->together.join())
            return end_joint(Outcome::refused, Reason::busy, fmt::format("{}: {} commands wait already", n->name(), n->jobs.queue.limit()),
                             0, t);
    }
    for (Drive* n : joint_.members)
        drive::settle(turns, *n, t.now);
}

/// Every member has come to its place in its queue.
void LineAdapter::share_ready(Drive& drive, Turn& t) {
    std::erase(joint_.open, &drive);
    if (joint_.kind != Joint::Kind::none && joint_.stage == Joint::Stage::gathering && joint_.open.empty()) begin_joint(t);
}

/// The ID whose receivers are exactly the members; else who is too many, in words.
std::string LineAdapter::whom_to_start(std::uint8_t& id) const {
    const auto member = [&](const Drive* n) { return std::ranges::find(joint_.members, n) != joint_.members.end(); };
    std::string why;
    const auto group = joint_.members.front()->known.group;
    if (group && std::ranges::all_of(joint_.members, [&](const Drive* n) { return n->known.group == group; })) {
        std::vector<std::string> others;
        drives().each([&](const Drive& d) {
            if (d.address() == *group) others.push_back(d.name() + " (its node ID)");
            if (!member(&d) && d.presence.ever_found() && d.known.group == group) others.push_back(d.name());
        });
        if (others.empty()) {
            id = *group;
            return {};
        }
        why = fmt::format("a BG to group {} would also start {}", *group, fmt::join(others, ", "));
    } else {
        why = "they do not share a group ID (PP[8])";
    }
    std::vector<std::string> others;
    drives().each([&](const Drive& d) {
        if (!member(&d) && d.presence.ever_found()) others.push_back(d.name());
    });
    if (others.empty()) {
        id = global_id;
        return {};
    }
    return fmt::format("one BG cannot start just these axes: {}; a BG to all would also start {}", why, fmt::join(others, ", "));
}

void LineAdapter::begin_joint(Turn& t) {
    std::uint8_t id = joint_.group;
    for (const Drive* n : joint_.members) {
        std::string why = n->together.not_startable();
        if (why.empty() && joint_.kind == Joint::Kind::start && !n->together.prepared())
            why = fmt::format("{} has no prepared motion", n->name());
        if (!why.empty()) return end_joint(Outcome::refused, Reason::wrong_state, std::move(why), 0, t);
    }
    if (joint_.kind == Joint::Kind::start) {
        if (auto why = whom_to_start(id); !why.empty()) return end_joint(Outcome::refused, Reason::not_supported, std::move(why), 0, t);
    }
    joint_.stage = Joint::Stage::running;
    joint_.open = joint_.members;
    transmit(message(id, cw::BG), Priority::command, t,
             joint_.command.ticket);  // without acknowledgement: who would answer is not written (erratum E-44)
    const auto members = joint_.members;
    for (Drive* n : members) {
        n->together.begun(t);
        drive::settle(turns, *n, t.now);
    }
}

void LineAdapter::global_stop(const Command& command, Turn& t) {
    transmit(message(global_id, cw::ST), Priority::urgent, t, command.ticket);
    if (!tickets_.open(command, t.out)) return;
    if (joint_.kind == Joint::Kind::stop) {
        return (void)tickets_.failed(command.ticket, Reason::busy,
                                     "sent again, but not watched: another global_stop waits for its acknowledgements", t.out);
    }
    if (joint_.kind != Joint::Kind::none) end_joint(Outcome::failed, Reason::interrupted, "interrupted by global_stop", 0, t);
    std::vector<Drive*> members;
    drives().each([&](Drive& d) {
        if (d.presence.online()) members.push_back(&d);
    });
    if (members.empty()) return (void)tickets_.failed(command.ticket, Reason::no_answer, "sent; no drive of the line answers", t.out);
    joint_ = Joint{};
    joint_.kind = Joint::Kind::stop;
    joint_.stage = Joint::Stage::running;
    joint_.command = command;
    joint_.open = joint_.members = members;
    for (Drive* n : members) {
        n->stops.add_shared(t);
        drive::settle(turns, *n, t.now);
    }
}

void LineAdapter::share_done(Drive& drive, Share share, Turn& t) {
    if (joint_.kind == Joint::Kind::none || std::ranges::find(joint_.members, &drive) == joint_.members.end()) return;
    const bool was_open = std::erase(joint_.open, &drive) > 0;
    if (!share.good && !joint_.bad) {
        joint_.bad = true;
        joint_.worst = std::move(share);
        joint_.worst.text = fmt::format("{}: {}", drive.name(), joint_.worst.text);
    }
    // A joint start that one member has left is over; a joint stop is heard of to the last.
    if (joint_.bad && joint_.kind != Joint::Kind::stop) {
        return end_joint(Outcome::failed, joint_.worst.reason, joint_.worst.text, joint_.worst.code, t);
    }
    if (joint_.stage == Joint::Stage::gathering || !was_open || !joint_.open.empty()) return;
    if (joint_.bad) return end_joint(Outcome::failed, joint_.worst.reason, joint_.worst.text, joint_.worst.code, t);
    end_joint(Outcome::accepted, Reason::none, "", 0, t);
}

void LineAdapter::end_joint(Outcome outcome, Reason reason, std::string text, std::int32_t code, Turn& t) {
    const Joint was = std::move(joint_);
    joint_ = Joint{};
    if (was.kind != Joint::Kind::stop) {
        for (Drive* n : was.members) {
            n->together.leave(t);
            drive::settle(turns, *n, t.now);
        }
    }
    (void)tickets_.answer(was.command.ticket, outcome, reason, std::move(text), t.out, code);
}

}  // namespace axisgate::uim342
