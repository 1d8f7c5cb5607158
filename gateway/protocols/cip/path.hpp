// Path: the EPATH with which requests and connections address objects (CIP volume 1, appendix C).
// A padded path of at most 255 words is decoded into its segments, or the position of its fault is returned.
#pragma once

#include <boost/container/small_vector.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/protocols/cip/bytes.hpp"

namespace axisgate::cip {

struct ElectronicKey {
    std::uint16_t vendor = 0, device_type = 0, product_code = 0;  ///< 0: any
    std::uint8_t major = 0;                                       ///< 0: any
    bool compatible = false;                                      ///< a compatible revision is accepted, too
    std::uint8_t minor = 0;                                       ///< 0: any
};
struct Port {
    std::uint16_t number = 0;
    Bytes link;
};
/// One object that a path names: an instance, or a connection point.
struct Place {
    std::uint32_t class_id = 0;
    std::uint32_t instance = 0;
    bool connection_point = false;
};

struct Path {
    std::optional<ElectronicKey> key;
    std::vector<Port> ports;                ///< the route, before the first logical segment
    std::optional<std::uint32_t> class_id;  ///< the last one
    /// Each instance and connection point, with the class before it: one in a request, three in a connection; more are accepted, too.
    boost::container::small_vector<Place, 3> places;
    std::optional<std::uint32_t> attribute;   ///< the last one of the path
    std::optional<std::uint32_t> member;      ///< the last one of the path
    std::vector<std::string> symbols;         ///< symbolic names; this device has none
    std::optional<std::uint32_t> inhibit_ms;  ///< production inhibit time
    std::optional<Bytes> data;                ///< data of simple data segments: a configuration

    [[nodiscard]] std::optional<std::uint32_t> instance() const noexcept {
        return places.empty() ? std::nullopt : std::optional(places.back().instance);
    }
};

/// `wrong_at` is the index of the first word that cannot be read.
[[nodiscard]] std::optional<Path> read_path(View bytes, std::size_t& wrong_at);
[[nodiscard]] inline std::optional<Path> read_path(View bytes) {
    std::size_t ignored = 0;
    return read_path(bytes, ignored);
}
/// Logical segments in the shortest padded form.
void put_class(Bytes& to, std::uint32_t class_id);
void put_instance(Bytes& to, std::uint32_t instance);
void put_attribute(Bytes& to, std::uint32_t attribute);

}  // namespace axisgate::cip
