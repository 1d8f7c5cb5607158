// EDS: the values of a description, and the object dictionary made from it.
#include "gateway/protocols/canopen/eds.hpp"

#include <utility>

namespace axisgate::canopen {

Value EdsValue::of(std::uint8_t node) const {
    const auto* n = std::get_if<std::int64_t>(&value);
    return plus_node && n ? Value{*n + node} : value;
}
bool EdsEntry::operator==(const EdsEntry& o) const {
    return name == o.name && type == o.type && access == o.access && mappable == o.mappable && low == o.low && high == o.high &&
           fallback == o.fallback && configured == o.configured && flags == o.flags;
}

Dictionary dictionary_of(const Eds& eds, std::uint8_t node) {
    Dictionary d;
    for (const auto& [address, e] : eds.entries) {
        Entry entry;
        entry.type = e.type;
        entry.access = e.access;
        entry.name = e.name;
        if (e.mappable) {
            switch (e.access) {
                case EntryAccess::write_only:
                case EntryAccess::read_write_output:
                    entry.mappable = Mappable::receive;
                    break;
                case EntryAccess::read_write:
                    entry.mappable = Mappable::both;
                    break;
                default:
                    entry.mappable = Mappable::transmit;
            }
        }
        entry.low = as_integer(e.low.of(node));
        entry.high = as_integer(e.high.of(node));
        const Value value = (e.configured.given() ? e.configured : e.fallback).of(node);
        if (auto bytes = encode(e.type, value)) entry.bytes = std::move(*bytes);
        d.add(address, std::move(entry));
    }
    return d;
}

}  // namespace axisgate::canopen
