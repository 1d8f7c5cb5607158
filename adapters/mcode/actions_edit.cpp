// Programs: part of a program changed: from a label or an address on, what the drive has is replaced by other lines, and the lines before
// stay. In: the action's argument, the drive's listings. Out: steps of CP, PG and lines, behind which a download's own checks run. Never
// reckons an address: how many a line takes the reference does not say (E-37), so the listing gives each.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "adapters/mcode/drive.hpp"
#include "adapters/mcode/parameters_variables.hpp"

namespace axisgate::mcode {
namespace {
/// The place stands in the first line of the argument, the text behind it.
std::pair<std::string, std::string> place_and_text(const std::string& argument) {
    const auto end = std::min(argument.find('\n'), argument.size());
    std::string place = argument.substr(0, end), text = end < argument.size() ? argument.substr(end + 1) : std::string();
    std::erase_if(place, [](char c) { return c == ' ' || c == '\r'; });
    return {std::move(place), std::move(text)};
}
bool is_address(std::string_view s) { return !s.empty() && s.find_first_not_of("0123456789") == std::string_view::npos; }
}  // namespace

void Programs::edit(const std::string& argument, Turn& t) {
    const auto [place, text] = place_and_text(argument);
    if (place.empty() || place.size() > 9 || (!is_address(place) && normal_form(place) != normal_form(word_of(place)))) {
        return refuse(Reason::out_of_range,
                      "program.edit: write the label or the address from which on the program is replaced in the first line, and the "
                      "new lines behind it; none clear it from there on",
                      t);
    }
    if (feedback().running())
        return refuse(Reason::wrong_state, fmt::format("a program runs in {}: end it first (program.end)", name()), t);
    if (!wait_for_rest(t)) return;
    work_.doing = Doing::edit;
    tidy_ = false;
    job().list("PR UV").list("L");  // the first: what the program may name without declaring it
}

/// One of the listings of an edit.
void Programs::edit_listed(const std::string& text, Turn& t) {
    if (job().steps[job().at].text != "L") {
        work_.globals = global_variables(text);
        return drive_.jobs.step_done(t);
    }
    const auto rows = addressed_lines(text);
    if (work_.from.empty() && !begin_edit(rows, t)) return;
    if (clear_from(rows, t)) return drive_.jobs.step_done(t);
    if (!drive_.jobs.is(*this)) return;
    // From here on it is a download behind lines that stay.
    work_.doing = Doing::download;
    drive_.mode.doubt(false);
    const std::size_t head = work_.program.size();
    if (!work_.fresh.empty()) {
        work_.program.push_back({ProgramLine::Kind::frame, "PG " + work_.from, 0});
        for (auto& line : work_.fresh)
            work_.program.push_back(std::move(line));
        work_.program.push_back({ProgramLine::Kind::frame, "PG", 0});
        add_lines({work_.program.begin() + static_cast<std::ptrdiff_t>(head), work_.program.end()});
    }
    job().list("L");
    drive_.jobs.step_done(t);
}

/// Finds the place and checks the whole of what stays and what comes. false: it is refused, and nothing has been changed.
bool Programs::begin_edit(const std::vector<ListedLine>& rows, Turn& t) {
    const auto refused = [&](std::string why) {
        refuse(Reason::out_of_range, fmt::format("{}: {}; nothing was changed", name(), why), t);
        return false;
    };
    const auto* action = std::get_if<Action>(&job().command.body);
    const auto parts = place_and_text(action ? action->argument : std::string());
    const std::string &place = parts.first, &text = parts.second;
    const std::string label = "LB" + normal_form(place);
    const auto start = std::ranges::find_if(rows, [&](const ListedLine& l) {
        return is_address(place) ? l.address == std::atol(place.c_str()) : normal_form(l.text) == label;
    });
    if (start == rows.end())
        return refused(is_address(place) ? fmt::format("no line of its program begins at address {}: see program.list", place)
                                         : fmt::format("its program has no label {}: see program.list", place));
    std::string whole;
    std::size_t before = 1;
    for (const auto& v : work_.globals)
        whole += fmt::format("VA {}\n", v), ++before;
    whole += "PG 1\n";
    for (auto row = rows.begin(); row != start; ++row)
        whole += row->text + '\n', ++before;
    if (text.find_first_not_of(" \r\n\t") == std::string::npos && start == rows.begin())
        return refused("this would clear the whole program: that is the action program.clear");
    auto checked = check_program(whole + text + (text.ends_with('\n') || text.empty() ? "PG\n" : "\nPG\n"), Language(drive_.bus.catalogue));
    if (!checked.fault.empty()) {
        // "line 12: ..." of the whole; the user's text begins in the second line of the argument.
        std::size_t line = 0;
        const auto [rest, fault] = std::from_chars(checked.fault.data() + 5, checked.fault.data() + checked.fault.size(), line);
        if (fault != std::errc{}) return refused(checked.fault);
        const std::string why(static_cast<const char*>(rest), static_cast<std::size_t>(checked.fault.data() + checked.fault.size() - rest));
        return refused(line > before ? fmt::format("line {}{}", line - before + 1, why)
                                     : "the part that stays does not fit any more" + why);
    }
    if (std::ranges::count(checked.lines, ProgramLine::Kind::frame, &ProgramLine::kind) != 2)
        return refused("write the lines between PG and PG alone");
    work_.from = std::to_string(start->address);
    work_.program.push_back({ProgramLine::Kind::frame, "PG 1", 0});
    for (auto row = rows.begin(); row != start; ++row) {
        work_.program.push_back({ProgramLine::Kind::stored, row->text, 0});
        if (word_of(row->text) != "VA") work_.stays.push_back(normal_form(row->text));
    }
    for (auto& l : checked.lines) {
        if (l.kind == ProgramLine::Kind::stored && l.number > before)
            work_.fresh.push_back({l.kind, std::move(l.text), l.number - before + 1});
    }
    return true;
}

/// Removes what is listed from work_.from on; CP with a place takes one program away, to its end, so it is said until nothing is left.
/// false: nothing is left, or the job is over.
bool Programs::clear_from(const std::vector<ListedLine>& rows, Turn& t) {
    const long from = std::atol(work_.from.c_str());
    const auto first = std::ranges::find_if(rows, [&](const ListedLine& l) { return l.address >= from; });
    const auto left = static_cast<std::size_t>(rows.end() - first);
    if (left == 0) return false;
    if (work_.left != 0 && left >= work_.left) {
        fail(Reason::drive_refused, fmt::format("{}: CP 0,{} leaves {} lines where they are", name(), first->address, left), t);
        return false;
    }
    work_.left = left;
    job().send(fmt::format("CP 0,{}", first->address), false).list("L");
    return true;
}

}  // namespace axisgate::mcode
