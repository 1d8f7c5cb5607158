// After a PDO was refused, nothing more is written to it, except for a second attempt in pre-operational.
#include "adapters/cia402/start_pdos.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {
namespace {
using canopen::PdoDirection;
constexpr std::uint32_t out_of_use = 0x80000000u;
constexpr std::uint16_t most_own = 8;  ///< PDOs of each direction that are looked at

/// The refusal does not depend on the state of the node: there is no such PDO, or it is fixed.
bool is_final(canopen::Abort abort) noexcept {
    using canopen::Abort;
    return abort == Abort::no_object || abort == Abort::no_subindex || abort == Abort::not_mappable || abort == Abort::pdo_length;
}
/// The values of the axis are read by SDO.
void without_reports(AxisKnown& known) {
    known.polled = true;
    known.pdos.plan = PdoPlan::sdo;
    known.pdos.reports.clear();
}
bool allows(const Node& node, PdoPlan plan) { return !node.pdo_plan || *node.pdo_plan == plan; }
}  // namespace

Instant PdoSetUp::look_at() const noexcept { return act_ == Act::watch ? drive_.axes[axis_]->polled.due() : never; }

void PdoSetUp::begin(std::vector<Wanted> wanted) {
    wanted_ = std::move(wanted);
    at_ = 0;
    tried_ = false;
    found_.reset();
    number_ = 1;
    off_.reset();
    if (drive_.node.pdo_plan == PdoPlan::sdo)
        for (const Wanted& w : wanted_)
            if (!w.target) without_reports(w.axis->known);
    begin_pdo();
}

void PdoSetUp::begin_pdo() {
    written_ = 0;
    careful_ = moves();
    while (at_ < wanted_.size() && wanted_[at_].axis->known.polled && !wanted_[at_].target)
        ++at_;
    if (at_ >= wanted_.size()) return next_unused();
    const Wanted& w = wanted_[at_];
    // An attempt with the gateway's mapping would switch off a PDO that is in use already.
    if (!w.own && (drive_.node.pdo_plan == PdoPlan::file || found_)) return use_own();
    act_ = Act::compare;
    reader_.emplace(w.pdo.direction, w.pdo.number);
}
void PdoSetUp::next_pdo() {
    ++at_;
    begin_pdo();
}
/// The node has the PDO.
void PdoSetUp::accept() {
    const Wanted& w = wanted_[at_];
    AxisPdos& pdos = w.axis->known.pdos;
    if (w.target) {
        pdos.targets[static_cast<std::size_t>(*w.target)] = w.pdo;
    } else {
        pdos.reports.push_back(w.pdo);
        if (w.own) pdos.plan = PdoPlan::file;
    }
    next_pdo();
}

Step PdoSetUp::next() {
    if (act_ == Act::watch) return drive_.axes[axis_]->polled.next();
    Step s;
    if (act_ == Act::write) {
        s = {Step::Kind::write, writes_[written_].address, writes_[written_].bytes};
    } else if (act_ == Act::unused) {
        s.address = {canopen::settings_index(PdoDirection::transmit, number_), 1};
        if (off_) s = {Step::Kind::write, s.address, bytes_of(std::int64_t{*off_}, 4)};
    } else {
        s.address = reader_->next().value_or(Address{});
    }
    s.literal = true;
    return s;
}

void PdoSetUp::answered(const canopen::SdoEnd& end, Turn& t) {
    switch (act_) {
        case Act::watch:
            return watched(end, t);
        case Act::compare:
            return compared(end);
        case Act::look:
            return looked(end);
        case Act::unused:
            return unused(end);
        case Act::write:
            if (!end.done()) return refused(end, t);
            if (++written_ >= writes_.size()) accept();
            return;
        case Act::over:
            return;
    }
}

