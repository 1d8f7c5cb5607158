// The family's catalogue (schema/families/aposs.json) and a simulated controller at node 5.
#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "adapters/aposs/twin/twin.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/wire/specimen_twin.hpp"

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

/// With these options, among them freedoms by their names.
inline std::unique_ptr<Twin> macs(std::map<std::string, std::string> options = {}) {
    TwinSetup setup;
    setup.address = "5";
    setup.axes = 2;
    setup.kind = LineKind::can;
    setup.options = std::move(options);
    setup.freedoms = freedoms_of(page(), setup.options);
    setup.seed = 1;
    return with_common_freedoms(make_twin(page(), setup), setup);
}

}  // namespace axisgate::aposs::test
