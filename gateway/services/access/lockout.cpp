// Doubling pauses in a table by key. After the clock was set back, a pause is no longer than its full length.
#include "gateway/services/access/lockout.hpp"

#include <algorithm>

namespace axisgate {
namespace {
constexpr std::int64_t second = 1'000'000'000;
}  // namespace

std::int64_t Lockout::pause_s(std::string_view key, std::int64_t now_ns, int free) const {
    const auto it = entries_.find(key);
    if (it == entries_.end() || it->second.failures < free) return 0;
    if (now_ns - it->second.last_ns > forgotten_s * second) return 0;
    const int beyond = std::min(it->second.failures - free, 20);
    const std::int64_t pause = std::min(max_pause_s, std::int64_t{1} << beyond);
    const std::int64_t rest_ns = it->second.last_ns + pause * second - now_ns;
    // A clock that was set back must not lock anybody out for longer than the pause itself.
    return rest_ns <= 0 ? 0 : std::min(pause, (rest_ns + second - 1) / second);
}

void Lockout::failed(std::string_view key, std::int64_t now_ns) {
    auto it = entries_.find(key);
    if (it == entries_.end()) {
        if (entries_.size() >= max_keys) {
            entries_.erase(std::ranges::min_element(entries_, {}, [](const auto& e) { return e.second.last_ns; }));
        }
        it = entries_.emplace(std::string(key), Entry{}).first;
    }
    if (now_ns - it->second.last_ns > forgotten_s * second) it->second.failures = 0;
    it->second.failures = std::min(it->second.failures + 1, 1000);
    it->second.last_ns = now_ns;
}

void Lockout::take_back(std::string_view key) {
    const auto it = entries_.find(key);
    if (it == entries_.end()) return;
    if (--it->second.failures <= 0) entries_.erase(it);
}

void Lockout::clear(std::string_view key) {
    if (const auto it = entries_.find(key); it != entries_.end()) entries_.erase(it);
}

}  // namespace axisgate
