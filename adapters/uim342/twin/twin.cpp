// Maker of the UIM342 twin: reads its setup.
// In: address, line kind, bit rate, options. Out: a drive without power.
// Never fails: what it cannot read becomes the factory's value.
#include "adapters/uim342/twin/twin.hpp"

#include <charconv>

#include "adapters/uim342/twin/device.hpp"

namespace axisgate::uim342 {
namespace {

constexpr std::uint8_t factory_node = 5;

std::optional<std::uint32_t> number(std::string_view text) {
    std::uint32_t n = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (fault != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return n;
}

std::array<std::uint8_t, 3> model_named(std::string_view name) {
    struct Model {
        std::string_view name;
        std::array<std::uint8_t, 3> ml;
    };
    constexpr std::array<Model, 6> models{{{"342XS", {0x20, 0x0A, 0x11}},
                                           {"342S", {0x21, 0x0A, 0x11}},
                                           {"342C02", {0x22, 0x14, 0x13}},
                                           {"342C04", {0x22, 0x28, 0x13}},
                                           {"342C08", {0x22, 0x50, 0x13}},
                                           {"342H08", {0x22, 0x50, 0x19}}}};
    for (const Model& m : models) {
        if (m.name == name) return m.ml;
    }
    return models[0].ml;
}

}  // namespace

std::unique_ptr<Twin> make_twin(const Catalogue&, const TwinSetup& setup) {
    twin::DeviceSetup d;
    d.kind = setup.kind;
    const std::string crc = option(setup.options, "crc", "auto");
    d.crc = twin::crc_range_named(crc).value_or(twin::CrcRange::automatic);
    if (d.crc == twin::CrcRange::thirteen) d.form = twin::Form::crc13;
    if (crc == "none") d.form = twin::Form::plain;
    const auto address = number(setup.address);
    const std::uint8_t node = address && *address >= 5 && *address <= 126 ? static_cast<std::uint8_t>(*address) : factory_node;
    d.factory.node = node;
    constexpr std::array<std::uint32_t, 5> rates{1'000'000, 800'000, 500'000, 250'000, 125'000};
    for (std::uint8_t i = 0; i < rates.size(); ++i) {
        if (setup.bit_rate != rates[i]) continue;
        d.factory.bit_rate = i;
        if (setup.kind == LineKind::can) d.bus_rate = i;
    }
    d.identity.model = model_named(option(setup.options, "model", "342XS"));
    // The manual's example for the factory address, and one more for each address: drives of one bus differ.
    d.identity.serial = 0x04030201u + node - factory_node;
    d.manners = twin::Manners(setup.freedoms, setup.seed);
    return std::make_unique<twin::Device>(d);
}

}  // namespace axisgate::uim342
