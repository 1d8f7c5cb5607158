// Maker of the MCode twin: reads its setup: product, frame size, network or serial link.
// In: address, bit rate, options. Out: a drive without power.
// Never fails: what it cannot read becomes the factory's value.
#include "adapters/mcode/twin/twin.hpp"

#include "adapters/mcode/twin/device.hpp"
#include "adapters/mcode/twin/switched.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::mcode {

std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup) {
    twin::DeviceSetup d;
    for (const ErrorCode& e : catalogue.errors())
        d.codes.push_back(e.code);
    twin::MechanismSetup m;
    const std::string product = option(setup.options, "product", "LMDC");
    d.product = product == "LMM" ? twin::lmm : product == "LMDO" ? twin::lmdo : twin::lmdc;
    d.ethernet = switched_on(option(setup.options, "ethernet", "off"));
    d.bit_rate = setup.bit_rate;
    d.manners = twin::manners_of(setup.freedoms);
    d.pad = switched_on(option(setup.options, "pad", "off"));
    d.base_two = option(setup.options, "log_base", "e") == "2";
    if (setup.address.size() == 1) d.name = setup.address[0];
    const std::string nema = option(setup.options, "nema", "23");
    m.product = d.product;
    m.manners = twin::motor_manners_of(setup.freedoms, setup.seed);
    m.frame_size = nema == "17" ? 17 : nema == "34" ? 34 : 23;
    const std::string size = m.frame_size == 17 ? "421" : m.frame_size == 34 ? "851" : "571";
    d.part_number =
        d.product == twin::lmm ? "LMM-15-M" : (d.product == twin::lmdo ? "LMDO" : "LMDC") + std::string(d.ethernet ? "E" : "M") + size;
    // One number per name, so that the drives of a line differ.
    const std::string number = std::to_string(static_cast<unsigned char>(d.name));
    d.serial_number = std::string(10 - number.size(), '0') + number;
    return std::make_unique<twin::Device>(d, twin::make_mechanism(m));
}

}  // namespace axisgate::mcode
