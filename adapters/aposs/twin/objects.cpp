// Entries with type, access, limits and init value, from the catalogue and the profile.
#include "adapters/aposs/twin/objects.hpp"

#include <cmath>

#include "adapters/cia402/twin/objects.hpp"

namespace axisgate::aposs {
namespace {
using canopen::DataType;
using canopen::EntryAccess;
using canopen::Mappable;

std::optional<int> whole_in(const boost::json::object& wire, std::string_view key) {
    const auto* v = wire.if_contains(key);
    return v && v->is_int64() ? std::optional(static_cast<int>(v->as_int64())) : std::nullopt;
}

canopen::Entry entry_of(const Parameter& p) {
    canopen::Entry e;
    e.type = DataType::integer32;
    e.access = p.writable() ? EntryAccess::read_write : EntryAccess::read_only;
    e.name = p.id;
    if (p.min) e.low = static_cast<std::int64_t>(std::ceil(*p.min));
    if (p.max) e.high = static_cast<std::int64_t>(std::floor(*p.max));
    if (p.id == "HOME_FORCE") e.high = 255;  // forced and completed: it can be read, and is refused when written
    return e;
}
}  // namespace

Objects::Objects(const Catalogue& catalogue, std::uint8_t node, std::int64_t extra_pdo_ms)
    : factory_(cia402_drive::twin::factory_dictionary(node)) {
    for (std::uint16_t n = 0; extra_pdo_ms != 0 && n < 4; ++n)
        (void)factory_.set({static_cast<std::uint16_t>(0x1800 + n), 5}, Value{extra_pdo_ms});
    // HOME of the manual, configured by HOME_TYPE, is a manufacturer-specific method besides those of CiA 402 (E-76).
    const auto methods = factory_.integer({0x60E3, 0}).value_or(0);
    canopen::Entry own = *factory_.find({0x60E3, 1});
    own.name = "HOME by HOME_TYPE";
    factory_.add({0x60E3, static_cast<std::uint8_t>(methods + 1)}, own);
    (void)factory_.set({0x60E3, static_cast<std::uint8_t>(methods + 1)}, Value{std::int64_t{-1}});
    (void)factory_.set({0x60E3, 0}, Value{methods + 1});
    // The profile objects of the second axis, and the motions of this controller: POSA and POSR, CVEL, HOME.
    const auto first = factory_.entries();
    for (const auto& [address, entry] : first) {
        if (address.index < 0x6000 || address.index >= 0x6800 || address.index == 0x6007) continue;
        factory_.add({static_cast<std::uint16_t>(address.index + per_axis), address.sub}, entry);
    }
    for (int a = 0; a < axes; ++a)
        (void)factory_.set({static_cast<std::uint16_t>(0x6502 + per_axis * a), 0}, Value{std::int64_t{0x25}});
    const std::string title = "MACS (model)";
    factory_.add(
        {0x1008, 0},
        {DataType::visible_string, EntryAccess::constant, Mappable::no, "Manufacturer device name", {title.begin(), title.end()}, {}, {}});

    for (const Parameter& p : catalogue.parameters()) {
        const auto index = whole_in(p.wire, "index"), sub = whole_in(p.wire, "sub");
        if (!index || !sub || *index >= 0x6000) continue;  // the profile's objects exist already
        const int step = whole_in(p.wire, "per_axis").value_or(0);
        const auto* scope = p.wire.if_contains("scope");
        const bool of_axis = scope && scope->is_string() && scope->as_string() == "axis" && step != 0;
        for (int a = 0; a < (of_axis ? axes : 1); ++a) {
            Row row;
            row.address = {static_cast<std::uint16_t>(*index + step * a), static_cast<std::uint8_t>(*sub)};
            // A variable without its own number is identified by its address.
            row.key = {of_axis ? Scope::axis : Scope::global, a, whole_in(p.wire, "number").value_or(*index * 256 + *sub)};
            row.id = p.id;
            row.storage = p.storage;
            row.initial = as_integer(p.factory_default).value_or(0);
            for (const auto& [number, meaning] : p.allowed)
                row.allowed.push_back(number);
            factory_.add(row.address, entry_of(p));
            (void)factory_.set(row.address, Value{row.initial});
            const Key key = row.key;
            const Row& kept = rows_.insert_or_assign(key, std::move(row)).first->second;
            places_[kept.address] = &kept;
            for (int k = 0; k < axes; ++k)
                if (!of_axis || k == a) names_[static_cast<std::size_t>(k)][kept.id] = &kept;
        }
    }
}

const Row* Objects::at(Address address) const {
    const auto it = places_.find(address);
    return it == places_.end() ? nullptr : it->second;
}
const Row* Objects::of(const Key& key) const {
    const auto it = rows_.find(key);
    return it == rows_.end() ? nullptr : &it->second;
}
const Row* Objects::named(std::string_view id, int axis) const {
    const auto& names = names_[static_cast<std::size_t>(axis)];
    const auto it = names.find(id);
    return it == names.end() ? nullptr : it->second;
}

}  // namespace axisgate::aposs
