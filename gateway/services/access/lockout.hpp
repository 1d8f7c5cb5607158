// Lockout: a growing pause after wrong sign-ins, per user and per peer.
// In: keys ("user anna", "peer 192.0.2.7") and times. Out: how long to wait. Never reads a clock.
// Bound: 4096 keys; beyond, the one whose last failure is longest ago is forgotten. A key is forgotten after an hour of peace.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace axisgate {

class Lockout {
public:
    static constexpr std::size_t max_keys = 4096;
    static constexpr int free_failures = 3;            ///< a slip of the finger costs nothing
    static constexpr int free_failures_of_peer = 12;   ///< of all names together: behind one address there may be several people
    static constexpr std::int64_t max_pause_s = 300;   ///< 1, 2, 4 ... s after the free ones, at most this
    static constexpr std::int64_t forgotten_s = 3600;  ///< without a further failure

    /// Seconds until the next attempt is looked at; 0: now.
    [[nodiscard]] std::int64_t pause_s(std::string_view key, std::int64_t now_ns, int free = free_failures) const;
    /// Counts an attempt as failed; called before it is looked at, so that many at once are not many for the price of one.
    void failed(std::string_view key, std::int64_t now_ns);
    /// Takes one failure back: the attempt was a good one.
    void take_back(std::string_view key);
    /// The key is known to be good: forget it.
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
