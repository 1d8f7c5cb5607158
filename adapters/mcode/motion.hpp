// Power, Motion, Homing: the verbs of CiA 402 in the words of MCode.
// In: commands from the queue. Out: lines, and what the axis shows when they were obeyed.
// Never starts what it could not set: a refused value ends the job before the motion.
#pragma once

#include <string>
#include <string_view>

#include "adapters/mcode/drive_job.hpp"

namespace axisgate::mcode {

/// Enable and ResetFault. Disable is a stop.
class Power final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void done(Turn& t) override;
    [[nodiscard]] bool moves() const noexcept override { return true; }
    [[nodiscard]] Proof proof(const Step& step, Duration since) const override;
};

/// Move and SetPosition. A relative move is sent as the absolute one that it means at standstill, so that a repeat cannot move twice.
class Motion final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void sending(Step& step, Request& r) override;
    void answered(const std::string& data, Turn& t) override;
    void done(Turn& t) override;
    void without_success(drive::Failure& how, Turn& t) override;
    [[nodiscard]] bool moves() const noexcept override { return true; }
    [[nodiscard]] Proof proof(const Step& step, Duration since) const override;
    [[nodiscard]] bool own_lines() const noexcept override { return true; }

private:
    void move(const Move& m, Turn& t);
    [[nodiscard]] std::string out_of_range(const Move& m) const;
    void set_speed(std::int64_t velocity);
    void set_ramp(char word, const std::optional<std::int64_t>& rate, std::int64_t& known);
    void slow_start(std::int64_t speed);
    [[nodiscard]] Proof begun(std::int64_t target, Duration since) const;
    [[nodiscard]] Proof slews(std::int64_t speed, Duration since) const;
    bool relative_ = false;   ///< the target counts from where it comes to rest
    int rounds_ = 0;          ///< how often speeds and ramps were set again, since they were read as others
    std::int64_t begin_ = 0;  ///< position read before the line
    bool moved_ = false;      ///< it moved before the line
};

class Homing final : public Verb {
public:
    using Verb::Verb;
    void plan(const Command& command, Turn& t) override;
    void sending(Step& step, Request& r) override;
    void done(Turn& t) override;
    [[nodiscard]] bool moves() const noexcept override { return true; }
    [[nodiscard]] bool own_lines() const noexcept override { return true; }
    [[nodiscard]] Proof proof(const Step& step, Duration since) const override;

private:
    std::int64_t begin_ = 0;  ///< position read before the search
};

}  // namespace axisgate::mcode
