// Programs and their moves. In: names, axes, time. Out: moves, errors. Never moves an axis that the control does not have.
#include "adapters/pacontrol/twin/programs.hpp"

#include "adapters/pacontrol/twin/errors.hpp"

namespace axisgate::pacontrol::twin {

Programs::Programs(std::vector<Program> list) : list_(std::move(list)) {
    if (list_.empty()) list_.push_back({"START", std::chrono::seconds(10), 0});
}

bool Programs::choose(std::string_view name) {
    for (std::size_t i = 0; i < list_.size(); ++i) {
        if (list_[i].name != name) continue;
        if (chosen_ != i) ++revision_;
        chosen_ = i;
        return true;
    }
    return false;
}

std::uint16_t Programs::go_on(const Program& running, const Settings& settings, Axes& axes, Instant now) {
    const std::vector<ProgramMove>& moves = running.moves;
    for (std::size_t tried = 0; tried < moves.size(); ++tried) {
        if (axis_ && axes.at(*axis_).traverse().busy()) return 0;
        const ProgramMove& next = moves[move_ % moves.size()];
        if (!settings.has_axis(next.axis)) return 0;
        Axis& a = axes.at(next.axis);
        Motion m;
        m.target = next.target;
        m.speed = static_cast<double>(a.parameters()[ap::traverse_speed]);
        m.acceleration = static_cast<double>(a.parameters()[ap::acceleration]);
        if (const std::uint16_t q = a.traverse().may_start(m, now); q != quit::ok)
            return q == quit::no_reference ? error::no_reference : error::program_move;
        a.traverse().start(m, now);
        ++move_;
        axis_ = next.axis;
    }
    return 0;
}

void Programs::end() noexcept {
    move_ = 0;
    axis_.reset();
}

void Programs::keep(Memory& memory) const {
    if (chosen_ != 0) memory["program"] = chosen().name;
}

bool Programs::restore(std::string_view name, const Value& value) {
    const auto* text = std::get_if<std::string>(&value);
    return name == "program" && text != nullptr && choose(*text);
}

}  // namespace axisgate::pacontrol::twin
