// AxisValues, the classes of another maker's device: an attribute is a register of a profile, read and written as over Modbus. The unit's
// map defines the meaning of a register, so there is no second translation.
#include <algorithm>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/registers/words.hpp"

namespace axisgate::enip {
namespace {
using cip::DataType;
using cip::General;
using registers::Verdict;

DataType type_of(MapType type) noexcept {
    switch (type) {
        case MapType::u16:
            return DataType::uint16;
        case MapType::i16:
            return DataType::int16;
        case MapType::u32:
            return DataType::udint;
        case MapType::f32:
            return DataType::real;
        default:
            return DataType::dint;
    }
}

General general_of(Verdict verdict) noexcept {
    switch (verdict) {
        case Verdict::good:
            return General::success;
        case Verdict::no_address:
            return General::attribute_not_supported;
        case Verdict::bad_value:
            return General::invalid_attribute_value;
        case Verdict::busy:
            return General::resource_unavailable;
        case Verdict::no_path:
        case Verdict::no_answer:
            return General::connection_lost;
        case Verdict::failed:
            break;
    }
    return General::device_state_conflict;
}
}  // namespace

bool AxisValues::has_own_class(std::uint32_t class_id) const {
    return std::ranges::any_of(layout_.objects(), [&](const LayoutObjects& o) {
        return std::ranges::any_of(o.page->rows,
                                   [&](const registers::LanguageRow& r) { return r.object && r.object->class_id == class_id; });
    });
}

std::optional<cip::Values::OwnAttribute> AxisValues::own_attribute(std::uint32_t class_id, std::uint32_t instance,
                                                                   std::uint32_t attribute) const {
    const auto found = layout_.object_row(class_id, instance, attribute);
    if (!found.row) return std::nullopt;
    return OwnAttribute{type_of(found.row->type), found.row->readable, found.row->writable};
}

General AxisValues::get_own(const OwnPlace& place, Instant now, cip::Bytes& to) {
    const auto found = layout_.object_row(place.class_id, place.instance, place.attribute);
    registers::UnitMap* const map = found.row ? image_.unit(found.object->unit) : nullptr;
    if (!map) return General::object_does_not_exist;
    std::uint8_t bytes[4] = {};
    const auto verdict = map->read_registers(registers::Table::holding_registers, found.row->address, found.row->width(), now, bytes);
    const auto why = map->take_refused().reason;
    if (verdict != Verdict::good) return why == Reason::none ? general_of(verdict) : enip::general_of(why);
    if (found.row->width() == 1) {
        cip::put16(to, registers::get16(bytes));
    } else {
        const auto values = map->values(registers::Table::holding_registers, found.row->address, 2, false);
        cip::put32(to, registers::get32(bytes, values.empty() ? found.object->page->word_order : values.front().order));
    }
    return General::success;
}

General AxisValues::set_own(const OwnPlace& place, cip::View value, cip::Token token, const cip::Peer& who, Instant now, bool& later) {
    const auto found = layout_.object_row(place.class_id, place.instance, place.attribute);
    registers::UnitMap* const map = found.row ? image_.unit(found.object->unit) : nullptr;
    if (!map) return General::object_does_not_exist;
    if (own_writes_.size() >= most_asked) return General::resource_unavailable;
    const auto values = map->values(registers::Table::holding_registers, found.row->address, found.row->width(), true);
    if (values.empty()) return General::attribute_not_settable;
    std::uint8_t words[4] = {};
    if (found.row->width() == 1) {
        registers::put16(words, cip::Reader(value).u16());
    } else {
        registers::put32(words, cip::Reader(value).u32(), values.front().order);
    }
    registers::RequestNote note;
    note.unit = found.object->unit;
    note.write = true;
    note.address = found.row->address;
    note.count = found.row->width();
    for (std::size_t i = 0; i < found.row->width(); ++i)
        note.values[i] = registers::get16(words + 2 * i);
    const Origin origin = commander_for(found.object->axis, who);
    const auto [it, fresh] = own_writes_.try_emplace(token, *this, token, origin);
    if (!fresh) return General::resource_unavailable;
    counters_.parameters.add();
    const auto begun = writer_.write({&it->second, origin.who, origin.client}, 0, *map, registers::Table::holding_registers,
                                     found.row->address, found.row->width(), words, note, now);
    auto why = map->take_refused();
    const Reason reason = why.reason;
    // A language may accept a write and report in its own error word that it was not carried out.
    if (reason != Reason::none) writer_.refused(*origin.who, std::move(why), note, {}, now);
    if (begun.verdict == Verdict::good && begun.outstanding > 0) {
        it->second.left = begun.outstanding;
        later = true;
        return General::success;
    }
    own_writes_.erase(it);
    if (begun.verdict == Verdict::good) return General::success;
    return reason == Reason::none ? general_of(begun.verdict) : enip::general_of(reason);
}

void AxisValues::OwnWrite::on_written(std::uint8_t, AxisId, Verdict v) {
    if (v != Verdict::good && general == General::success) general = general_of(v);
    if (--left > 0) return;
    AxisValues& of = values;
    const cip::Token t = token;
    const General g = general;
    of.own_writes_.erase(t);  // this is no more
    of.answered_(t, g, {}, 0);
}

}  // namespace axisgate::enip
