// EDS reader: turns sections into objects and entries. A row that cannot be used is left out or read by the nearest rule, with a note that
// says which row and what was done, because makers' files are seldom without one. A file without an object is a fault.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/protocols/canopen/eds.hpp"
#include "gateway/protocols/canopen/eds_numbers.hpp"

namespace axisgate::canopen {
namespace {

class Reader {
public:
    Reader(const Ini& ini, std::vector<FileFault>& faults, std::vector<FileFault>& notes) : ini_(ini), faults_(faults), notes_(notes) {}

    Eds read() {
        device();
        lists();
        for (const IniSection& s : ini_.sections())
            section(s);
        for (const auto& [index, line] : listed_) {
            if (!ini_.find(fmt::format("{:04x}", index))) note(line, fmt::format("the object {:04X}h is listed and has no section", index));
        }
        check_subs();
        if (eds_.entries.empty()) fault(0, "no object is described: this is no EDS or DCF");
        commissioning();
        return std::move(eds_);
    }

private:
    void fault(std::size_t line, std::string text) { add_fault(faults_, line, std::move(text)); }
    void note(std::size_t line, std::string text) { add_note(notes_, line, std::move(text)); }
    void unusual(std::size_t line, std::string_view key, std::string_view text, std::string_view read_as) {
        note(line, fmt::format("{} is written as \"{}\": read as {}", key, shown_text(text), read_as));
    }

    /// The number of a key that may be missing or empty.
    std::optional<std::uint64_t> whole_in(const IniSection& s, std::string_view key, std::uint64_t most) {
        const IniKey* k = s.find(key);
        if (!k || without_comment(k->value).empty()) return std::nullopt;
        const auto number = eds_number(k->value);
        const auto n = eds_whole(k->value, most);
        if (!n) {
            note(k->line, fmt::format("{} of [{}] is \"{}\", and must be a whole number up to {}: left out", key, s.name,
                                      shown_text(k->value), most));
        } else if (number->unusual) {
            unusual(k->line, fmt::format("{} of [{}]", key, s.name), k->value, fmt::format("{}", *n));
        }
        return n;
    }
    static std::string text_in(const IniSection& s, std::string_view key) {
        const IniKey* k = s.find(key);
        return k ? k->value : std::string();
    }

    void device() {
        const IniSection* s = ini_.find("deviceinfo");
        if (!s) return note(0, "the section [DeviceInfo] is missing: maker and product are not known");
        eds_.vendor = text_in(*s, "vendorname");
        eds_.product = text_in(*s, "productname");
        eds_.order_code = text_in(*s, "ordercode");
        const auto number = [&](std::string_view key) -> std::optional<std::uint32_t> {
            const auto n = whole_in(*s, key, UINT32_MAX);
            return n ? std::optional(static_cast<std::uint32_t>(*n)) : std::nullopt;
        };
        eds_.vendor_number = number("vendornumber");
        eds_.product_number = number("productnumber");
        eds_.revision_number = number("revisionnumber");
        eds_.receive_pdos = static_cast<std::uint32_t>(whole_in(*s, "nrofrxpdo", 512).value_or(0));
        eds_.transmit_pdos = static_cast<std::uint32_t>(whole_in(*s, "nroftxpdo", 512).value_or(0));
        for (const std::uint32_t rate : {10u, 20u, 50u, 125u, 250u, 500u, 800u, 1000u}) {
            if (whole_in(*s, fmt::format("baudrate_{}", rate), 1) == 1u) eds_.kbits.push_back(rate);
        }
    }

    void lists() {
        for (const std::string_view name : {"mandatoryobjects", "optionalobjects", "manufacturerobjects"}) {
            const IniSection* s = ini_.find(name);
            if (!s) continue;
            std::size_t count = 0;
            for (const IniKey& k : s->keys) {
                if (k.name == "supportedobjects") continue;
                if (without_comment(k.value).empty()) continue;
                const auto index = eds_whole(k.value, 0xFFFF);
                ++count;
                if (!index) {
                    note(k.line, fmt::format("\"{}\" is no index of an object: left out", shown_text(k.value)));
                } else if (!listed_.emplace(static_cast<std::uint16_t>(*index), k.line).second) {
                    note(k.line, fmt::format("the object {:04X}h is listed twice", *index));
                }
            }
            const auto stated = whole_in(*s, "supportedobjects", 0xFFFF);
            if (stated && *stated != count) note(s->line, fmt::format("[{}] tells {} objects and lists {}", name, *stated, count));
        }
    }

