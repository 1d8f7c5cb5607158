// The table of CANopen data types, and the conversion of values with it. Bytes of the wrong length give no value.
#include "gateway/protocols/canopen/data_type.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "gateway/core/text.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen {
namespace {
enum class Kind : std::uint8_t { boolean, signed_whole, unsigned_whole, real, text, bytes };
struct Row {
    DataType type;
    Kind kind;
    std::uint8_t bytes;  ///< 0: any length
    std::string_view name;
};
constexpr std::array table{
    Row{DataType::boolean, Kind::boolean, 1, "BOOLEAN"},
    Row{DataType::integer8, Kind::signed_whole, 1, "INTEGER8"},
    Row{DataType::integer16, Kind::signed_whole, 2, "INTEGER16"},
    Row{DataType::integer32, Kind::signed_whole, 4, "INTEGER32"},
    Row{DataType::unsigned8, Kind::unsigned_whole, 1, "UNSIGNED8"},
    Row{DataType::unsigned16, Kind::unsigned_whole, 2, "UNSIGNED16"},
    Row{DataType::unsigned32, Kind::unsigned_whole, 4, "UNSIGNED32"},
    Row{DataType::real32, Kind::real, 4, "REAL32"},
    Row{DataType::visible_string, Kind::text, 0, "VISIBLE_STRING"},
    Row{DataType::octet_string, Kind::bytes, 0, "OCTET_STRING"},
    Row{DataType::unicode_string, Kind::bytes, 0, "UNICODE_STRING"},
    Row{DataType::time_of_day, Kind::bytes, 6, "TIME_OF_DAY"},
    Row{DataType::time_difference, Kind::bytes, 6, "TIME_DIFFERENCE"},
    Row{DataType::domain, Kind::bytes, 0, "DOMAIN"},
    Row{DataType::integer24, Kind::signed_whole, 3, "INTEGER24"},
    Row{DataType::real64, Kind::real, 8, "REAL64"},
    Row{DataType::integer40, Kind::signed_whole, 5, "INTEGER40"},
    Row{DataType::integer48, Kind::signed_whole, 6, "INTEGER48"},
    Row{DataType::integer56, Kind::signed_whole, 7, "INTEGER56"},
    Row{DataType::integer64, Kind::signed_whole, 8, "INTEGER64"},
    Row{DataType::unsigned24, Kind::unsigned_whole, 3, "UNSIGNED24"},
    Row{DataType::unsigned40, Kind::unsigned_whole, 5, "UNSIGNED40"},
    Row{DataType::unsigned48, Kind::unsigned_whole, 6, "UNSIGNED48"},
    Row{DataType::unsigned56, Kind::unsigned_whole, 7, "UNSIGNED56"},
    Row{DataType::unsigned64, Kind::unsigned_whole, 8, "UNSIGNED64"},
};
constexpr auto rows = [] {  // indexed by type number, because it is looked up for each value of a PDO
    std::array<const Row*, 0x1C> list{};
    for (const Row& r : table)
        list[static_cast<std::size_t>(r.type)] = &r;
    return list;
}();
const Row* row(DataType type) noexcept {
    const auto number = static_cast<std::size_t>(type);
    return number < rows.size() ? rows[number] : nullptr;
}
}  // namespace

std::optional<DataType> data_type_of(std::uint64_t number) noexcept {
    for (const Row& r : table) {
        if (static_cast<std::uint64_t>(r.type) == number) return r.type;
    }
    return std::nullopt;
}
std::string_view name_of(DataType type) noexcept {
    const Row* r = row(type);
    return r ? r->name : std::string_view("unknown type");
}
std::optional<std::size_t> bytes_of(DataType type) noexcept {
    const Row* r = row(type);
    if (!r || r->bytes == 0) return std::nullopt;
    return r->bytes;
}
std::optional<std::size_t> bits_of(DataType type) noexcept {
    if (type == DataType::boolean) return 1;
    const auto n = bytes_of(type);
    return n ? std::optional<std::size_t>(*n * 8) : std::nullopt;
}
bool is_signed(DataType type) noexcept {
    const Row* r = row(type);
    return r && r->kind == Kind::signed_whole;
}
std::optional<IntegerRange> range_of(DataType type) noexcept {
    const Row* r = row(type);
    if (!r) return std::nullopt;
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    switch (r->kind) {
        case Kind::boolean:
            return IntegerRange{0, 1};
        case Kind::signed_whole: {
            const std::int64_t high = r->bytes == 8 ? most : (std::int64_t{1} << (r->bytes * 8 - 1)) - 1;
            return IntegerRange{-high - 1, high};
        }
        case Kind::unsigned_whole:
            return IntegerRange{0, r->bytes == 8 ? most : (std::int64_t{1} << (r->bytes * 8)) - 1};
        default:
            return std::nullopt;
    }
}

std::optional<Value> decode(DataType type, std::span<const std::uint8_t> bytes) {
    const Row* r = row(type);
    if (!r || (r->bytes != 0 && bytes.size() != r->bytes)) return std::nullopt;
    const std::uint64_t raw = low_first(bytes);
    switch (r->kind) {
        case Kind::boolean:
            return Value{raw != 0};
        case Kind::signed_whole: {
            const int shift = 64 - r->bytes * 8;
            return Value{static_cast<std::int64_t>(raw << shift) >> shift};
        }
        case Kind::unsigned_whole:
            if (raw > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return std::nullopt;
            return Value{static_cast<std::int64_t>(raw)};
        case Kind::real:
            return r->bytes == 4 ? Value{static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)))}
                                 : Value{std::bit_cast<double>(raw)};
        case Kind::text: {
            const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
            return Value{std::string(bytes.begin(), end)};
        }
        case Kind::bytes:
            return Value{to_hex(bytes)};
    }
    return std::nullopt;
}

std::optional<std::vector<std::uint8_t>> encode(DataType type, const Value& value) {
    const Row* r = row(type);
    if (!r) return std::nullopt;
    std::vector<std::uint8_t> out(r->bytes);
    switch (r->kind) {
        case Kind::boolean:
        case Kind::signed_whole:
        case Kind::unsigned_whole: {
            const auto n = as_integer(value);
            const auto range = range_of(type);
            if (!n || *n < range->min || *n > range->max) return std::nullopt;
            put_low_first(static_cast<std::uint64_t>(*n), out);
            return out;
        }
        case Kind::real: {
            const auto n = as_number(value);
            if (!n) return std::nullopt;
            if (r->bytes == 8) {
                put_low_first(std::bit_cast<std::uint64_t>(*n), out);
            } else {
                if (std::isfinite(*n) && std::abs(*n) > static_cast<double>(std::numeric_limits<float>::max())) return std::nullopt;
                put_low_first(std::bit_cast<std::uint32_t>(static_cast<float>(*n)), out);
            }
            return out;
        }
        case Kind::text: {
            const auto* text = std::get_if<std::string>(&value);
            if (!text || text->find('\0') != std::string::npos) return std::nullopt;
            return std::vector<std::uint8_t>(text->begin(), text->end());
        }
        case Kind::bytes: {
            const auto* text = std::get_if<std::string>(&value);
            auto hex = text ? from_hex(*text) : std::nullopt;
            if (!hex || (r->bytes != 0 && hex->size() != r->bytes)) return std::nullopt;
            return hex;
        }
    }
    return std::nullopt;
}

}  // namespace axisgate::canopen
