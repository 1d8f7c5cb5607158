// After a PDO was refused, nothing more is written to it, except for a second attempt in pre-operational.
#include "adapters/cia402/start_pdos.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {
namespace {
constexpr Duration between_looks = std::chrono::milliseconds(100);
constexpr std::uint32_t out_of_use = 0x80000000u;
constexpr std::array picture{object::statusword, object::position, object::mode_shown, object::velocity, object::demand};
constexpr std::array<std::size_t, 5> sizes{2, 4, 1, 4, 4};
}  // namespace

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
    if (over()) return;
    reader_.emplace(wanted_[at_].pdo.direction, wanted_[at_].pdo.number);
}
void PdoSetUp::next_pdo() {
    ++at_;
    begin_pdo();
}

Step PdoSetUp::next() {
    Step s;
    s.literal = true;
    if (watches_) {
        s.address = of_axis(picture[seen_], drive_.axes[axis_]->place());
    } else if (writes_now_) {
        s = {Step::Kind::write, writes_[written_].address, writes_[written_].bytes};
        s.literal = true;
    } else {
        s.address = reader_->next().value_or(Address{});
    }
    return s;
}

bool PdoSetUp::answered(const canopen::SdoEnd& end, Turn& t) {
    if (over()) return true;
    if (watches_) return watched(end, t), true;
    if (!writes_now_) return read(end), true;
    if (!end.done()) return refused(end, t);
    if (++written_ >= writes_.size()) next_pdo();
    return true;
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

bool PdoSetUp::refused(const canopen::SdoEnd& end, Turn& t) {
    const bool optional = wanted_[at_].optional;
    if (tried_ || (optional && end.abort != canopen::Abort::device_state)) {
        if (optional) next_pdo();
        return optional;
    }
    if (!moves()) return pre_operational(t), true;
    watches_ = true;
    axis_ = seen_ = 0;
    picture_.clear();
    look_at_ = t.now;
    const std::string text = "it takes its PDOs in pre-operational alone, and moves: it is asked for its state until it stands";
    drive_.notice(Severity::warning, "pdo_setup", 0, fmt::format("{}: {}", drive_.node.setup.name, text), t);
    drive_.node.presence.report(text, t.out);
    return true;
}

void PdoSetUp::pre_operational(Turn& t) {
    tried_ = true;
    watches_ = false;
    t.out.send(canopen::nmt_frame(canopen::NmtCommand::pre_operational, drive_.node.number), Priority::command);
    begin_pdo();
    careful_ = false;
}

void PdoSetUp::watched(const canopen::SdoEnd& end, Turn& t) {
    std::vector<std::uint8_t> bytes = end.done() ? end.data : std::vector<std::uint8_t>{};
    bytes.resize(sizes[seen_]);
    picture_.insert(picture_.end(), bytes.begin(), bytes.end());
    if (++seen_ < picture.size()) return;
    seen_ = 0;
    Axis& a = *drive_.axes[axis_];
    const std::span<const std::uint8_t> all(picture_);
    if (a.known.profile) {
        a.feedback.on_status(all.first(7), t);
        a.feedback.on_motion(all.subspan(7), t);
    }
    picture_.clear();
    if (++axis_ < drive_.axes.size()) return;
    axis_ = 0;
    look_at_ = t.now + between_looks;
    if (!moves()) pre_operational(t);
}

bool PdoSetUp::moves() const noexcept {
    return std::ranges::any_of(drive_.axes, [](const auto& a) { return a->known.moves_under_power(); });
}

}  // namespace axisgate::cia402_drive