    /// Reads "1018", "1018sub1", "1018name" and "1018value"; other sections do not describe objects.
    void section(const IniSection& s) {
        const auto digits = std::min(s.name.find_first_not_of("0123456789abcdef"), s.name.size());
        if (digits != 4) return;
        std::uint16_t index = 0;
        std::from_chars(s.name.data(), s.name.data() + 4, index, 16);
        const std::string_view rest = std::string_view(s.name).substr(4);
        if (rest.empty()) {
            object(s, index);
        } else if (rest.starts_with("sub")) {
            unsigned sub = 0;
            const std::string_view number = rest.substr(3);
            const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), sub, 16);
            if (error != std::errc{} || end != number.data() + number.size() || sub > 0xFF)
                return note(s.line,
                            fmt::format("[{}]: \"{}\" is no subindex (two hex digits): left out", shown_text(s.name), shown_text(number)));
            const IniSection* object = ini_.find(s.name.substr(0, 4));
            if (object && is_definition(eds_whole(text_in(*object, "objecttype"), 0xFF).value_or(7))) return;
            if (!object && eds_.objects.try_emplace(index, EdsObject{"", EdsShape::record}).second)
                note(s.line, fmt::format("[{}] has no object [{}]: read as a record without a name", s.name, s.name.substr(0, 4)));
            entry(s, {index, static_cast<std::uint8_t>(sub)});
        }
    }

    /// Whether the object is the definition of a type, which cannot be read from a device.
    static bool is_definition(std::uint64_t shape) { return shape == 5 || shape == 6; }

    void object(const IniSection& s, std::uint16_t index) {
        if (!listed_.contains(index)) note(s.line, fmt::format("the object {:04X}h stands in no list of objects", index));
        const bool has_type = s.find("datatype") != nullptr;
        const EdsShape by_type = has_type ? EdsShape::variable : EdsShape::record;
        auto shape = whole_in(s, "objecttype", 0xFF).value_or(static_cast<std::uint64_t>(by_type));
        if (is_definition(shape)) return;
        if (shape != 2 && shape != 7 && shape != 8 && shape != 9) {
            shape = static_cast<std::uint64_t>(by_type);
            note(s.line, fmt::format("ObjectType of {:04X}h is none (2 domain, 7 variable, 8 array, 9 record): read as {}", index, shape));
        }
        eds_.objects[index] = {text_in(s, "parametername"), static_cast<EdsShape>(shape)};
        if (shape == 2 || shape == 7) {
            entry(s, {index, 0});
        } else if (const auto compact = whole_in(s, "compactsubobj", 254)) {
            if (*compact > 0) compact_subs(s, index, static_cast<std::uint8_t>(*compact));
        }
    }

    void compact_subs(const IniSection& s, std::uint16_t index, std::uint8_t count) {
        EdsEntry number;
        number.name = "NrOfObjects";
        number.type = DataType::unsigned8;
        number.access = EntryAccess::read_only;
        number.fallback.value = std::int64_t{count};
        put({index, 0}, number, s.line);
        const auto each = described(s, {index, 1});
        if (!each) return;
        const IniSection* names = ini_.find(s.name + "name");
        const IniSection* values = ini_.find(s.name + "value");
        for (unsigned sub = 1; sub <= count; ++sub) {
            EdsEntry e = *each;
            e.line = 0;
            const IniKey* name = names ? names->find(fmt::format("{}", sub)) : nullptr;
            e.name = name ? name->value : fmt::format("{}{}", each->name, sub);
            if (const IniKey* v = values ? values->find(fmt::format("{}", sub)) : nullptr)
                e.configured = value(*v, e.type, {index, 1}, "its value");
            if (!put({index, static_cast<std::uint8_t>(sub)}, e, s.line)) return;
        }
    }

    bool put(Address address, EdsEntry e, std::size_t line) {
        if (eds_.entries.size() >= Eds::most_entries) {
            if (!full_) fault(line, fmt::format("more than {} entries: this is no description of a drive", Eds::most_entries));
            full_ = true;
            return false;
        }
        const auto [at, fresh] = eds_.entries.emplace(address, std::move(e));
        if (!fresh) note(line, fmt::format("{} is described twice: the first description counts", to_text(at->first)));
        return true;
    }

    void entry(const IniSection& s, Address address) {
        if (auto e = described(s, address)) put(address, std::move(*e), s.line);
    }

