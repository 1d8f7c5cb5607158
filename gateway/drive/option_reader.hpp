// OptionReader: reads the options of a line or drive and gathers what is wrong with them, in one wording for all families.
// In: names, allowed values, the value otherwise. Out: values that can be used; sentences for those that could not be read.
// Never refuses: an option that is not understood counts as not given, and is told as a notice.
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

    /// Empty: not given.
    [[nodiscard]] std::string_view text(const std::string& name) const;
    /// One of the words; their first is taken where the option is absent or another.
    [[nodiscard]] std::string_view word(const std::string& name, std::initializer_list<std::string_view> words);
    /// `yes` is set and `no` is not; the same spelt true, 1, false or 0 where they are on and off.
    [[nodiscard]] bool flag(const std::string& name, bool otherwise, std::string_view yes = "on", std::string_view no = "off");
    /// A whole number low..high; an empty text counts as absent.
    [[nodiscard]] std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high, std::int64_t otherwise);
    /// A whole number of milliseconds.
    [[nodiscard]] Duration milliseconds(const std::string& name, std::int64_t low, std::int64_t high, Duration otherwise);
    /// Something that the family found by itself: "option reference_order: write channels 1 to 16 with commas".
    void fault(std::string text) { faults_.push_back(std::move(text)); }

    /// "option check = 5: write learn, compute or zero; learn is used". At most one per option that was asked for.
    [[nodiscard]] std::vector<std::string> take_faults() { return std::move(faults_); }

private:
    const std::map<std::string, std::string>& options_;
    std::vector<std::string> faults_;
};

}  // namespace axisgate::drive
