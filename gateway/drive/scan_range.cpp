#include "gateway/drive/scan_range.hpp"

#include <fmt/core.h>

#include "gateway/core/text.hpp"

namespace axisgate::drive {

ScanPlan scan_range(const ScanWish& wish, int first, int last, std::string (*check)(std::string_view)) {
    ScanPlan plan;
    for (const std::string* end : {&wish.from, &wish.to})
        if (!end->empty() && plan.fault.empty()) plan.fault = check(*end);
    const auto from = parse_whole(wish.from, first, last).value_or(first), to = parse_whole(wish.to, first, last).value_or(last);
    if (plan.fault.empty() && from > to)
        plan.fault = fmt::format("from {} to {} is no range: the first address is above the last", from, to);
    for (auto n = from; n <= to && plan.fault.empty(); ++n)
        plan.addresses.push_back(std::to_string(n));
    return plan;
}

}  // namespace axisgate::drive
