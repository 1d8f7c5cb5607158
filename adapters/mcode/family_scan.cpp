// Scan of MCode drives: each name of the party mode is asked for what the drive is; a drive that is alone on its line answers to `!`.
// In: first and last name. Out: names in the order ! 0-9 A-Z a-z.
// Never mixes the two where it is known better: on a line with named drives `!` is left out, because named drives do not expect it.
#include <algorithm>

#include "adapters/mcode/family.hpp"

namespace axisgate::mcode {

ScanPlan scan(const ScanWish& wish) {
    ScanPlan plan;
    const std::string all = "!0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    const auto place = [&](const std::string& text, std::size_t otherwise) {
        if (text.empty()) return otherwise;
        const auto at = text.size() == 1 ? all.find(text) : std::string::npos;
        if (at == std::string::npos) plan.fault = text + " is no name of a drive: write ! or one of 0-9, A-Z, a-z";
        return at;
    };
    const auto from = place(wish.from, 0), to = place(wish.to, all.size() - 1);
    if (plan.fault.empty() && from > to) plan.fault = "from is behind to: the order is ! 0-9 A-Z a-z";
    if (!plan.fault.empty()) return plan;
    const bool party = std::ranges::any_of(wish.known, [](const auto& k) { return k != "!"; });
    const bool single = std::ranges::find(wish.known, "!") != wish.known.end();
    if (single) return plan;  // one drive, alone on its line: there is nobody else
    for (auto i = from; i <= to; ++i) {
        if (i != 0 || !party) plan.addresses.emplace_back(1, all[i]);
    }
    return plan;
}

}  // namespace axisgate::mcode
