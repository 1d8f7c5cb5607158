// The map of the unit splits the bytes into values; changes are planned value by value, or by a language as one order. No map is kept,
// because each change of the site may replace it.
#include "gateway/doors/enip/window.hpp"

#include <algorithm>
#include <cstring>

#include "gateway/registers/words.hpp"

namespace axisgate::enip {
namespace {
using registers::MapValue;
using registers::UnitMap;
using registers::Verdict;

/// Reverses the bytes of a number; if its low word comes first, those of each word. Its own inverse.
void turn(const MapValue& v, const std::uint8_t* from, std::uint8_t* to) {
    const std::size_t n = 2 * std::size_t{v.registers};
    if (v.text) {
        std::memcpy(to, from, n);
    } else if (v.order == MapWordOrder::high_first) {
        std::reverse_copy(from, from + n, to);
    } else {
        for (std::size_t i = 0; i < n; ++i)
            to[i] = from[i ^ 1u];
    }
}
void turn_all(const AssemblySpec& a, const std::vector<MapValue>& values, const std::uint8_t* from, std::uint8_t* to) {
    if (a.order == AssemblyOrder::registers) {
        std::memcpy(to, from, a.bytes());
        return;
    }
    std::memset(to, 0, a.bytes());
    for (const MapValue& v : values) {
        const std::size_t at = 2 * std::size_t(v.address - a.address);
        turn(v, from + at, to + at);
    }
}
registers::RegisterWriter::Client client_of(registers::WriteOwner* owner, const Origin& origin) {
    return {owner, origin.who, origin.client};
}
bool in_outputs(const AssemblySpec& a) { return a.direction == AssemblyDirection::output; }
}  // namespace

void to_assembly(const AssemblySpec& a, const std::vector<MapValue>& values, const std::uint8_t* from, std::uint8_t* to) {
    turn_all(a, values, from, to);
}
void from_assembly(const AssemblySpec& a, const std::vector<MapValue>& values, const std::uint8_t* from, std::uint8_t* to) {
    turn_all(a, values, from, to);
}

std::vector<MapValue> shown_values(registers::RegisterImage& image, const AssemblySpec& a) {
    UnitMap* const map = image.unit(a.unit);
    return map ? map->values(a.table, a.address, a.registers, false) : std::vector<MapValue>();
}

void show_window(registers::RegisterImage& image, const AssemblySpec& a, const std::vector<MapValue>& values, Instant now, cip::Bytes& to) {
    const std::size_t begin = to.size();
    to.resize(begin + a.bytes());
    UnitMap* const map = image.unit(a.unit);
    if (!map) return;
    std::uint8_t words[2 * most_assembly_registers];
    map->show(a.table, a.address, a.registers, now, words);
    to_assembly(a, values, words, to.data() + begin);
}

std::uint64_t window_revision(registers::RegisterImage& image, const AssemblySpec& a, const std::vector<MapValue>& values, Instant now) {
    UnitMap* const map = image.unit(a.unit);
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    if (!map) return hash;
    std::uint8_t words[2 * most_assembly_registers];
    map->show(a.table, a.address, a.registers, now, words);
    for (const MapValue& v : values) {
        if (!v.steady()) continue;
        const std::size_t at = 2 * std::size_t(v.address - a.address);
        for (std::size_t i = at; i < at + 2 * std::size_t{v.registers}; ++i)
            hash = (hash ^ words[i]) * 1099511628211u;
    }
    return hash;
}

WindowWritten write_window(registers::RegisterImage& image, registers::RegisterWriter& writer, const AssemblySpec& a,
                           registers::WriteOwner& owner, const Origin& origin, cip::View data, Instant now) {
    UnitMap* const map = image.unit(a.unit);
    if (!map) return {Reason::line_down, 0};
    const auto values = map->values(a.table, a.address, a.registers, true);
    std::vector<std::uint8_t> words(a.bytes());
    from_assembly(a, values, data.data(), words.data());
    registers::WritePlan plan;
    std::vector<registers::Refused> refused;
    map->renew(a.table, a.address, values, words.data(), plan, refused);
    registers::RequestNote note;
    note.unit = a.unit;
    note.write = true;
    note.table = a.table;
    note.address = a.address;
    note.count = a.registers;
    const Reason why = refused.empty() ? Reason::none : refused.front().reason == Reason::none ? Reason::internal : refused.front().reason;
    for (auto& r : refused)
        writer.refused(*origin.who, std::move(r), note, {}, now);
    // A language has accepted the values that were not refused; values of a user map wait for each other.
    if (why != Reason::none && !map->takes_images()) return {why, 0};
    const auto begun = writer.give(client_of(&owner, origin), 0, *map, plan, note, now);
    return begun.verdict == Verdict::good ? WindowWritten{why, begun.outstanding} : WindowWritten{Reason::busy, 0};
}

WindowOutput::WindowOutput(DoorPort& port, registers::RegisterImage& image, registers::RegisterWriter& writer, Counter& commands,
                           AssemblySpec spec, Origin origin)
    : port_(port),
      image_(image),
      writer_(writer),
      commands_(commands),
      spec_(std::move(spec)),
      client_(client_of(this, origin)),
      newest_(spec_.bytes()),
      before_(spec_.bytes()) {
    UnitMap* const map = image_.unit(spec_.unit);
    if (!map) return;
    values_ = map->values(spec_.table, spec_.address, spec_.registers, in_outputs(spec_));
    writes_.resize(values_.size());
    for (const MapValue& v : values_) {
        if (const std::uint8_t member = v.point ? member_of(*v.point) : std::uint8_t{0}) members_[v.axis] |= member;
    }
}

WindowOutput::~WindowOutput() { writer_.forget(*this); }

void WindowOutput::reset() {
    any_ = false;
    wanted_.clear();
    for (Write& w : writes_)
        w.due = false;
}

bool WindowOutput::differs(std::size_t i) const {
    const std::size_t at = 2 * std::size_t(values_[i].address - spec_.address);
    return std::memcmp(newest_.data() + at, before_.data() + at, 2 * std::size_t{values_[i].registers}) != 0;
}

registers::RequestNote WindowOutput::note_of(const MapValue& v) const {
    registers::RequestNote note;
    note.unit = spec_.unit;
    note.write = true;
    note.table = spec_.table;
    note.address = v.address;
    note.count = v.registers;
    for (std::size_t i = 0; i < std::min<std::size_t>(v.registers, registers::RequestNote::most_shown); ++i)
        note.values[i] = registers::get16(newest_.data() + 2 * (std::size_t(v.address - spec_.address) + i));
    return note;
}

void WindowOutput::tell_refusals(const MapValue& of, Instant now) {
    for (auto& r : refused_)
        writer_.refused(*client_.who, std::move(r), note_of(of), {}, now);
    refused_.clear();
}

void WindowOutput::take(cip::View data, Instant now) {
    UnitMap* const map = image_.unit(spec_.unit);
    if (!map || data.size() != spec_.bytes()) return;
    from_assembly(spec_, values_, data.data(), newest_.data());
    // A language that a change of the site has made anew does not know the earlier images.
    if (std::exchange(seen_, map) != map && map->takes_images()) any_ = false;
    const bool first = !std::exchange(any_, true);
    if (map->takes_images()) {
        take_image(*map, first, now);
    } else {
        take_values(*map, first, now);
    }
    before_ = newest_;
}

void WindowOutput::take_image(UnitMap& map, bool first, Instant now) {
    plan_.commands.clear();
    if (first) {
        map.adopt(spec_.table, spec_.address, spec_.registers, newest_.data(), plan_);
        changed_.clear();
    } else {
        changed_.clear();
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (differs(i)) changed_.push_back(values_[i]);
        }
        if (changed_.empty()) return;
        map.renew(spec_.table, spec_.address, changed_, newest_.data(), plan_, refused_);
        tell_refusals(changed_.front(), now);
    }
    if (plan_.commands.empty()) return;
    const MapValue& of = changed_.empty() ? values_.front() : changed_.front();
    commands_.add(plan_.commands.size());
    if (writer_.give(client_, whole, map, plan_, note_of(of), now).verdict == Verdict::busy)
        writer_.refused(*client_.who, {of.axis, Reason::busy, "too many writes wait for their drives", {}, {}}, note_of(of), {}, now);
}

