// OptionReader reads the options of a line or drive and collects their faults, in one wording for all families. It never refuses: an option
// that is not understood counts as not given, and is reported as a notice.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/instant.hpp"

namespace axisgate::drive {

class OptionReader {
public:
    explicit OptionReader(const std::map<std::string, std::string>& options) : options_(options) {}

    /// Empty if the option is not given.
    [[nodiscard]] std::string_view text(const std::string& name) const;
    /// One of the words. The first is the default for an absent or unknown word.
    [[nodiscard]] std::string_view word(const std::string& name, std::initializer_list<std::string_view> words);
    /// True for the word `yes`, false for `no`; true, 1, false and 0 are accepted where the two words are on and off.
    [[nodiscard]] bool flag(const std::string& name, bool otherwise, std::string_view yes = "on", std::string_view no = "off");
    /// An integer low..high; an empty text counts as absent. Digits followed by other characters are not a number.
    [[nodiscard]] std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high, std::int64_t otherwise);
    /// An integer number of milliseconds.
    [[nodiscard]] Duration milliseconds(const std::string& name, std::int64_t low, std::int64_t high, Duration otherwise);
    /// Adds a fault that the family has found: "option reference_order: write channels 1 to 16 with commas".
    void fault(std::string text) { faults_.push_back(std::move(text)); }

    /// "option check = 5: write learn, compute or zero; learn is used". At most one per option that was read.
    [[nodiscard]] std::vector<std::string> take_faults() { return std::move(faults_); }

private:
    const std::map<std::string, std::string>& options_;
    std::vector<std::string> faults_;
};

}  // namespace axisgate::drive
