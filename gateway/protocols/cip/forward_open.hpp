// Forward_Open: the request with which an originator opens a connection, decoded and checked by itself (CIP volume 1, 3-5.5.2).
// The result is the plan of a connection, or the extended status. Open connections are not known here.
#pragma once

#include <optional>

#include "gateway/protocols/cip/message.hpp"
#include "gateway/protocols/cip/values.hpp"

namespace axisgate::cip {

/// The three numbers by which both ends identify a connection, independent of its ids.
struct Triad {
    std::uint16_t serial = 0, vendor = 0;
    std::uint32_t originator = 0;
    bool operator==(const Triad&) const = default;
};

struct Half {
    enum class Type : std::uint8_t { null = 0, multicast = 1, point_to_point = 2, reserved = 3 };
    std::uint32_t id = 0;
    std::uint32_t rpi_us = 0;
    Type type = Type::null;
    std::uint8_t priority = 0;
    bool redundant_owner = false;
    bool variable = false;
    std::uint16_t size = 0;  ///< with sequence count and run/idle header
};
enum class Trigger : std::uint8_t { cyclic = 0, change_of_state = 1, application = 2 };

struct OpenRequest {
    Triad triad;
    std::uint8_t multiplier = 0;  ///< time-out = RPI << (2 + multiplier)
    Half ot, to;
    std::uint8_t transport = 0;
    Path path;

    [[nodiscard]] std::uint8_t transport_class() const noexcept { return transport & 0x0F; }
    [[nodiscard]] Trigger trigger() const noexcept { return static_cast<Trigger>((transport >> 4) & 7); }
    /// Class 3: the target answers. For implicit data this bit has no meaning.
    [[nodiscard]] bool is_server() const noexcept { return (transport & 0x80) != 0; }
    [[nodiscard]] bool is_null() const noexcept { return ot.type == Half::Type::null && to.type == Half::Type::null; }
    [[nodiscard]] Duration time_out() const noexcept { return std::chrono::microseconds(std::int64_t{ot.rpi_us} << (2 + multiplier)); }
};
/// Decodes a request; if it returns false, `refusal` has the reason. The triad of `out` is set as soon as it could be read.
[[nodiscard]] bool read_open(View data, bool large, OpenRequest& out, Response& refusal);

/// The end of every refusal: the triad, and where the path is wrong.
[[nodiscard]] Response refuse_open(const Triad& triad, Response why, std::size_t path_words_left = 0);

/// A connection that is silent for longer is closed, whatever time-out was requested: an unused connection takes a place from others.
/// Connections of messages end with their TCP session, and clients often request long time-outs for them.
inline constexpr std::uint32_t least_rpi_us = 1000, most_rpi_us = 10'000'000, most_message_rpi_us = 60'000'000;
inline constexpr Duration most_time_out = std::chrono::minutes(2), most_message_time_out = std::chrono::hours(1);

/// Checks the parts common to all connections: key, multiplier, transport, types, RPI and time-out.
[[nodiscard]] std::optional<Extended> wrong_by_itself(const OpenRequest& request, const Device& device);
[[nodiscard]] std::optional<Extended> wrong_key(const ElectronicKey& key, const Device& device);
/// Whether both name the same objects; route, key and configuration data of the paths are ignored.
[[nodiscard]] bool same_places(const Path& a, const Path& b);
/// Whether the path names only the message router: such a Forward_Close identifies the connection by its triad.
[[nodiscard]] bool names_router(const Path& path);
/// The status for a route to another device; nothing if the route ends here.
[[nodiscard]] std::optional<Extended> wrong_route(const Path& path);

/// The assemblies at both ends of an implicit connection.
struct IoPlan {
    AssemblyInfo::Role role = AssemblyInfo::Role::output;  ///< role of the consumed assembly
    std::uint32_t consumed = 0, produced = 0;              ///< 0: none
    std::uint16_t consumed_size = 0, produced_size = 0;    ///< without header and sequence count
    bool header = false;                                   ///< run/idle header before the consumed data
};
/// Plans the connection, or returns a refusal with one word or two: the second is the right size.
[[nodiscard]] std::optional<Response> plan_io(const OpenRequest& request, const Values& values, IoPlan& plan);

}  // namespace axisgate::cip
