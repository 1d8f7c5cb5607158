// An entry or a curve is checked completely before the drive's memory is changed, and read back afterwards. Inferred messages are not sent
// if the option says off.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/linmot/drive.hpp"
#include "adapters/linmot/parameters_tables.hpp"
#include "adapters/linmot/wire_inferred.hpp"
#include "gateway/core/command_arguments.hpp"

namespace axisgate::linmot {
namespace {
constexpr std::size_t most_text = 16'000;  ///< limit of results that consist of rows
std::int64_t whole(const std::vector<Value>& v, std::size_t i) { return i < v.size() ? as_integer(v[i]).value_or(0) : 0; }
std::string text(const std::vector<Value>& v, std::size_t i) {
    const auto* s = i < v.size() ? std::get_if<std::string>(&v[i]) : nullptr;
    return s ? *s : std::string();
}
}  // namespace

void Actions::begin(Turn& t) {
    auto& action = std::get<Action>(job().command.body);
    const Bus& bus = drive_.bus;
    const CatalogueCommand* command = bus.catalogue.command(action.name);
    const auto wrong = [&](Reason reason, std::string why) { refuse(reason, std::move(why), t); };
    if (!command)
        return wrong(Reason::unknown_point, fmt::format("a LinMot drive has no action {}; see the catalogue's commands", action.name));
    if (action.values.size() != command->arguments.size()) {
        auto checked = check_arguments(*command, action.argument);
        if (!checked.faults.empty()) return wrong(Reason::out_of_range, checked.faults[0].text + "; " + checked.faults[0].remedy);
        action.values = std::move(checked.values);
    }
    if (const Motion* m = bus.motions.named(command->id)) {
        if (m->inferred && !drive_.options.inferred)
            return wrong(Reason::not_supported,
                         fmt::format("the layout of {} is inferred, and the drive option inferred is off", command->name));
        drive_.motion.has_target(command->completes == Completion::target_reached);
        if (m->header == 0x0010) drive_.control.forget();
        return drive_.motion.begin_motion(*m, action.values);
    }
    action.name = command->id;
    if (!drive_.options.inferred && inferred(bus.catalogue, action.name))
        return wrong(Reason::not_supported,
                     fmt::format("{} rests on messages that are inferred, and the drive option inferred is off", action.name));
    begin_transfer(action, t);
}

/// Begins the transfer of a table entry or a curve, which is complete before the first telegram is sent.
void Actions::begin_transfer(const Action& action, Turn& t) {
    const auto number = static_cast<std::uint16_t>(whole(action.values, 0));
    if (action.name == "table.read" || action.name == "curve.read") return drive_.transfers.begin_read(action.name == "curve.read", number);
    if (action.name == "table.write") {
        auto e = entry_of(drive_.bus.motions, text(action.values, 1), text(action.values, 2),
                          static_cast<std::uint16_t>(whole(action.values, 3)), text(action.values, 4));
        if (!e.fault.empty()) return refuse(Reason::out_of_range, fmt::format("row {}: {}", number, e.fault), t);
        return drive_.transfers.begin_write(false, number, std::move(e.bytes));
    }
    if (action.name != "curve.write") return;
    auto c = curve_of(number, text(action.values, 1));
    if (c.fault.empty() && c.data.empty()) c.fault = "no points are given; curve.delete takes a curve away";
    if (!c.fault.empty()) return refuse(Reason::out_of_range, fmt::format("curve {}: {}", number, c.fault), t);
    drive_.transfers.begin_write(true, number, std::move(c.info), std::move(c.data));
}

std::optional<Telegram> Actions::request(Turn& t) {
    const auto& action = std::get<Action>(job().command.body);
    const std::string& name = action.name;
    const std::uint8_t id = drive_.id();
    const auto number = static_cast<std::uint16_t>(whole(action.values, 0));
    const int step = job().step;
    if (name == "program.start") {
        if (step > 0) return linmot::request(id, Main::response, 1);
        job().step = 1;
        job().limit = t.now + std::chrono::seconds(10);
        return linmot::request(id, Main::program, 4);
    }
    if (name == "parameter.info") return request16(id, Main::parameters, static_cast<std::uint8_t>(3 + step), number);
    if (name == "parameter.list") return request16(id, Main::parameters, step == 0 ? 0x0A : 0x0B, number);
    if (name == "table.presence") return request16(id, Main::table, 7, static_cast<std::uint16_t>(step));
    struct Message {
        std::string_view name;
        Main main;
        std::uint8_t sub;
        bool numbered;
    };
    static constexpr Message messages[] = {{"program.stop", Main::program, 3, false},    {"program.reset", Main::program, 2, false},
                                           {"error.text", Main::errors, 1, true},        {"error.counters", Main::errors, 2, false},
                                           {"table.delete", Main::table, 2, true},       {"table.delete_all", Main::table, 1, false},
                                           {"table.save", Main::table, 0, false},        {"curve.delete", Main::curves, 2, true},
                                           {"curve.delete_all", Main::curves, 1, false}, {"curve.save", Main::curves, 0, false}};
    for (const Message& m : messages) {
        if (m.name == name) return m.numbered ? request16(id, m.main, m.sub, number) : linmot::request(id, m.main, m.sub);
    }
    return refused(Reason::not_supported, fmt::format("{} is not carried out by this gateway", name), t);
}

void Actions::answered(const Telegram& telegram, Turn& t) {
    const std::string name = std::get<Action>(job().command.body).name;
    if (drive_.transfers.active()) {
        if (!drive_.transfers.answered(telegram, t)) return;
        return accept(job().transfer.write ? "written and read back" : drive_.transfers.text(), t);
    }
    if (name.starts_with("program.")) return program_answered(name, telegram, t);
    if (name.starts_with("error.")) return errors_answered(name, telegram, t);
    rows_answered(name, telegram, t);
}

void Actions::program_answered(const std::string& name, const Telegram& telegram, Turn& t) {
    if (name != "program.start") {
        drive_.control.forget();
        return accept({}, t);
    }
    const Status& s = drive_.feedback.status();
    if (telegram.sub == 0x60 || s.status != 0 || s.state_var != 0) return accept("the software runs", t);
    if (t.now >= job().limit) return fail(Reason::drive_refused, "the software has not started within 10 s", t);
    job().not_before = t.now + std::chrono::milliseconds(200);
}

void Actions::errors_answered(const std::string& name, const Telegram& telegram, Turn& t) {
    if (telegram.size < 5 || telegram.storage[0] != 0) return refuse(Reason::drive_refused, refusal(telegram.storage[0]), t);
    if (name == "error.counters")
        return accept(fmt::format("{} entries in the error log, {} errors have occurred", telegram.u16(1), telegram.u16(3)), t);
    const std::string reported(telegram.data().begin() + 3, telegram.data().end());
    accept(reported.substr(0, reported.find('\0')), t);
}

void Actions::add_row(std::string row) {
    std::string& rows = job().text;
    if (rows.size() < most_text) rows += (rows.empty() ? "" : "\n") + std::move(row);
}

/// Results that consist of several answers: a list, the presence of the table's entries.
void Actions::rows_answered(const std::string& name, const Telegram& telegram, Turn& t) {
    const auto a = config_of(telegram);
    if (!a) return fail(Reason::drive_refused, "the answer has another form", t);
    constexpr std::uint8_t list_end = 0xC6;
    if (a->communication != 0 && !(name == "parameter.list" && a->communication == list_end))
        return refuse(Reason::drive_refused, refusal(a->communication), t, a->communication);
    std::string& rows = job().text;
    const int step = job().step++;
    if (name == "parameter.info") {
        info_answered(step, *a, t);
    } else if (name == "parameter.list") {
        if (a->communication == list_end || rows.size() >= most_text) return accept(rows, t);
        if (step > 0)
            add_row(fmt::format("{:04X}h usage {:04X}h type {}", a->index, a->value & 0xFFFF,
                                type_name(static_cast<std::uint8_t>(a->value >> 16))));
    } else if (name == "table.presence") {
        for (int i = 0; i < 32; ++i) {
            if ((a->value >> i & 1) == 0 && step * 32 + i > 0) rows += (rows.empty() ? "" : " ") + std::to_string(step * 32 + i);
        }
        if (step == 7) accept(rows, t);
    } else {
        accept({}, t);
    }
}

/// Usage, type, lower and upper limit, default: one answer each. The job's number stores the type.
void Actions::info_answered(int step, const ConfigAnswer& a, Turn& t) {
    static constexpr const char* what[] = {"usage", "type", "min", "max", "default"};
    if (step == 1) job().number = a.value;
    const bool is_signed = job().number == 2 || job().number == 4 || job().number == 6;
    if (step == 0)
        add_row(fmt::format("usage {:04X}h{}", a.value, a.value & 0x100 ? " (live)" : ""));
    else if (step == 1)
        add_row(fmt::format("type {}", type_name(static_cast<std::uint8_t>(a.value))));
    else
        add_row(is_signed ? fmt::format("{} {}", what[step], static_cast<std::int32_t>(a.value))
                          : fmt::format("{} {}", what[step], a.value));
    if (step == 3 && !drive_.options.inferred) add_row("default not asked: the message is inferred, and the drive option inferred is off");
    if (step == 4 || (step == 3 && !drive_.options.inferred)) accept(job().text, t);
}

}  // namespace axisgate::linmot
