// Looks up headers and the names of methods.
#include "gateway/doors/http/message.hpp"

#include <algorithm>
#include <array>

namespace axisgate::http {
namespace {
bool same_name(std::string_view a, std::string_view b) noexcept {
    const auto low = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::ranges::equal(a, b, {}, low, low);
}
constexpr std::array<std::string_view, 8> method_names{"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "OTHER"};
}  // namespace

std::string_view name_of(Method method) noexcept { return method_names[static_cast<std::size_t>(method)]; }

Method method_named(std::string_view name) noexcept {
    for (std::size_t i = 0; i + 1 < method_names.size(); ++i) {
        if (method_names[i] == name) return static_cast<Method>(i);
    }
    return Method::other;
}

std::string_view Headers::get(std::string_view name) const noexcept {
    for (const auto& [k, v] : fields) {
        if (same_name(k, name)) return v;
    }
    return {};
}

std::size_t Headers::count(std::string_view name) const noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(fields, [name](const auto& f) { return same_name(f.first, name); }));
}

void Headers::set(std::string_view name, std::string value) {
    for (auto& [k, v] : fields) {
        if (same_name(k, name)) {
            v = std::move(value);
            return;
        }
    }
    fields.emplace_back(std::string(name), std::move(value));
}

void Headers::remove(std::string_view name) {
    std::erase_if(fields, [name](const auto& f) { return same_name(f.first, name); });
}

}  // namespace axisgate::http