void PdoSetUp::compared(const canopen::SdoEnd& end) {
    const canopen::Pdo& wanted = wanted_[at_].pdo;
    const bool id_only = !careful_ && !wanted_[at_].own;
    if (end.done()) {
        reader_->on_value(end.data);
    } else {
        reader_->on_refused(end.abort);
    }
    const bool complete = !reader_->next();
    if (!id_only && !complete && reader_->fault() == canopen::Abort::none) return;
    const canopen::Pdo& has = reader_->pdo();
    const bool same = complete && reader_->fault() == canopen::Abort::none && has.settings.valid == wanted.settings.valid &&
                      has.settings.id == wanted.settings.id && has.settings.transmission == wanted.settings.transmission &&
                      has.mapping == wanted.mapping;
    if (same) return accept();
    const bool in_use = reader_->fault() == canopen::Abort::none && has.settings.valid && has.settings.id != 0;
    plan_writes(in_use ? canopen::id_word(has.settings) : out_of_use);
}

/// CiA 301, 7.5.2.36: an identifier may be changed only while the PDO is disabled.
void PdoSetUp::plan_writes(std::uint32_t id_word) {
    const canopen::Pdo& wanted = wanted_[at_].pdo;
    writes_ = canopen::writes_of(wanted);
    act_ = Act::write;
    if (writes_.empty()) return next_pdo();
    if (wanted_[at_].own) {
        const std::uint16_t settings = canopen::settings_index(wanted.direction, wanted.number);
        std::erase_if(writes_, [&](const canopen::SdoWrite& w) { return w.address.index != settings || w.address.sub > 2; });
    }
    const bool in_use = (id_word & out_of_use) == 0;
    if (in_use && id_word != canopen::id_word(wanted.settings))
        writes_.insert(writes_.begin(), {writes_.front().address, bytes_of(std::int64_t{id_word | out_of_use}, 4)});
}

void PdoSetUp::refused(const canopen::SdoEnd& end, Turn& t) {
    const Wanted& w = wanted_[at_];
    if (leave_out(end)) return begin_pdo();
    // A report with a SYNC count of its own is one; a target takes effect by any type, at the SYNC or at once.
    const std::uint8_t kept = reader_->pdo().settings.transmission;
    const bool is_type = writes_[written_].address == Address{canopen::settings_index(w.pdo.direction, w.pdo.number), 2};
    if (is_type && (w.target || (w.own && kept >= 1 && kept <= 240))) return void(++written_);
    if (tried_ || is_final(end.abort) || (w.target && end.abort != canopen::Abort::device_state)) {
        if (!w.own && allows(drive_.node, PdoPlan::file)) return use_own();
        return go_without();
    }
    if (!moves()) return pre_operational(t);
    act_ = Act::watch;
    axis_ = 0;
    for (const auto& a : drive_.axes)
        a->polled.begin_anew();
    const std::string text = "it takes its PDOs in pre-operational alone, and moves: it is asked for its state until it stands";
    drive_.notice(Severity::warning, "pdo_setup", 0, fmt::format("{}: {}", drive_.node.setup.name, text), t);
    drive_.node.presence.report(text, t.out);
}

/// The node has cleared the mapping and refuses an entry of it: the report is set up again without this entry, if it is worth it.
bool PdoSetUp::leave_out(const canopen::SdoEnd& end) {
    Wanted& w = wanted_[at_];
    const Address refused = writes_[written_].address;
    if (w.target || w.own || !allows(drive_.node, PdoPlan::few) || !is_final(end.abort)) return false;
    if (refused.index != canopen::mapping_index(w.pdo.direction, w.pdo.number)) return false;
    const bool count = refused.sub == 0 && written_ > 0 && writes_[written_].bytes != std::vector<std::uint8_t>{0};
    if (refused.sub == 0 && !count) return false;
    const auto entry = w.pdo.mapping.begin() + (count ? static_cast<std::ptrdiff_t>(w.pdo.mapping.size()) : refused.sub) - 1;
    const Address left_out = of_first_axis(entry->address);
    if (left_out == object::statusword || left_out == object::position) return false;
    w.pdo.mapping.erase(entry);
    w.axis->known.pdos.plan = PdoPlan::few;
    if (w.pdo.mapping.empty()) wanted_.erase(wanted_.begin() + static_cast<std::ptrdiff_t>(at_));
    return true;
}

