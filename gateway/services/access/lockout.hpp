// A growing pause after wrong sign-ins, per user and per peer. Keys are such as "user anna" and "peer 192.0.2.7"; the time is an argument.
// Bound: 4096 keys, of which the one with the oldest failure is removed. A key is forgotten after an hour without a failure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace axisgate {

class Lockout {
public:
    static constexpr std::size_t max_keys = 4096;
    static constexpr int free_failures = 3;            ///< a typing error has no consequence
    static constexpr int free_failures_of_peer = 12;   ///< for all names together, because several people may share one address
    static constexpr std::int64_t max_pause_s = 300;   ///< 1, 2, 4 ... s after the free failures, at most this
    static constexpr std::int64_t forgotten_s = 3600;  ///< without a further failure

    /// Seconds until the next attempt is accepted; 0: now.
    [[nodiscard]] std::int64_t pause_s(std::string_view key, std::int64_t now_ns, int free = free_failures) const;
    /// Counts an attempt as failed. It is called before the attempt is checked, so that many simultaneous attempts do not count as one.
    void failed(std::string_view key, std::int64_t now_ns);
    /// Removes one failure, because the attempt was good.
    void take_back(std::string_view key);
    /// Forgets the key, because it is known to be good.
    void clear(std::string_view key);
    [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }

private:
    struct Entry {
        int failures = 0;
        std::int64_t last_ns = 0;
    };
    std::map<std::string, Entry, std::less<>> entries_;
};

}  // namespace axisgate