    std::optional<EdsEntry> described(const IniSection& s, Address address) {
        EdsEntry e;
        e.line = s.line;
        e.name = text_in(s, "parametername");
        const auto type = type_of(s, address);
        if (!type) return std::nullopt;
        e.type = *type;
        const IniKey* access = s.find("accesstype");
        const std::string word = access ? lower(without_comment(access->value)) : std::string();
        if (const auto known_access = entry_access_named(word)) {
            e.access = *known_access;
        } else if (!word.empty()) {
            e.access = EntryAccess::read_only;
            note(access->line, fmt::format("AccessType \"{}\" of {} is none (ro, wo, rw, rwr, rww or const): read as ro",
                                           shown_text(access->value), to_text(address)));
        } else if (e.type != DataType::domain) {
            e.access = EntryAccess::read_only;
            note(s.line, fmt::format("{} has no AccessType: read as ro", to_text(address)));
        }
        e.mappable = whole_in(s, "pdomapping", 1) == 1u;
        e.flags = static_cast<std::uint32_t>(whole_in(s, "objflags", UINT32_MAX).value_or(0));
        limits(s, address, e);
        return e;
    }

    /// Nothing if the section does not say it.
    std::optional<DataType> type_of(const IniSection& s, Address address) {
        const bool domain = eds_whole(text_in(s, "objecttype"), 0xFF) == 2u;
        const IniKey* key = s.find("datatype");
        const std::string_view word = key ? without_comment(key->value) : std::string_view();
        const auto number = eds_whole(word, 0xFFFF);
        if (const auto type = number ? data_type_of(*number) : std::nullopt) return type;
        if (domain) return DataType::domain;
        if (word.empty()) {
            note(s.line, fmt::format("{} has no DataType: left out", to_text(address)));
            return std::nullopt;
        }
        for (std::uint64_t n = 1; n <= 0x1B && !number; ++n) {
            const auto type = data_type_of(n);
            if (!type || lower(name_of(*type)) != lower(word)) continue;
            unusual(key->line, fmt::format("DataType of {}", to_text(address)), word, fmt::format("{}", n));
            return type;
        }
        note(key->line,
             fmt::format("DataType \"{}\" of {} is none of CiA 301's simple types: read as bytes", shown_text(word), to_text(address)));
        return DataType::octet_string;
    }

    void limits(const IniSection& s, Address address, EdsEntry& e) {
        const auto read = [&](std::string_view key, std::string_view shown_key) {
            const IniKey* k = s.find(key);
            return k ? value(*k, e.type, address, shown_key) : EdsValue{};
        };
        if (range_of(e.type) || e.type == DataType::real32 || e.type == DataType::real64) {
            e.low = read("lowlimit", "LowLimit");
            e.high = read("highlimit", "HighLimit");
        }
        e.fallback = read("defaultvalue", "DefaultValue");
        e.configured = read("parametervalue", "ParameterValue");
        const auto low = as_number(e.low.value), high = as_number(e.high.value), usual = as_number(e.fallback.value);
        const bool plain = !e.low.plus_node && !e.high.plus_node && !e.fallback.plus_node;
        if (low && high && plain && *low > *high) {
            note(s.line, fmt::format("LowLimit of {} is above its HighLimit: both are left out", to_text(address)));
            e.low = e.high = {};
        } else if (usual && plain && ((low && *usual < *low) || (high && *usual > *high))) {
            note(s.line, fmt::format("DefaultValue of {} is outside its limits", to_text(address)));
        }
    }

