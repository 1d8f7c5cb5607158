// Parameters: the words of MCode that hold a value, read and written; and Survey: what is read without a command.
// In: ReadParameter, WriteParameter; the drive's own listings. Out: lines and questions; samples, results, notices.
// Never writes what belongs to the line (name, echo, checksum), and never declares a user variable.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "adapters/mcode/drive_job.hpp"

namespace axisgate::mcode {

/// The word of a parameter, which is its id where the catalogue has no other.
[[nodiscard]] std::string word_of_parameter(const Parameter& p);
/// Name, mode, checksum, echo and escape: the line's own business.
[[nodiscard]] bool is_link_word(std::string_view word) noexcept;

class Parameters final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void answered(const std::string& data, Turn& t) override;
    [[nodiscard]] bool complained(const Step& step, int error, Turn& t) override;
    [[nodiscard]] bool own_lines() const noexcept override { return true; }
    /// Why the drive may not have the parameter in hand, if that is a user variable; else empty.
    [[nodiscard]] std::string variable_hint() const;

private:
    [[nodiscard]] const Parameter* in_hand() const;
    void write(const Parameter& p, const Value& value, Turn& t);
    [[nodiscard]] bool fits(const Parameter& p) const;
    void write_variables(const std::string& rows, Turn& t);
    [[nodiscard]] bool has_type(const std::string& data) const;
    void learn(const Parameter& p, const Value& v, bool written);
    bool already_typed_ = false;  ///< the drive answered the write with error 6: what is read tells
};

class Survey final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command&, Turn&) override {}
    void answered(const std::string& data, Turn& t) override;
    void listed(const std::string& text, Turn& t) override;
    void without_success(drive::Failure& how, Turn& t) override;

    /// The drive was found: its user variables are listed when its turn has come.
    void plan_listing(Instant now);
    [[nodiscard]] bool wants(Instant now) const noexcept;          ///< it has questions that commands rest on
    [[nodiscard]] bool wants_listing(Instant now) const noexcept;  ///< at rest: what a program prints would stand within it
    void read_again();
    void list_variables(Instant now);

private:
    bool listing_ = false;  ///< its user variables have not been listed since it came
    Instant listing_at_{};  ///< its turn to do so
    bool shape_ = false;    ///< what makes a motion another than a trapezoid is asked
};

}  // namespace axisgate::mcode
