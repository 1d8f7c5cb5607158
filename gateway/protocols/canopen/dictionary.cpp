// Dictionary: checks reads and writes in the order of the standard: existence, access, length, bounds, then the owner's hook.
#include "gateway/protocols/canopen/dictionary.hpp"

#include <array>
#include <utility>

namespace axisgate::canopen {
namespace {
constexpr std::array<std::pair<EntryAccess, std::string_view>, 6> access_names{{{EntryAccess::read_only, "ro"},
                                                                                {EntryAccess::write_only, "wo"},
                                                                                {EntryAccess::read_write, "rw"},
                                                                                {EntryAccess::read_write_input, "rwr"},
                                                                                {EntryAccess::read_write_output, "rww"},
                                                                                {EntryAccess::constant, "const"}}};

Abort length_fault(const Entry& e, std::size_t size) {
    const auto bytes = bytes_of(e.type);
    const std::size_t most = bytes ? *bytes : e.most_bytes;
    if (most != 0 && size > most) return Abort::too_long;
    return bytes && size < *bytes ? Abort::too_short : Abort::none;
}
std::uint32_t key_of(Address a) noexcept { return std::uint32_t{a.index} << 8 | a.sub; }
}  // namespace

std::string_view name_of(EntryAccess access) noexcept { return access_names[static_cast<std::size_t>(access)].second; }
std::optional<EntryAccess> entry_access_named(std::string_view name) noexcept {
    for (const auto& [access, word] : access_names) {
        if (word == name) return access;
    }
    return std::nullopt;
}

Dictionary::Dictionary(const Dictionary& of) : SdoStore(of), entries_(of.entries_), on_write_(of.on_write_), on_read_(of.on_read_) {
    for (auto& [address, entry] : entries_)
        places_[key_of(address)] = &entry;
}

void Dictionary::add(Address address, Entry entry) {
    const auto bytes = bytes_of(entry.type);
    if (bytes && entry.bytes.size() != *bytes) entry.bytes.assign(*bytes, 0);
    Entry& place = entries_[address];
    place = std::move(entry);
    places_[key_of(address)] = &place;
}
Entry* Dictionary::at(Address address) const {
    const auto it = places_.find(key_of(address));
    return it == places_.end() ? nullptr : it->second;
}
const Entry* Dictionary::find(Address address) const { return at(address); }
bool Dictionary::has(std::uint16_t index) const {
    const auto it = entries_.lower_bound(Address{index, 0});
    return it != entries_.end() && it->first.index == index;
}

bool Dictionary::set(Address address, const Value& value) {
    const Entry* e = find(address);
    const auto bytes = e ? encode(e->type, value) : std::nullopt;
    return bytes && set_bytes(address, *bytes);
}
bool Dictionary::set_bytes(Address address, std::span<const std::uint8_t> bytes) {
    Entry* const e = at(address);
    if (!e || fits(*e, bytes) != Abort::none) return false;
    e->bytes.assign(bytes.begin(), bytes.end());
    return true;
}
Value Dictionary::value(Address address) const {
    const Entry* e = find(address);
    return e ? decode(e->type, e->bytes).value_or(Value{}) : Value{};
}
std::optional<std::int64_t> Dictionary::integer(Address address) const { return as_integer(value(address)); }

Abort Dictionary::missing(Address address) const { return has(address.index) ? Abort::no_subindex : Abort::no_object; }

Abort Dictionary::fits(const Entry& e, std::span<const std::uint8_t> bytes) {
    const Abort length = length_fault(e, bytes.size());
    if (length != Abort::none || (!e.low && !e.high) || !range_of(e.type)) return length;
    const auto value = decode(e.type, bytes);
    const auto n = value ? as_integer(*value) : std::nullopt;
    // A value without a number is an UNSIGNED64 above every bound.
    if (e.high && (!n || *n > *e.high)) return Abort::too_high;
    if (e.low && n && *n < *e.low) return Abort::too_low;
    return Abort::none;
}

Abort Dictionary::read(Address address, std::vector<std::uint8_t>& into) {
    const Entry* e = find(address);
    if (!e) return missing(address);
    if (!can_read(e->access)) return Abort::write_only;
    const Abort fault = on_read_ ? on_read_(address) : Abort::none;
    if (fault == Abort::none) into = e->bytes;
    return fault;
}
Abort Dictionary::admits(Address address, std::optional<std::size_t> size) {
    const Entry* e = find(address);
    if (!e) return missing(address);
    if (!can_write(e->access)) return Abort::read_only;
    return size ? length_fault(*e, *size) : Abort::none;
}
Abort Dictionary::write(Address address, std::span<const std::uint8_t> bytes, bool sized) {
    const Abort fault = admits(address, std::nullopt);
    if (fault != Abort::none) return fault;
    Entry& e = *at(address);
    if (const auto type = bytes_of(e.type); type && !sized && bytes.size() > *type) bytes = bytes.first(*type);
    const Abort wrong = fits(e, bytes);
    if (wrong != Abort::none) return wrong;
    const std::vector<std::uint8_t> kept(bytes.begin(), bytes.end());
    const Abort refused = on_write_ ? on_write_(address, kept) : Abort::none;
    if (refused == Abort::none) e.bytes = kept;
    return refused;
}

}  // namespace axisgate::canopen
