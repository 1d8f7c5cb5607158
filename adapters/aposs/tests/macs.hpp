// The family's catalogue (schema/families/aposs.json) and a simulated controller at node 5.
#pragma once

#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "adapters/aposs/twin/twin.hpp"

namespace axisgate::aposs::test {

inline const Catalogue& page() {
    static const Catalogue c = [] {
        std::vector<std::string> faults;
        std::ifstream in(AXISGATE_SOURCE_DIR "/schema/families/aposs.json");
        std::stringstream text;
        text << in.rdbuf();
        auto read = Catalogue::parse(text.str(), faults);
        if (!read) std::abort();
        return std::move(*read);
    }();
    return c;
}

inline std::unique_ptr<Twin> macs() {
    TwinSetup setup;
    setup.address = "5";
    setup.axes = 2;
    setup.kind = LineKind::can;
    return make_twin(page(), setup);
}

}  // namespace axisgate::aposs::test
