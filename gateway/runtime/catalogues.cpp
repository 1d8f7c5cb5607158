// Parses schema/families/<family>.json as embedded in the program. A family whose page has a fault is left out, and the fault is reported.
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

registers::Languages load_languages(std::vector<std::string>& faults) {
    registers::Languages all;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string path = "schema/profiles/" + std::string(name_of(static_cast<ProfileLanguage>(i))) + ".json";
        std::string fault;
        all[i] = registers::read_language(asset(path), fault);
        if (!all[i]) faults.push_back(path + ": " + fault);
    }
    return all;
}

}  // namespace axisgate
