// The texts of refusals that several services share.
#include "gateway/services/refusal.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate {

ServiceRefusal no_such(std::string_view what, std::string_view name) {
    return {ServiceRefusal::Why::not_found, fmt::format("there is no {} {}", what, name)};
}

std::string first_of(const std::vector<Fault>& faults, std::size_t more) {
    std::string text = faults.empty() ? std::string("the document is not right") : faults.front().text;
    if (faults.size() + more > 1) text += fmt::format(" (and {} more)", faults.size() + more - 1);
    return text;
}

ServiceRefusal faulty(std::vector<Fault> faults, std::string_view axis, ServiceRefusal::Why why) {
    std::string text = first_of(faults);
    return {why, std::move(text), std::string(axis), std::move(faults)};
}

std::vector<Fault> faults_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document) {
    std::vector<Fault> out;
    for (const auto& f : faults) {
        const bool inside =
            !entry.empty() && f.pointer.starts_with(entry) && (f.pointer.size() == entry.size() || f.pointer[entry.size()] == '/');
        out.push_back({inside ? f.pointer.substr(entry.size()) : f.pointer, f.text, f.remedy, whole_document || inside});
    }
    return out;
}

ServiceRefusal refusal_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document) {
    auto list = faults_for(faults, entry, whole_document);
    if (faults.empty() || !std::ranges::all_of(faults, &SiteFault::conflict)) return faulty(std::move(list));
    std::string text = fmt::format("{}; {}", list.front().text, list.front().remedy);
    return {ServiceRefusal::Why::conflict, std::move(text), {}, std::move(list)};
}

}  // namespace axisgate
