// EDS reader: turns sections into objects and entries, and reports all faults of a file at once. A file with faults gives no description.
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/protocols/canopen/eds.hpp"

namespace axisgate::canopen {
namespace {

/// A number as in C: decimal, 0x hex or 0 octal, each with an optional sign. Only a comment may follow it.
struct Number {
    bool negative = false;
    std::uint64_t size = 0;
    bool hex = false;
};
std::optional<Number> number_of(std::string_view text) {
    text = trimmed(text.substr(0, text.find(';')));
    Number n;
    if (text.starts_with('-') || text.starts_with('+')) {
        n.negative = text[0] == '-';
        text.remove_prefix(1);
    }
    int base = 10;
    if (text.starts_with("0x") || text.starts_with("0X")) {
        base = 16;
        text.remove_prefix(2);
    } else if (text.size() > 1 && text[0] == '0') {
        base = 8;
        text.remove_prefix(1);
    }
    n.hex = base == 16;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n.size, base);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return n;
}
std::optional<std::uint64_t> whole(std::string_view text, std::uint64_t most) {
    const auto n = number_of(text);
    if (!n || n->negative || n->size > most) return std::nullopt;
    return n->size;
}

/// A whole number of the type. Hex digits may be the bit pattern of a negative number: 0xFFFF is -1 for an INTEGER16.
std::optional<std::int64_t> whole_of(DataType type, std::string_view text) {
    const auto n = number_of(text);
    const auto range = range_of(type);
    if (!n || !range) return std::nullopt;
    const auto bits = *bits_of(type);
    if (n->hex && !n->negative && is_signed(type) && n->size > static_cast<std::uint64_t>(range->max)) {
        if (bits < 64 && n->size >> bits != 0) return std::nullopt;
        const auto shift = 64 - bits;
        return static_cast<std::int64_t>(n->size << shift) >> shift;
    }
    const std::uint64_t most = n->negative ? ~static_cast<std::uint64_t>(range->min) + 1 : static_cast<std::uint64_t>(range->max);
    if (n->size > most) return std::nullopt;
    return n->negative ? static_cast<std::int64_t>(~n->size + 1) : static_cast<std::int64_t>(n->size);
}

/// "$NODEID+0x180", "0x180 + $nodeid", "$NODEID".
std::optional<std::string> without_node(std::string_view text) {
    std::string t = lower(text);
    const auto at = t.find("$nodeid");
    if (at == std::string::npos) return std::nullopt;
    t.erase(at, 7);
    const auto plus = t.find('+');
    if (plus != std::string::npos) t.erase(plus, 1);
    return std::string(trimmed(t).empty() ? "0" : trimmed(t));
}

class Reader {
public:
    Reader(const Ini& ini, std::vector<FileFault>& faults, std::vector<FileFault>& notes) : ini_(ini), faults_(faults), notes_(notes) {}

    Eds read() {
        device();
        lists();
        for (const IniSection& s : ini_.sections())
            section(s);
        for (const auto& [index, line] : listed_) {
            if (!eds_.objects.contains(index)) fault(line, fmt::format("the object {:04X}h is listed and has no section", index));
        }
        if (eds_.objects.empty()) fault(0, "no object is described: this is no EDS");
        check_subs();
        commissioning();
        return std::move(eds_);
    }

private:
    void fault(std::size_t line, std::string text) { add_fault(faults_, line, std::move(text)); }
    void note(std::size_t line, std::string text) { add_fault(notes_, line, std::move(text)); }

    /// The number of a key that may be missing or empty.
    std::optional<std::uint64_t> whole_in(const IniSection& s, std::string_view key, std::uint64_t most) {
        const IniKey* k = s.find(key);
        if (!k || k->value.empty()) return std::nullopt;
        const auto n = whole(k->value, most);
        if (!n)
            fault(k->line,
                  fmt::format("{} of [{}] is \"{}\", and must be a whole number up to {}", key, s.name, shown_text(k->value), most));
        return n;
    }
    static std::string text_in(const IniSection& s, std::string_view key) {
        const IniKey* k = s.find(key);
        return k ? k->value : std::string();
    }

    void device() {
        const IniSection* s = ini_.find("deviceinfo");
        if (!s) return fault(0, "the section [DeviceInfo] is missing: this is no EDS or DCF");
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
                const auto index = whole(k.value, 0xFFFF);
                ++count;
                if (!index) {
                    fault(k.line, fmt::format("\"{}\" is no index of an object", shown_text(k.value)));
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
                return fault(s.line, fmt::format("\"{}\" is no subindex: two hex digits are the most", shown_text(number)));
            const IniSection* object = ini_.find(s.name.substr(0, 4));
            if (!object) return fault(s.line, fmt::format("[{}] has no object [{}]", s.name, s.name.substr(0, 4)));
            const auto shape = whole(text_in(*object, "objecttype"), 0xFF).value_or(7);
            if (is_definition(shape)) return;
            if (shape == 2 || shape == 7)
                return fault(s.line, fmt::format("[{}]: {:04X}h is a variable and has no subindices", s.name, index));
            entry(s, {index, static_cast<std::uint8_t>(sub)});
        }
    }

    /// Whether the object is the definition of a type, which cannot be read from a device.
    static bool is_definition(std::uint64_t shape) { return shape == 5 || shape == 6; }

    void object(const IniSection& s, std::uint16_t index) {
        const auto shape = whole_in(s, "objecttype", 0xFF).value_or(7);
        if (!listed_.contains(index)) note(s.line, fmt::format("the object {:04X}h stands in no list of objects", index));
        if (is_definition(shape)) return;
        if (shape != 2 && shape != 7 && shape != 8 && shape != 9)
            return fault(s.line, fmt::format("ObjectType {} of {:04X}h is none: 2 domain, 7 variable, 8 array, 9 record", shape, index));
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
        if (!fresh) fault(line, fmt::format("{} is described twice", to_text(at->first)));
        return true;
    }

