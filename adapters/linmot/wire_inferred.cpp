#include "adapters/linmot/wire_inferred.hpp"

#include "adapters/linmot/wire.hpp"

namespace axisgate::linmot {

bool inferred(std::uint8_t main, std::uint8_t sub) noexcept {
    switch (static_cast<Main>(main)) {
        case Main::response:
            return sub != 1;
        case Main::ram:
            return sub != 0;
        case Main::curves:
            return sub != 0x00 && sub != 0x0A;
        case Main::parameters:
            return sub == 0x02 || (sub >= 0x07 && sub != 0x0A && sub != 0x0B);
        case Main::program:
            return sub < 2 || sub > 4;
        case Main::errors:
            return sub == 0 || sub > 2;
        case Main::table:
            return sub >= 0x03 && sub != 0x07;
        default:
            return false;
    }
}

bool inferred(const Catalogue& catalogue, std::string_view command) {
    for (const auto& v : catalogue.document().at("commands").get_array()) {
        const auto& o = v.get_object();
        if (o.at("id").as_string() == command) return o.contains("inferred") && o.at("inferred").as_bool();
    }
    return false;
}

}  // namespace axisgate::linmot
