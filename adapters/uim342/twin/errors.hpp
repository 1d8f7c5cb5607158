// ErrorHistory: the errors that a drive keeps until its next boot, as ER reads and clears them [L1173-1179].
// In: what was refused, ER's index. Out: entries, the acknowledgement of a cleared one. Never keeps more than the last nine.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace axisgate::uim342::twin {

struct ErrorEntry {
    std::uint8_t code = 0;
    std::uint8_t cw = 0;
    std::uint8_t sub = 0;
};

class ErrorHistory {
    template <class Self>
    static auto* slot_of(Self& self, std::uint8_t index) noexcept {
        if (index >= 10 + self.kept_) return static_cast<decltype(self.latest_.data())>(nullptr);
        if (index == 0) return self.latest_.data();
        if (index == 6) return &self.power_on_;
        return index >= 10 && index < 10 + self.latest_.size() ? &self.latest_[index - 10u] : nullptr;
    }

public:
    /// `kept`: 9 latest errors, or 8 as in the manual's other sentence (E-14).
    explicit ErrorHistory(std::uint8_t kept = 9) noexcept : kept_(kept) {}
    void add(const ErrorEntry& entry) noexcept {
        std::ranges::move_backward(latest_.begin(), latest_.end() - 1, latest_.end());
        latest_[0] = entry;
    }
    /// Found while it was switched on.
    void at_power_on(const ErrorEntry& entry) noexcept { power_on_ = entry; }
    /// ER[0] and ER[10]: the latest; ER[11]..ER[18]: the ones before; ER[6]: power-on error; nullptr: none of these.
    [[nodiscard]] ErrorEntry* slot(std::uint8_t index) noexcept { return slot_of(*this, index); }
    [[nodiscard]] const ErrorEntry* slot(std::uint8_t index) const noexcept { return slot_of(*this, index); }

private:
    std::array<ErrorEntry, 9> latest_{};
    ErrorEntry power_on_{};
    std::uint8_t kept_;
};

}  // namespace axisgate::uim342::twin
