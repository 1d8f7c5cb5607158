// PDO: mapping words, the bits of a frame, and the reads and writes of a node's dictionary. Every mapping is checked before it is used.
#include "gateway/protocols/canopen/pdo.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::canopen {
namespace {
constexpr std::uint8_t id_sub = 1, transmission_sub = 2, inhibit_sub = 3, event_sub = 5;
constexpr std::uint32_t invalid_bit = 1u << 31, no_remote_bit = 1u << 30, extended_bit = 1u << 29;

std::vector<std::uint8_t> bytes_of_number(std::uint64_t value, std::size_t n) {
    std::vector<std::uint8_t> b(n);
    put_low_first(value, b);
    return b;
}
bool is_gap(Address a) { return a.index >= 1 && a.index <= 0x1F && a.sub == 0; }
std::uint64_t mask(std::size_t bits) { return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1; }
}  // namespace

std::uint32_t mapping_word(const MappedEntry& e) noexcept {
    return std::uint32_t{e.address.index} << 16 | std::uint32_t{e.address.sub} << 8 | e.bits;
}
MappedEntry mapped_entry(std::uint32_t word) noexcept {
    return {{static_cast<std::uint16_t>(word >> 16), static_cast<std::uint8_t>(word >> 8)}, static_cast<std::uint8_t>(word)};
}
std::size_t bits_of(const PdoMapping& mapping) noexcept {
    std::size_t n = 0;
    for (const auto& e : mapping)
        n += e.bits;
    return n;
}
Abort fault_of(const PdoMapping& mapping) noexcept {
    if (mapping.size() > most_mapped || bits_of(mapping) > pdo_bits) return Abort::pdo_length;
    const bool empty = std::ranges::any_of(mapping, [](const MappedEntry& e) { return e.bits == 0; });
    return empty ? Abort::length : Abort::none;
}
Abort fault_of(const PdoMapping& mapping, PdoDirection direction, const Dictionary& dictionary) {
    for (const auto& e : mapping) {
        if (direction == PdoDirection::receive && is_gap(e.address)) {
            const auto type = data_type_of(e.address.index);
            const auto bits = type ? canopen::bits_of(*type) : std::nullopt;
            if (!bits) return Abort::not_mappable;
            if (*bits != e.bits) return Abort::length;
            continue;
        }
        const Entry* entry = dictionary.find(e.address);
        if (!entry) return dictionary.has(e.address.index) ? Abort::no_subindex : Abort::no_object;
        const bool way = entry->mappable == Mappable::both ||
                         entry->mappable == (direction == PdoDirection::transmit ? Mappable::transmit : Mappable::receive);
        if (!way) return Abort::not_mappable;
        if (canopen::bits_of(entry->type).value_or(entry->bytes.size() * 8) != e.bits) return Abort::length;
    }
    return fault_of(mapping);
}

PdoLength unpack(const PdoMapping& mapping, std::span<const std::uint8_t> bytes, std::vector<std::uint64_t>& into) {
    const std::size_t need = (bits_of(mapping) + 7) / 8;
    if (fault_of(mapping) != Abort::none || bytes.size() < need) return PdoLength::shorter;
    const std::uint64_t raw = low_first(bytes.first(need));
    std::size_t at = 0;
    into.clear();
    for (const auto& e : mapping) {
        into.push_back(raw >> at & mask(e.bits));
        at += e.bits;
    }
    return bytes.size() > need ? PdoLength::longer : PdoLength::fits;
}
std::optional<std::vector<std::uint8_t>> pack(const PdoMapping& mapping, std::span<const std::uint64_t> values) {
    if (fault_of(mapping) != Abort::none) return std::nullopt;
    std::uint64_t raw = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < mapping.size(); ++i) {
        if (i < values.size()) raw |= (values[i] & mask(mapping[i].bits)) << at;
        at += mapping[i].bits;
    }
    return bytes_of_number(raw, (at + 7) / 8);
}
std::int64_t as_signed(std::uint64_t raw, std::uint8_t bits) noexcept {
    const int shift = 64 - std::clamp<int>(bits, 1, 64);
    return static_cast<std::int64_t>(raw << shift) >> shift;
}

std::uint32_t id_word(const PdoSettings& s) noexcept {
    return (s.id & (s.extended ? 0x1FFFFFFFu : 0x7FFu)) | (s.extended ? extended_bit : 0) | (s.remote_allowed ? 0 : no_remote_bit) |
           (s.valid ? 0 : invalid_bit);
}
void set_id_word(PdoSettings& s, std::uint32_t word) noexcept {
    s.extended = (word & extended_bit) != 0;
    s.remote_allowed = (word & no_remote_bit) == 0;
    s.valid = (word & invalid_bit) == 0;
    s.id = word & (s.extended ? 0x1FFFFFFFu : 0x7FFu);
}
std::uint16_t settings_index(PdoDirection direction, std::uint16_t number) noexcept {
    return static_cast<std::uint16_t>((direction == PdoDirection::receive ? 0x1400 : 0x1800) + number - 1);
}
std::uint16_t mapping_index(PdoDirection direction, std::uint16_t number) noexcept {
    return static_cast<std::uint16_t>(settings_index(direction, number) + 0x200);
}