    /// An empty value means that there is none; it is not a fault, because many files leave keys empty.
    EdsValue value(const IniKey& k, DataType type, Address address, std::string_view what) {
        EdsValue v;
        if (k.value.empty() || type == DataType::domain) return v;
        const bool words = type == DataType::visible_string;
        if (!words && without_comment(k.value).empty()) return v;
        const auto rest = words ? std::nullopt : without_node(k.value);
        const std::string_view text = rest ? std::string_view(*rest) : std::string_view(k.value);
        const auto left_out = [&] {
            note(k.line, fmt::format("{} \"{}\" of {} is no {}: left out", what, shown_text(k.value), to_text(address), name_of(type)));
            return EdsValue{};
        };
        v.plus_node = rest.has_value();
        if (const auto range = range_of(type)) {
            const auto number = eds_number(text);
            const auto n = number ? eds_whole_of(type, *number) : std::nullopt;
            if (n && (!v.plus_node || (type != DataType::boolean && *n <= range->max - 127))) {
                v.value = type == DataType::boolean ? Value{*n != 0} : Value{*n};
                if (number->unusual) unusual(k.line, fmt::format("{} of {}", what, to_text(address)), k.value, fmt::format("{}", *n));
                return v;
            }
            // A bound at an end of the type that a Value cannot hold is ignored.
            if (type == DataType::unsigned64 && number && !number->negative && !v.plus_node) {
                note(k.line, fmt::format("{} of {} is above 2^63 - 1 and left out", what, to_text(address)));
                return {};
            }
            return left_out();
        }
        if (v.plus_node) {
            note(k.line, fmt::format("{} \"{}\" of {}: only whole numbers hang on the node number; left out", what, shown_text(k.value),
                                     to_text(address)));
            return {};
        }
        if (type == DataType::real32 || type == DataType::real64) {
            const auto bits = eds_number(text);
            const auto decimal = parse_number(without_comment(text));
            if (bits && bits->hex && !bits->negative) {
                std::vector<std::uint8_t> raw(*bytes_of(type));
                put_low_first(bits->size, raw);
                const auto read = decode(type, raw);
                if ((raw.size() == 8 || bits->size <= UINT32_MAX) && read && std::isfinite(as_number(*read).value_or(NAN))) {
                    v.value = *read;
                    return v;
                }
            } else if (decimal && encode(type, Value{*decimal})) {
                // The value as the drive holds it.
                v.value = *decode(type, *encode(type, Value{*decimal}));
                return v;
            }
            return left_out();
        }
        if (words) {
            v.value = k.value;
            return v;
        }
        std::string_view hex = without_comment(k.value);
        if (hex.starts_with("0x") || hex.starts_with("0X")) hex.remove_prefix(2);
        const auto bytes = from_hex(hex);
        if (bytes && decode(type, *bytes)) {
            v.value = to_hex(*bytes);
        } else {
            note(k.line, fmt::format("{} \"{}\" of {} is no row of hex pairs for {} and left out", what, shown_text(k.value),
                                     to_text(address), name_of(type)));
        }
        return v;
    }

    void check_subs() {
        for (auto it = eds_.objects.begin(); it != eds_.objects.end();) {
            auto& [index, object] = *it;
            const IniSection* s = ini_.find(fmt::format("{:04x}", index));
            std::size_t count = 0;
            for (auto e = eds_.entries.lower_bound({index, 0}); e != eds_.entries.end() && e->first.index == index; ++e)
                ++count;
            const bool listing = object.shape == EdsShape::array || object.shape == EdsShape::record;
            if (count == 0) {
                note(s ? s->line : 0, fmt::format("{:04X}h has no entry that can be read: left out", index));
                it = eds_.objects.erase(it);
                continue;
            }
            if (!listing && std::prev(eds_.entries.upper_bound({index, 0xFF}))->first.sub != 0) {
                note(s->line, fmt::format("{:04X}h is a variable with subindices: read as a record", index));
                object.shape = EdsShape::record;
            }
            const auto stated = s && listing ? whole_in(*s, "subnumber", 0xFF) : std::nullopt;
            if (stated && *stated != count && whole_in(*s, "compactsubobj", 254).value_or(0) == 0)
                note(s->line, fmt::format("{:04X}h tells {} subindices and has {}", index, *stated, count));
            ++it;
        }
    }

    void commissioning() {
        const IniSection* s = ini_.find("devicecomissioning");
        if (!s) s = ini_.find("devicecommissioning");
        if (!s) return;
        Commissioning c;
        const auto node = whole_in(*s, "nodeid", last_node);
        if (!node || *node == 0) note(s->line, "NodeID of [DeviceComissioning] is missing, or not 1 to 127: left out");
        c.node = static_cast<std::uint8_t>(node.value_or(0));
        c.node_name = text_in(*s, "nodename");
        c.kbit = static_cast<std::uint32_t>(whole_in(*s, "baudrate", 1000).value_or(0));
        eds_.commissioning = c;
    }

    const Ini& ini_;
    std::vector<FileFault>& faults_;
    std::vector<FileFault>& notes_;
    Eds eds_;
    std::map<std::uint16_t, std::size_t> listed_;
    bool full_ = false;
};

}  // namespace

std::optional<Eds> read_eds(std::string_view text, std::vector<FileFault>& faults, std::vector<FileFault>& notes) {
    const std::size_t before = faults.size();
    const auto ini = Ini::read(text, faults, notes);
    if (!ini) return std::nullopt;
    Eds eds = Reader(*ini, faults, notes).read();
    if (faults.size() != before) return std::nullopt;
    return eds;
}

}  // namespace axisgate::canopen
