// Catalogues: parses schema/families/<family>.json as it was built in; a family whose page has a fault is left out, and the fault is told.
// In: assets. Out: families with their catalogues, faults in words. Never reads twice.
#include "gateway/runtime/catalogues.hpp"

#include <memory>

#include "gateway/core/assets.hpp"

namespace axisgate {

Families load_families(std::vector<std::string>& faults) {
    static std::vector<std::unique_ptr<Catalogue>> kept;
    Families families;
    for (const Family* f : all_families()) {
        const std::string path = "schema/families/" + std::string(f->name) + ".json";
        std::vector<std::string> wrong;
        auto catalogue = Catalogue::parse(asset(path), wrong);
        for (const auto& w : wrong)
            faults.push_back(path + ": " + w);
        if (!catalogue) continue;
        kept.push_back(std::make_unique<Catalogue>(std::move(*catalogue)));
        families.entries.push_back({f, kept.back().get()});
    }
    return families;
}

}  // namespace axisgate