    void entry(const IniSection& s, Address address) {
        if (auto e = described(s, address)) put(address, std::move(*e), s.line);
    }

    std::optional<EdsEntry> described(const IniSection& s, Address address) {
        const std::size_t before = faults_.size();
        EdsEntry e;
        e.line = s.line;
        e.name = text_in(s, "parametername");
        const bool domain = whole(text_in(s, "objecttype"), 0xFF) == 2u;
        const IniKey* type = s.find("datatype");
        const auto number = type ? whole(type->value, 0xFFFF) : std::nullopt;
        const auto known_type = number ? data_type_of(*number) : std::nullopt;
        if (known_type) {
            e.type = *known_type;
        } else if (domain) {
            e.type = DataType::domain;
        } else if (!type || type->value.empty()) {
            fault(s.line, fmt::format("{} has no DataType", to_text(address)));
        } else {
            fault(type->line,
                  fmt::format("DataType \"{}\" of {} is none of CiA 301's simple types", shown_text(type->value), to_text(address)));
        }
        const IniKey* access = s.find("accesstype");
        if (access && !access->value.empty()) {
            const auto known_access = entry_access_named(lower(access->value));
            if (known_access) {
                e.access = *known_access;
            } else {
                fault(access->line, fmt::format("AccessType \"{}\" of {} is none: ro, wo, rw, rwr, rww or const", shown_text(access->value),
                                                to_text(address)));
            }
        } else if (!domain) {
            fault(s.line, fmt::format("{} has no AccessType", to_text(address)));
        }
        e.mappable = whole_in(s, "pdomapping", 1) == 1u;
        e.flags = static_cast<std::uint32_t>(whole_in(s, "objflags", UINT32_MAX).value_or(0));
        if (faults_.size() != before) return std::nullopt;
        limits(s, address, e);
        return faults_.size() == before ? std::optional(std::move(e)) : std::nullopt;
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
            fault(s.line, fmt::format("LowLimit of {} is above its HighLimit", to_text(address)));
        } else if (usual && plain && ((low && *usual < *low) || (high && *usual > *high))) {
            note(s.line, fmt::format("DefaultValue of {} is outside its limits", to_text(address)));
        }
    }

    /// An empty value means that there is none; it is not a fault, because many files leave keys empty.
    EdsValue value(const IniKey& k, DataType type, Address address, std::string_view what) {
        EdsValue v;
        if (k.value.empty() || type == DataType::domain) return v;
        const auto rest = without_node(k.value);
        const std::string_view text = rest ? std::string_view(*rest) : std::string_view(k.value);
        v.plus_node = rest.has_value();
        if (const auto range = range_of(type)) {
            if (const auto n = whole_of(type, text); n && (!v.plus_node || *n <= range->max - 127)) {
                v.value = type == DataType::boolean ? Value{*n != 0} : Value{*n};
                if (!v.plus_node || type != DataType::boolean) return v;
            }
            // A bound at an end of the type that a Value cannot hold is ignored.
            const auto large = number_of(text);
            if (type == DataType::unsigned64 && large && !large->negative && !v.plus_node) {
                note(k.line, fmt::format("{} of {} is above 2^63 - 1 and left out", what, to_text(address)));
                return {};
            }
            fault(k.line, fmt::format("{} \"{}\" of {} is no {}", what, shown_text(k.value), to_text(address), name_of(type)));
            return {};
        }
        if (v.plus_node) {
            fault(k.line,
                  fmt::format("{} \"{}\" of {}: only whole numbers hang on the node number", what, shown_text(k.value), to_text(address)));
            return {};
        }
        if (type == DataType::real32 || type == DataType::real64) {
            const auto bits = number_of(text);
            const auto decimal = parse_number(text);
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
            fault(k.line, fmt::format("{} \"{}\" of {} is no {}", what, shown_text(k.value), to_text(address), name_of(type)));
            return {};
        }
        if (type == DataType::visible_string) {
            v.value = k.value;
            return v;
        }
        std::string_view hex = k.value;
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
        for (const auto& [index, object] : eds_.objects) {
            if (object.shape != EdsShape::array && object.shape != EdsShape::record) continue;
            const IniSection* s = ini_.find(fmt::format("{:04x}", index));
            auto it = eds_.entries.lower_bound({index, 0});
            std::size_t count = 0;
            for (; it != eds_.entries.end() && it->first.index == index; ++it)
                ++count;
            if (count == 0 && faults_.empty()) fault(s->line, fmt::format("{:04X}h is an array or a record without subindices", index));
            const auto stated = whole_in(*s, "subnumber", 0xFF);
            if (stated && count != 0 && *stated != count && faults_.empty() && whole_in(*s, "compactsubobj", 254).value_or(0) == 0)
                note(s->line, fmt::format("{:04X}h tells {} subindices and has {}", index, *stated, count));
        }
    }

    void commissioning() {
        const IniSection* s = ini_.find("devicecomissioning");
        if (!s) s = ini_.find("devicecommissioning");
        if (!s) return;
        Commissioning c;
        const auto node = whole_in(*s, "nodeid", last_node);
        if (!node || *node == 0) return fault(s->line, "NodeID of [DeviceComissioning] must be 1 to 127");
        c.node = static_cast<std::uint8_t>(*node);
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
    const auto ini = Ini::read(text, faults);
    if (!ini) return std::nullopt;
    Eds eds = Reader(*ini, faults, notes).read();
    if (faults.size() != before) return std::nullopt;
    return eds;
}

}  // namespace axisgate::canopen
