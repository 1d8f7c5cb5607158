// The family's catalogue (schema/families/linmot.json), read once. A fault in it ends the test.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "gateway/core/catalogue.hpp"

namespace axisgate::linmot::test {

inline const Catalogue& page() {
    static const Catalogue all = [] {
        std::ifstream in(std::string(AXISGATE_SOURCE_DIR) + "/schema/families/linmot.json");
        std::stringstream text;
        text << in.rdbuf();
        std::vector<std::string> faults;
        auto c = Catalogue::parse(text.str(), faults);
        for (const auto& f : faults)
            std::fprintf(stderr, "%s\n", f.c_str());
        if (!c) std::abort();
        return std::move(*c);
    }();
    return all;
}

}  // namespace axisgate::linmot::test
