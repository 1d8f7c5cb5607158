// Router: finds the object that a request names (CIP volume 1, 5-1), and unpacks messages with several requests or with a route.
// Each request gets one answer. At most one Multiple_Service_Packet in one Unconnected_Send is unpacked.
#pragma once

#include <boost/container/small_vector.hpp>
#include <optional>
#include <vector>

#include "gateway/protocols/cip/objects.hpp"

namespace axisgate::cip {

class Router final : public Object {
public:
    static constexpr std::size_t most_parts = 64;  ///< requests in one Multiple_Service_Packet

    Router(const Connections& connections, DeviceListener& listener) : connections_(connections), listener_(listener) { add(*this); }
    /// The object outlives the router.
    void add(Object& object);
    /// Sets the object for classes that no other object has.
    void add_own(OwnObject& object) { own_ = &object; }

    struct Part {
        std::uint8_t service = 0;
        Response response;
    };
    /// One message with all its parts.
    struct Parts {
        std::uint8_t service = 0;  ///< service of the whole message
        bool multiple = false;
        boost::container::small_vector<Part, 1> parts;
        std::size_t pending = 0;  ///< parts whose value comes later
    };
    /// `context.token` is the token of the first part; it is incremented for each further part. 0: no value can come later.
    [[nodiscard]] Parts handle(View message, Context& context);
    /// Appends the answer, once no part is pending.
    static void put_answer(Bytes& to, const Parts& parts, std::size_t most);

    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::message_router; }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 4; }
    [[nodiscard]] std::span<const std::uint16_t> all(std::uint32_t instance) const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;

private:
    [[nodiscard]] Response route(const Request& request, const Path& path, Context& context);
    [[nodiscard]] Response one(View message, const std::optional<Request>& request, const std::optional<Path>& path, Context& context);
    void several(View data, Parts& into, Context& context);

    const Connections& connections_;
    DeviceListener& listener_;
    std::vector<Object*> objects_;  // sorted by class
    OwnObject* own_ = nullptr;
};

}  // namespace axisgate::cip