/// The PDO that stands at `at_` is replaced by those of the node itself; they are read first.
void PdoSetUp::use_own() {
    if (!found_) return begin_look();
    const Wanted w = wanted_[at_];
    const auto place = wanted_.begin() + static_cast<std::ptrdiff_t>(at_);
    const Node& node = drive_.node;
    if (w.target) {
        const Address target = target_object(*w.target, w.axis->known.stream_mode(*w.target));
        const auto own = own_target(*found_, node.number, target);
        if (!own) return go_without();
        *place = {*own, w.axis, w.target, true};
        return begin_pdo();
    }
    auto own = own_reports(*found_, node.number, w.axis->place(), node.line.plan.turns);
    if (own.empty()) return go_without();
    const auto replaced = [&](const Wanted& x) { return x.axis == w.axis && !x.target; };
    at_ -= static_cast<std::size_t>(std::count_if(wanted_.begin(), place, replaced));
    std::erase_if(wanted_, replaced);
    w.axis->known.pdos.reports.clear();
    for (auto it = own.rbegin(); it != own.rend(); ++it)
        wanted_.insert(wanted_.begin() + static_cast<std::ptrdiff_t>(at_), {std::move(*it), w.axis, std::nullopt, true});
    begin_pdo();
}

void PdoSetUp::begin_look() {
    act_ = Act::look;
    found_.emplace();
    reader_.emplace(PdoDirection::transmit, std::uint16_t{1});
}
void PdoSetUp::looked(const canopen::SdoEnd& end) {
    if (end.done()) {
        reader_->on_value(end.data);
    } else {
        reader_->on_refused(end.abort);
    }
    if (reader_->next()) return;
    const canopen::Pdo& pdo = reader_->pdo();
    if (reader_->fault() == canopen::Abort::none && !pdo.mapping.empty()) found_->push_back(pdo);
    const auto direction = pdo.direction;
    const auto number = static_cast<std::uint16_t>(pdo.number + 1);
    const bool last = number > most_own || reader_->fault() == canopen::Abort::no_object;
    if (!last) return void(reader_.emplace(direction, number));
    if (direction == PdoDirection::transmit) return void(reader_.emplace(PdoDirection::receive, std::uint16_t{1}));
    use_own();
}

/// The axis is used without this PDO.
void PdoSetUp::go_without() {
    const Wanted& w = wanted_[at_];
    AxisKnown& known = w.axis->known;
    if (!w.target) without_reports(known);
    next_pdo();
}

void PdoSetUp::pre_operational(Turn& t) {
    tried_ = true;
    t.out.send(canopen::nmt_frame(canopen::NmtCommand::pre_operational, drive_.node.number), Priority::command);
    begin_pdo();
    careful_ = false;
}

void PdoSetUp::watched(const canopen::SdoEnd& end, Turn& t) {
    if (!drive_.axes[axis_]->polled.answered(end, t) || ++axis_ < drive_.axes.size()) return;
    axis_ = 0;
    if (!moves()) pre_operational(t);
}

/// From `number_` on, the next TPDO that no axis of the site uses.
void PdoSetUp::next_unused() {
    const auto used = [&] {
        return std::ranges::any_of(drive_.axes, [&](const auto& a) {
            return std::ranges::any_of(a->known.pdos.reports, [&](const canopen::Pdo& p) { return p.number == number_; });
        });
    };
    off_.reset();
    while (number_ <= most_own && used())
        ++number_;
    act_ = number_ <= most_own ? Act::unused : Act::over;
}
void PdoSetUp::unused(const canopen::SdoEnd& end) {
    if (!off_ && end.done() && end.data.size() == 4) {
        const auto word = static_cast<std::uint32_t>(canopen::low_first(end.data));
        if ((word & out_of_use) == 0) return void(off_ = word | out_of_use);
    }
    if (!off_ && !end.done()) number_ = most_own;  // there is none from here on
    ++number_;
    next_unused();
}

bool PdoSetUp::moves() const noexcept {
    return std::ranges::any_of(drive_.axes, [](const auto& a) { return a->known.moves_under_power(); });
}

}  // namespace axisgate::cia402_drive