void WindowOutput::take_values(UnitMap& map, bool first, Instant now) {
    changed_.clear();
    for (std::size_t i = 0; i < values_.size(); ++i) {
        if (!first && !differs(i)) continue;
        if (values_[i].point) {
            changed_.push_back(values_[i]);
        } else if (!first) {
            writes_[i].due = true;
        }
    }
    for (const MapValue& v : changed_) {
        plan_.commands.clear();
        map.renew(spec_.table, spec_.address, {&v, 1}, newest_.data(), plan_, refused_);
        tell_refusals(v, now);
        for (const auto& c : plan_.commands) {
            if (const auto* d = std::get_if<ProcessData>(&c.body)) overlay(wanted_[c.axis], *d);
        }
    }
    for (std::size_t i = 0; i < values_.size(); ++i) {
        if (writes_[i].due && !writes_[i].on_its_way) write_one(map, i, now);
    }
}

void WindowOutput::write_one(UnitMap& map, std::size_t i, Instant now) {
    writes_[i].due = false;
    plan_.commands.clear();
    map.renew(spec_.table, spec_.address, {&values_[i], 1}, newest_.data(), plan_, refused_);
    tell_refusals(values_[i], now);
    if (plan_.commands.empty()) return;
    const auto begun = writer_.give(client_, static_cast<std::uint8_t>(i), map, plan_, note_of(values_[i]), now);
    writes_[i].on_its_way = begun.outstanding > 0;
    writes_[i].due = begun.verdict == Verdict::busy;
    if (begun.verdict == Verdict::good) commands_.add();
}

void WindowOutput::on_written(std::uint8_t slot, AxisId, Verdict) {
    if (slot >= writes_.size()) return;
    writes_[slot].on_its_way = false;
    UnitMap* const map = image_.unit(spec_.unit);
    if (writes_[slot].due && map) write_one(*map, slot, port_.now());
}

}  // namespace axisgate::enip
