// Forward_Open: the request by which an originator opens a connection, taken apart and looked at for what it says by itself
// (CIP volume 1, 3-5.5.2). In: its bytes. Out: a plan of a connection, or the extended status. Never knows which connections there are.
#pragma once

#include <optional>

#include "gateway/protocols/cip/message.hpp"
#include "gateway/protocols/cip/values.hpp"

namespace axisgate::cip {

/// By which the two ends know a connection, whatever ids it has.
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
    /// Of class 3: the target answers. For implicit data this bit means nothing.
    [[nodiscard]] bool is_server() const noexcept { return (transport & 0x80) != 0; }
    [[nodiscard]] bool is_null() const noexcept { return ot.type == Half::Type::null && to.type == Half::Type::null; }
    [[nodiscard]] Duration time_out() const noexcept { return std::chrono::microseconds(std::int64_t{ot.rpi_us} << (2 + multiplier)); }
};
/// Null: `refusal` says why. The triad of `out` is there as soon as it was in the bytes.
[[nodiscard]] bool read_open(View data, bool large, OpenRequest& out, Response& refusal);

/// The end of every refusal: whom it concerns, and where the path went wrong.
[[nodiscard]] Response refuse_open(const Triad& triad, Response why, std::size_t path_words_left = 0);

/// Whoever is silent for longer is gone, whatever he has asked for: a connection that nobody uses takes a place from others. Connections
/// of messages end with their TCP session, and clients ask for long time-outs of them without a thought.
inline constexpr std::uint32_t least_rpi_us = 1000, most_rpi_us = 10'000'000, most_message_rpi_us = 60'000'000;
inline constexpr Duration most_time_out = std::chrono::minutes(2), most_message_time_out = std::chrono::hours(1);

/// What may stand in any connection: key, multiplier, transport, types, RPI and time-out.
[[nodiscard]] std::optional<Extended> wrong_by_itself(const OpenRequest& request, const Device& device);
[[nodiscard]] std::optional<Extended> wrong_key(const ElectronicKey& key, const Device& device);
/// They name the same objects; route, key and configuration data of a path say nothing about that.
[[nodiscard]] bool same_places(const Path& a, const Path& b);
/// Nothing but the message router: who closes so goes by the three numbers of the connection.
[[nodiscard]] bool names_router(const Path& path);
/// A route to somebody else.
[[nodiscard]] std::optional<Extended> wrong_route(const Path& path);

/// Who shall be at the two ends of an implicit connection.
struct IoPlan {
    AssemblyInfo::Role role = AssemblyInfo::Role::output;  ///< of what is consumed
    std::uint32_t consumed = 0, produced = 0;              ///< 0: nothing is
    std::uint16_t consumed_size = 0, produced_size = 0;    ///< data alone
    bool header = false;                                   ///< run/idle in front of what is consumed
};
/// Refused with one word or two: the second is the right size.
[[nodiscard]] std::optional<Response> plan_io(const OpenRequest& request, const Values& values, IoPlan& plan);

}  // namespace axisgate::cip
