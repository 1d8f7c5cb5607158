// Actions: every motion command by name, and the messages beyond them: program handling, error texts, what a drive says of a parameter,
// command table, curves. In: names with checked arguments. Out: exchanges, an answer in words.
// Never sends what is inferred where the option says off; a table entry is checked before the drive's memory is touched, and read back.
#include <fmt/core.h>

#include <algorithm>
#include <iterator>

#include "adapters/linmot/drive.hpp"
#include "gateway/core/command_arguments.hpp"

namespace axisgate::linmot {
namespace {
constexpr std::size_t entry_size = 64;
constexpr std::uint16_t entry_version = 0xA701, no_entry = 0xFFFF;
std::int64_t whole(const std::vector<Value>& v, std::size_t i) { return i < v.size() ? as_integer(v[i]).value_or(0) : 0; }
std::string text(const std::vector<Value>& v, std::size_t i) {
    const auto* s = i < v.size() ? std::get_if<std::string>(&v[i]) : nullptr;
    return s ? *s : std::string();
}
std::uint16_t at16(std::span<const std::uint8_t> b, std::size_t i) { return static_cast<std::uint16_t>(b[i] | b[i + 1] << 8); }
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
    if (!inferred_ && (action.name == "table.read" || action.name == "table.write" || action.name == "curve.read"))
        return refuse(Reason::not_supported,
                      fmt::format("{} rests on messages that are inferred, and the drive option inferred is off", action.name));
    if (action.name != "table.write") return;
    // The whole entry is made before anything is sent.
    const Motion* m = bus_.motions.named(text(action.values, 1));
    if (!m) return refuse(Reason::out_of_range, fmt::format("row command: there is no motion command {}", text(action.values, 1)));
    const auto inner = check_arguments(*m->command, text(action.values, 2));
    if (!inner.faults.empty())
        return refuse(Reason::out_of_range, fmt::format("row arguments: {}; {}", inner.faults[0].text, inner.faults[0].remedy));
    const std::string label = text(action.values, 4);
    if (label.size() > 15) return refuse(Reason::out_of_range, "row label: a name has at most 15 characters");
    std::vector<std::uint8_t> entry(entry_size, 0);
    const auto put = [&](std::size_t at, std::uint16_t v) {
        entry[at] = static_cast<std::uint8_t>(v);
        entry[at + 1] = static_cast<std::uint8_t>(v >> 8);
    };
    put(0, entry_version);
    const auto next = static_cast<std::uint16_t>(whole(action.values, 3));
    put(2, next == 0 ? no_entry : next);
    const auto bytes = Motions::pack(*m, 0, inner.values);
    std::ranges::copy(bytes, entry.begin() + 4);
    std::ranges::copy(label, entry.begin() + 38);
    job_.bytes = std::move(entry);
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
    if (name == "table.read") return request16(id_, Main::table, step == 0 ? 5 : 6, number);
    if (name == "table.write") {
        if (step == 0) return request48(id_, Main::table, 3, number, entry_size);
        const auto at = static_cast<std::size_t>(step - 1) * 4;
        if (at < entry_size)
            return request48(id_, Main::table, 4, number,
                             std::uint32_t{at16(job_.bytes, at)} | std::uint32_t{at16(job_.bytes, at + 2)} << 16);
        return request16(id_, Main::table, 6, number);
    }
    if (name == "curve.read") return request16(id_, Main::curves, 0x0A, number);
    end_job(Outcome::refused, Reason::not_supported, fmt::format("{} is not carried out by this gateway", name), t);
    return std::nullopt;
}

void Drive::action_answered(const Telegram& telegram, Turn& t) {
    const std::string name = std::get<Action>(job_.command.body).name;
    const auto accept = [&](std::string said) { end_job(Outcome::accepted, Reason::none, std::move(said), t); };
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

/// What comes in several answers: a list, a table entry, a curve.
void Drive::rows_answered(const Telegram& telegram, Turn& t) {
    const auto& action = std::get<Action>(job_.command.body);
    const std::string name = action.name;
    const auto a = config_of(telegram);
    if (!a) return end_job(Outcome::failed, Reason::drive_refused, "the answer has another form", t);
    constexpr std::uint8_t unfinished = 0x04, list_end = 0xC6;
    const auto accept = [&](std::string said) { end_job(Outcome::accepted, Reason::none, std::move(said), t); };
    if (a->communication != 0 && a->communication != unfinished && !(name == "parameter.list" && a->communication == list_end))
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
    if (name == "curve.read") {
        add(std::to_string(static_cast<std::int32_t>(a->value)));
        if (a->communication != unfinished) return accept(job_.text);
        return;
    }
    if (name == "table.read") {
        if (step == 0) return;
        for (int i = 0; i < 4; ++i)
            job_.bytes.push_back(static_cast<std::uint8_t>(a->value >> 8 * i));
        if (job_.bytes.size() < entry_size) {
            if (a->communication == unfinished) return;
            return end_job(Outcome::failed, Reason::drive_refused, "the entry is shorter than 64 bytes", t);
        }
        const std::span<const std::uint8_t> entry(job_.bytes);
        std::string label(entry.begin() + 38, entry.begin() + 54);
        label.resize(std::min(label.find('\0'), label.size()));
        const std::uint16_t next = at16(entry, 2);
        return accept(fmt::format("{}; next {}{}{}", bus_.motions.describe(entry.subspan(4, 32)),
                                  next == no_entry || next == 0 ? "none" : std::to_string(next), label.empty() ? "" : "; name ", label));
    }
    if (name == "table.write") {
        const auto words = static_cast<int>(entry_size / 4);
        if (step <= words) return;
        const auto at = static_cast<std::size_t>(step - 1 - words) * 4;
        const std::uint32_t wanted = std::uint32_t{at16(job_.bytes, at)} | std::uint32_t{at16(job_.bytes, at + 2)} << 16;
        if (a->value != wanted)
            return end_job(Outcome::failed, Reason::drive_refused,
                           fmt::format("entry {} reads back other than it was written, at byte {}", a->index, at), t);
        if (at + 4 >= entry_size) return accept("written and read back");
        return;
    }
    accept({});
}

}  // namespace axisgate::linmot
