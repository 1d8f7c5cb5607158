// Trouble: the times of the last few answers of a kind; a sentence when enough of them stand close together.
// In: kinds and instants. Out: counts in words, or nothing.
// Never keeps more than the last few times.
#include "adapters/mcode/drive_trouble.hpp"

#include <fmt/core.h>

#include <string_view>

namespace axisgate::mcode {

std::string Trouble::add(Kind kind, Instant now) {
    if (counts_ == decltype(counts_){}) since_ = now;
    ++counts_[static_cast<std::size_t>(kind)];
    recent_.push_back(now);
    if (recent_.size() > from_) recent_.pop_front();
    const bool again = recent_.size() == from_ && now - recent_.front() <= window;
    if (!again || (ever_ && now - reported_ < pause)) return {};
    constexpr std::array<std::string_view, kinds> words{"late", "cut off", "spoiled", "lost", "doubled"};
    std::string s;
    for (std::size_t i = 0; i < kinds; ++i) {
        if (counts_[i] != 0) s += fmt::format("{}{} {}", s.empty() ? "" : ", ", counts_[i], words[i]);
    }
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now - since_).count();
    if (seconds > 0) s += fmt::format(" in {} s", seconds);
    ever_ = true;
    reported_ = now;
    counts_ = {};
    return s;
}

}  // namespace axisgate::mcode