std::vector<SdoWrite> writes_of(const Pdo& pdo) {
    std::vector<SdoWrite> w;
    if (fault_of(pdo.mapping) != Abort::none) return w;
    const std::uint16_t settings = settings_index(pdo.direction, pdo.number), mapping = mapping_index(pdo.direction, pdo.number);
    w.push_back({{settings, id_sub}, bytes_of_number(id_word(pdo.settings) | invalid_bit, 4)});
    w.push_back({{settings, transmission_sub}, bytes_of_number(pdo.settings.transmission, 1)});
    if (pdo.settings.inhibit_100us != 0) w.push_back({{settings, inhibit_sub}, bytes_of_number(pdo.settings.inhibit_100us, 2)});
    if (pdo.settings.event_ms != 0) w.push_back({{settings, event_sub}, bytes_of_number(pdo.settings.event_ms, 2)});
    w.push_back({{mapping, 0}, bytes_of_number(0, 1)});
    for (std::size_t i = 0; i < pdo.mapping.size(); ++i)
        w.push_back({{mapping, static_cast<std::uint8_t>(i + 1)}, bytes_of_number(mapping_word(pdo.mapping[i]), 4)});
    w.push_back({{mapping, 0}, bytes_of_number(pdo.mapping.size(), 1)});
    if (pdo.settings.valid) w.push_back({{settings, id_sub}, bytes_of_number(id_word(pdo.settings), 4)});
    return w;
}

PdoReader::PdoReader(PdoDirection direction, std::uint16_t number) noexcept {
    pdo_.direction = direction;
    pdo_.number = number;
}
std::optional<Address> PdoReader::next() const noexcept {
    const std::uint16_t settings = settings_index(pdo_.direction, pdo_.number), mapping = mapping_index(pdo_.direction, pdo_.number);
    switch (step_) {
        case Step::id:
            return Address{settings, id_sub};
        case Step::transmission:
            return Address{settings, transmission_sub};
        case Step::inhibit:
            return Address{settings, inhibit_sub};
        case Step::event:
            return Address{settings, event_sub};
        case Step::count:
            return Address{mapping, 0};
        case Step::entries:
            return Address{mapping, static_cast<std::uint8_t>(pdo_.mapping.size() + 1)};
        case Step::over:
            break;
    }
    return std::nullopt;
}
void PdoReader::fail(Abort why) noexcept {
    step_ = Step::over;
    fault_ = why;
}
void PdoReader::on_value(std::span<const std::uint8_t> bytes) {
    static constexpr std::size_t lengths[] = {4, 1, 2, 2, 1, 4};
    if (step_ == Step::over) return;
    if (bytes.size() != lengths[static_cast<std::size_t>(step_)]) return fail(Abort::length);
    const auto n = static_cast<std::uint32_t>(low_first(bytes));
    switch (step_) {
        case Step::id:
            set_id_word(pdo_.settings, n);
            step_ = Step::transmission;
            return;
        case Step::transmission:
            pdo_.settings.transmission = static_cast<std::uint8_t>(n);
            step_ = pdo_.direction == PdoDirection::transmit ? Step::inhibit : Step::event;
            return;
        case Step::inhibit:
            pdo_.settings.inhibit_100us = static_cast<std::uint16_t>(n);
            step_ = Step::event;
            return;
        case Step::event:
            pdo_.settings.event_ms = static_cast<std::uint16_t>(n);
            step_ = Step::count;
            return;
        case Step::count:
            // 254 and 255 mean multiplexed PDOs, which have no such mapping.
            if (n > most_mapped) return fail(Abort::pdo_length);
            count_ = static_cast<std::uint8_t>(n);
            step_ = count_ == 0 ? Step::over : Step::entries;
            return;
        default:
            pdo_.mapping.push_back(mapped_entry(n));
            if (pdo_.mapping.size() < count_) return;
            step_ = Step::over;
            fault_ = fault_of(pdo_.mapping);
    }
}
void PdoReader::on_refused(Abort why) {
    if (step_ == Step::inhibit) {
        step_ = Step::event;
    } else if (step_ == Step::event) {
        step_ = Step::count;
    } else if (step_ != Step::over) {
        fail(why == Abort::none ? Abort::general : why);
    }
}

std::optional<Pdo> pdo_of(Dictionary& dictionary, PdoDirection direction, std::uint16_t number, Abort& fault) {
    PdoReader reader(direction, number);
    std::vector<std::uint8_t> bytes;
    while (const auto address = reader.next()) {
        const Abort refused = dictionary.read(*address, bytes);
        if (refused == Abort::none) {
            reader.on_value(bytes);
        } else {
            reader.on_refused(refused);
        }
    }
    fault = reader.fault();
    return fault == Abort::none ? std::optional(reader.pdo()) : std::nullopt;
}

}  // namespace axisgate::canopen
