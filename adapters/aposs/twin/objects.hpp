// Objects of a simulated MACS: the dictionary of its node, made of the catalogue's rows and of a CiA 402 application for two axes.
// In: the catalogue, the node number. Out: entries; which row of the catalogue an object is. Never does anything.
// Where a parameter stands in the dictionary, the manual does not print (E-01): the rows say how sure each address is.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/protocols/canopen/dictionary.hpp"

namespace axisgate::aposs {
using canopen::Address;

inline constexpr int axes = 2;
inline constexpr std::uint16_t per_axis = 0x800;

enum class Scope : std::uint8_t { axis, global };
/// One parameter of one axis, or of the controller.
struct Key {
    Scope scope = Scope::axis;
    int axis = 0;  ///< from 0; of a global one 0
    int number = 0;
    auto operator<=>(const Key&) const = default;
};
struct Row {
    Address address;
    Key key;
    std::string id;
    std::string storage;  ///< "parameter", "computed", "state"
    std::int64_t initial = 0;
    std::vector<std::int64_t> allowed;  ///< the only values; empty: the bounds decide
};

class Objects {
public:
    Objects(const Catalogue& catalogue, std::uint8_t node);
    Objects(const Objects&) = delete;
    Objects& operator=(const Objects&) = delete;
    [[nodiscard]] const canopen::Dictionary& factory() const noexcept { return factory_; }
    [[nodiscard]] const Row* at(Address address) const;
    [[nodiscard]] const Row* of(const Key& key) const;
    /// By its name: VELMAX of axis 0, CANBAUD of the controller.
    [[nodiscard]] const Row* named(std::string_view id, int axis) const;
    [[nodiscard]] const std::map<Key, Row>& rows() const noexcept { return rows_; }

private:
    canopen::Dictionary factory_;
    std::map<Key, Row> rows_;  ///< their places stay: the two below point at them
    std::map<Address, const Row*> places_;
    struct Hash {
        using is_transparent = void;
        [[nodiscard]] std::size_t operator()(std::string_view id) const noexcept { return std::hash<std::string_view>{}(id); }
    };
    std::array<std::unordered_map<std::string, const Row*, Hash, std::equal_to<>>, axes> names_;
};

}  // namespace axisgate::aposs
