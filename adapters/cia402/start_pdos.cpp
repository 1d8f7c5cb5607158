// After a PDO was refused, nothing more is written to it, except for a second attempt in pre-operational.
#include "adapters/cia402/start_pdos.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {
namespace {
constexpr std::uint32_t out_of_use = 0x80000000u;

/// The refusal does not depend on the state of the node: there is no such PDO, or it is fixed.
bool is_final(canopen::Abort abort) noexcept {
    using canopen::Abort;
    return abort == Abort::no_object || abort == Abort::no_subindex || abort == Abort::not_mappable;
}
}  // namespace

Instant PdoSetUp::look_at() const noexcept { return watches_ ? drive_.axes[axis_]->polled.due() : never; }

void PdoSetUp::begin(std::vector<Wanted> wanted) {
    wanted_ = std::move(wanted);
    at_ = 0;
    tried_ = watches_ = false;
    begin_pdo();
}

void PdoSetUp::begin_pdo() {
    writes_now_ = false;
    written_ = 0;
    careful_ = moves();
    while (!over() && wanted_[at_].axis->known.polled && !wanted_[at_].target)
        ++at_;
    if (over()) return;
    reader_.emplace(wanted_[at_].pdo.direction, wanted_[at_].pdo.number);
}
void PdoSetUp::next_pdo() {
    ++at_;
    begin_pdo();
}

Step PdoSetUp::next() {
    if (watches_) return drive_.axes[axis_]->polled.next();
    Step s;
    s.literal = true;
    if (writes_now_) {
        s = {Step::Kind::write, writes_[written_].address, writes_[written_].bytes};
        s.literal = true;
    } else {
        s.address = reader_->next().value_or(Address{});
    }
    return s;
}

void PdoSetUp::answered(const canopen::SdoEnd& end, Turn& t) {
    if (over()) return;
    if (watches_) return watched(end, t);
    if (!writes_now_) return read(end);
    if (!end.done()) return refused(end, t);
    if (++written_ >= writes_.size()) next_pdo();
}

void PdoSetUp::read(const canopen::SdoEnd& end) {
    const canopen::Pdo& wanted = wanted_[at_].pdo;
    const bool id_only = !careful_;
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
    if (same) return next_pdo();
    const bool in_use = reader_->fault() == canopen::Abort::none && has.settings.valid && has.settings.id != 0;
    plan_writes(in_use ? canopen::id_word(has.settings) : out_of_use);
}

/// CiA 301, 7.5.2.36: an identifier may be changed only while the PDO is disabled.
void PdoSetUp::plan_writes(std::uint32_t id_word) {
    const canopen::Pdo& wanted = wanted_[at_].pdo;
    writes_ = canopen::writes_of(wanted);
    writes_now_ = true;
    if (writes_.empty()) return next_pdo();
    const bool in_use = (id_word & out_of_use) == 0;
    if (in_use && id_word != canopen::id_word(wanted.settings))
        writes_.insert(writes_.begin(), {writes_.front().address, bytes_of(std::int64_t{id_word | out_of_use}, 4)});
}

void PdoSetUp::refused(const canopen::SdoEnd& end, Turn& t) {
    const bool target = wanted_[at_].target.has_value();
    if (tried_ || is_final(end.abort) || (target && end.abort != canopen::Abort::device_state)) return go_without();
    if (!moves()) return pre_operational(t);
    watches_ = true;
    axis_ = 0;
    for (const auto& a : drive_.axes)
        a->polled.begin_anew();
    const std::string text = "it takes its PDOs in pre-operational alone, and moves: it is asked for its state until it stands";
    drive_.notice(Severity::warning, "pdo_setup", 0, fmt::format("{}: {}", drive_.node.setup.name, text), t);
    drive_.node.presence.report(text, t.out);
}

/// The axis is used without this PDO.
void PdoSetUp::go_without() {
    AxisKnown& known = wanted_[at_].axis->known;
    if (const auto target = wanted_[at_].target)
        known.targets[static_cast<std::size_t>(*target)] = false;
    else
        known.polled = true;
    next_pdo();
}

void PdoSetUp::pre_operational(Turn& t) {
    tried_ = true;
    watches_ = false;
    t.out.send(canopen::nmt_frame(canopen::NmtCommand::pre_operational, drive_.node.number), Priority::command);
    begin_pdo();
    careful_ = false;
}

void PdoSetUp::watched(const canopen::SdoEnd& end, Turn& t) {
    if (!drive_.axes[axis_]->polled.answered(end, t) || ++axis_ < drive_.axes.size()) return;
    axis_ = 0;
    if (!moves()) pre_operational(t);
}

bool PdoSetUp::moves() const noexcept {
    return std::ranges::any_of(drive_.axes, [](const auto& a) { return a->known.moves_under_power(); });
}

}  // namespace axisgate::cia402_drive
