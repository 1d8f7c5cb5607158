// Actions: every motion command by name, and the messages beyond them: program handling, error texts, what a drive says of a parameter,
// command table, curves. In: names with checked arguments. Out: exchanges, an answer in words.
// Never sends what is inferred where the option says off; an entry or a curve is checked before the drive's memory is touched, and read
// back.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "adapters/linmot/drive.hpp"
#include "adapters/linmot/parameters_tables.hpp"
#include "adapters/linmot/wire_inferred.hpp"
#include "gateway/core/command_arguments.hpp"

namespace axisgate::linmot {
namespace {
std::int64_t whole(const std::vector<Value>& v, std::size_t i) { return i < v.size() ? as_integer(v[i]).value_or(0) : 0; }
std::string text(const std::vector<Value>& v, std::size_t i) {
    const auto* s = i < v.size() ? std::get_if<std::string>(&v[i]) : nullptr;
    return s ? *s : std::string();
}
}  // namespace

void Drive::begin_action(Turn& t) {
    auto& action = std::get<Action>(job_.command.body);
    const CatalogueCommand* command = bus_.catalogue.command(action.name);
    const auto refuse = [&](Reason reason, std::string why) { end_job(Outcome::refused, reason, std::move(why), t); };
    if (!command)
        return refuse(Reason::unknown_point, fmt::format("a LinMot drive has no action {}; see the catalogue's commands", action.name));
    if (action.values.size() != command->arguments.size()) {
        auto checked = check_arguments(*command, action.argument);
        if (!checked.faults.empty()) return refuse(Reason::out_of_range, checked.faults[0].text + "; " + checked.faults[0].remedy);
        action.values = std::move(checked.values);
    }
    if (const Motion* m = bus_.motions.named(command->id)) {
        if (m->inferred && !inferred_)
            return refuse(Reason::not_supported,
                          fmt::format("the layout of {} is inferred, and the drive option inferred is off", command->name));
        to_target_ = command->completes == Completion::target_reached;
        if (m->header == 0x0010) cw_known_ = false;
        return begin_motion(*m, action.values, t);
    }
    action.name = command->id;
    if (!inferred_ && inferred(bus_.catalogue, action.name))
        return refuse(Reason::not_supported,
                      fmt::format("{} rests on messages that are inferred, and the drive option inferred is off", action.name));
    static constexpr std::array<std::string_view, 4> carried{"table.read", "table.write", "curve.read", "curve.write"};
    if (std::ranges::find(carried, action.name) == carried.end()) return;
    const auto number = static_cast<std::uint16_t>(whole(action.values, 0));
    if (action.name == "table.read" || action.name == "curve.read") return begin_transfer(action.name == "curve.read", false, number);
    // The whole entry, the whole curve is made before anything is sent.
    if (action.name == "table.write") {
        auto e = entry_of(bus_.motions, text(action.values, 1), text(action.values, 2), static_cast<std::uint16_t>(whole(action.values, 3)),
                          text(action.values, 4));
        if (!e.fault.empty()) return refuse(Reason::out_of_range, fmt::format("row {}: {}", number, e.fault));
        return begin_transfer(false, true, number, std::move(e.bytes));
    }
    auto c = curve_of(number, text(action.values, 1));
    if (c.fault.empty() && c.data.empty()) c.fault = "no points are given; curve.delete takes a curve away";
    if (!c.fault.empty()) return refuse(Reason::out_of_range, fmt::format("curve {}: {}", number, c.fault));
    begin_transfer(true, true, number, std::move(c.info), std::move(c.data));
}

std::optional<Telegram> Drive::action_request(Turn& t) {
    const auto& action = std::get<Action>(job_.command.body);
    const std::string& name = action.name;
    const auto number = static_cast<std::uint16_t>(whole(action.values, 0));
    const int step = job_.step;
    if (name == "program.stop") return request(id_, Main::program, 3);
    if (name == "program.reset") return request(id_, Main::program, 2);
    if (name == "program.start") {
        if (job_.step == 0) {
            job_.step = 1;
            job_.limit = t.now + std::chrono::seconds(10);
            return request(id_, Main::program, 4);
        }
        return request(id_, Main::response, 1);
    }
    if (name == "error.text") return request16(id_, Main::errors, 1, number);
    if (name == "error.counters") return request(id_, Main::errors, 2);
    if (name == "parameter.info") return request16(id_, Main::parameters, static_cast<std::uint8_t>(3 + step), number);
    if (name == "parameter.list") return request16(id_, Main::parameters, step == 0 ? 0x0A : 0x0B, number);
    if (name == "table.presence") return request16(id_, Main::table, 7, static_cast<std::uint16_t>(step));
    if (name == "table.delete") return request16(id_, Main::table, 2, number);
    if (name == "table.delete_all") return request(id_, Main::table, 1);
    if (name == "table.save") return request(id_, Main::table, 0);
    if (name == "curve.delete") return request16(id_, Main::curves, 2, number);
    if (name == "curve.delete_all") return request(id_, Main::curves, 1);
    if (name == "curve.save") return request(id_, Main::curves, 0);
    end_job(Outcome::refused, Reason::not_supported, fmt::format("{} is not carried out by this gateway", name), t);
    return std::nullopt;
}

void Drive::action_answered(const Telegram& telegram, Turn& t) {
    const std::string name = std::get<Action>(job_.command.body).name;
    const auto accept = [&](std::string said) { end_job(Outcome::accepted, Reason::none, std::move(said), t); };
    if (job_.transfer.active) {
        if (!transfer_answered(telegram, t)) return;
        const bool written = job_.transfer.write;
        return accept(written ? "written and read back" : transfer_text());
    }
    if (name == "program.stop" || name == "program.reset") {
        cw_known_ = false;
        return accept({});
    }
    if (name == "program.start") {
        if (telegram.sub == 0x60) return accept("the software runs");
        if (status_.status != 0 || status_.state_var != 0) return accept("the software runs");
        if (t.now >= job_.limit) return end_job(Outcome::failed, Reason::drive_refused, "the software has not started within 10 s", t);
        job_.not_before = t.now + std::chrono::milliseconds(200);
        return;
    }
    if (name == "error.text" || name == "error.counters") {
        if (telegram.size < 5 || telegram.storage[0] != 0)
            return end_job(Outcome::refused, Reason::drive_refused, refusal(telegram.storage[0]), t);
        if (name == "error.counters")
            return accept(fmt::format("{} entries in the error log, {} errors have occurred", telegram.u16(1), telegram.u16(3)));
        std::string said(telegram.data().begin() + 3, telegram.data().end());
        return accept(said.substr(0, said.find('\0')));
    }
    rows_answered(telegram, t);
}

/// What comes in several answers: a list, the presence of the table's entries.
void Drive::rows_answered(const Telegram& telegram, Turn& t) {
    const auto& action = std::get<Action>(job_.command.body);
    const std::string name = action.name;
    const auto a = config_of(telegram);
    if (!a) return end_job(Outcome::failed, Reason::drive_refused, "the answer has another form", t);
    constexpr std::uint8_t list_end = 0xC6;
    const auto accept = [&](std::string said) { end_job(Outcome::accepted, Reason::none, std::move(said), t); };
    if (a->communication != 0 && !(name == "parameter.list" && a->communication == list_end))
        return end_job(Outcome::refused, Reason::drive_refused, refusal(a->communication), t, a->communication);
    const int step = job_.step++;
    const auto add = [&](std::string row) {
        if (job_.text.size() < 16'000) job_.text += (job_.text.empty() ? "" : "\n") + std::move(row);
    };
    if (name == "parameter.info") {
        static constexpr const char* what[] = {"usage", "type", "min", "max", "default"};
        if (step == 1) job_.number = a->value;
        const bool is_signed = job_.number == 2 || job_.number == 4 || job_.number == 6;
        if (step == 0)
            add(fmt::format("usage {:04X}h{}", a->value, a->value & 0x100 ? " (live)" : ""));
        else if (step == 1)
            add(fmt::format("type {}", type_name(static_cast<std::uint8_t>(a->value))));
        else
            add(is_signed ? fmt::format("{} {}", what[step], static_cast<std::int32_t>(a->value))
                          : fmt::format("{} {}", what[step], a->value));
        if (step == 3 && !inferred_) {
            add("default not asked: the message is inferred, and the drive option inferred is off");
            return accept(job_.text);
        }
        if (step == 4) return accept(job_.text);
        return;
    }
    if (name == "parameter.list") {
        if (a->communication == list_end || job_.text.size() >= 16'000) return accept(job_.text);
        if (step > 0)
            add(fmt::format("{:04X}h usage {:04X}h type {}", a->index, a->value & 0xFFFF,
                            type_name(static_cast<std::uint8_t>(a->value >> 16))));
        return;
    }
    if (name == "table.presence") {
        for (int i = 0; i < 32; ++i) {
            if ((a->value >> i & 1) == 0 && step * 32 + i > 0) job_.text += (job_.text.empty() ? "" : " ") + std::to_string(step * 32 + i);
        }
        if (step == 7) return accept(job_.text);
        return;
    }
    accept({});
}

}  // namespace axisgate::linmot
