// Scan of the UIM342: every node ID is asked for its model (ML), as at the start of any drive.
// In: first and last ID. Out: the IDs in order. Never asks the global or a group address: everybody would answer at once.
#include <charconv>

#include "adapters/uim342/family.hpp"
#include "adapters/uim342/wire.hpp"

namespace axisgate::uim342 {

ScanPlan scan(const ScanWish& wish) {
    ScanPlan plan;
    const auto id_of = [&](const std::string& text, int otherwise) {
        int n = otherwise;
        const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), n);
        if (!text.empty() && (ec != std::errc() || end != text.data() + text.size() || n < first_node || n > last_node))
            plan.fault = text + " is no node ID: a UIM342 has one from 5 to 126";
        return n;
    };
    const int from = id_of(wish.from, first_node), to = id_of(wish.to, last_node);
    if (plan.fault.empty() && from > to) plan.fault = "from is above to";
    if (!plan.fault.empty()) return plan;
    for (int i = from; i <= to; ++i)
        plan.addresses.push_back(std::to_string(i));
    plan.at_once = wish.kind == LineKind::can ? 8 : 2;
    return plan;
}

}  // namespace axisgate::uim342
