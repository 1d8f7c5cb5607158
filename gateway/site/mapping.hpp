// Mapping: one entry of a site's own register maps: the point of an axis, its address, and its form in the registers.
// The JSON objects of `mappings` are read and checked; all faults are reported at once, each with a remedy, also conflicts between entries.
// The doors read and write the values.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/core/ids.hpp"
#include "gateway/core/value.hpp"
#include "gateway/site/axis_points.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

enum class MapTable : std::uint8_t { coils, discrete_inputs, holding_registers, input_registers };
enum class MapType : std::uint8_t { boolean, u16, i16, u32, i32, f32, u64, i64, f64, string };
enum class MapAccess : std::uint8_t { read, write, read_write };
enum class MapWordOrder : std::uint8_t { high_first, low_first };
/// The content of registers for a value that does not fit their type. mark: a reserved number (see encode). clamp: the nearest end of
/// the type.
enum class MapOverflow : std::uint8_t { mark, clamp };

[[nodiscard]] std::string_view name_of(MapTable table) noexcept;
[[nodiscard]] std::string_view name_of(MapType type) noexcept;
[[nodiscard]] std::string_view name_of(MapAccess access) noexcept;
[[nodiscard]] std::string_view name_of(MapWordOrder order) noexcept;
[[nodiscard]] std::string_view name_of(MapOverflow overflow) noexcept;

/// Register value = point value * scale + offset; written back: point value = (register value - offset) / scale.
struct Mapping {
    std::string id;         ///< 1..64 letters, digits, - _ . ; unique
    std::uint8_t unit = 2;  ///< 2..254
    MapTable table = MapTable::holding_registers;
    std::uint16_t address = 0;  ///< 0-based
    std::string axis;           ///< name of the site's axis
    std::string point;          ///< as written: the name of an AxisPoint, or the id or name of a parameter, also with its element ("N[17]")
    std::variant<AxisPoint, Point> what;
    MapType type = MapType::i32;
    MapWordOrder word_order = MapWordOrder::high_first;
    double scale = 1;   ///< finite, not 0
    double offset = 0;  ///< finite
    MapAccess access = MapAccess::read;
    std::uint16_t length = 16;  ///< type string: registers, 1..64; two characters each
    MapOverflow on_overflow = MapOverflow::mark;
    std::string comment;  ///< comment for the user, up to 256 bytes

    /// The number of registers, or of bits, that it occupies.
    [[nodiscard]] std::uint16_t size() const noexcept;
    [[nodiscard]] std::uint32_t end() const noexcept { return std::uint32_t{address} + size(); }
};
inline constexpr std::size_t most_mappings = 4096;

/// Reads all entries against the site's axes and their catalogues; conflicts are faults of the later entry and name the other one. Entries
/// without an id get one ("m" and a number). Nothing is returned if there is a fault. `called` returns the name of the entry with this
/// index for messages about a conflict, such as "row 3"; if it is not set or returns nothing, the id is used.
[[nodiscard]] std::optional<std::vector<Mapping>> parse_mappings(const boost::json::array& entries, const Site& site,
                                                                 const Families& families, std::vector<SiteFault>& faults,
                                                                 const std::function<std::string(std::size_t index)>& called = {});
/// The entry in its full form, which parse_mappings reads back unchanged.
[[nodiscard]] boost::json::object to_json(const Mapping& mapping);
/// The list in the form of a site's document.
[[nodiscard]] boost::json::array to_json(std::span<const Mapping> mappings);

/// The whole list as CSV with a header line, and back, as rows_from_csv says.
[[nodiscard]] std::string mappings_to_csv(std::span<const Mapping> mappings);
[[nodiscard]] std::optional<boost::json::array> mappings_from_csv(std::string_view csv, std::vector<std::size_t>& lines,
                                                                  std::vector<CsvFault>& faults);

/// The registers of a mapping (2 * size() bytes, big-endian) that show `value`; whole numbers without scale and offset are exact at every
/// width. False: the value is unknown, is not a number where one is needed, or does not fit the type. `out` then has a substitute: with
/// MapOverflow::clamp the nearest end of the type; otherwise, or if neither end is nearer, 0x8000... for signed numbers, 0xFFFF... for
/// unsigned ones, a NaN for floating-point ones, 0 for bool and an empty text.
bool encode(const Mapping& mapping, const Value& value, std::uint8_t* out) noexcept;
/// The value in the registers of a mapping; whole numbers stay whole. Unknown for a floating-point register that is not a number.
[[nodiscard]] Value decode(const Mapping& mapping, const std::uint8_t* in);

}  // namespace axisgate
