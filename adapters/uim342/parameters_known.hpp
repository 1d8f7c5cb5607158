// Known: values of the drive that commands rest on, as it told them last.
// In: answers to reads and writes. Out: members; a notice where what is stored does not fit the site.
// Never a value that the drive has not told: what could not be read is absent.
#pragma once

#include <array>
#include <optional>

#include "adapters/uim342/drive_part.hpp"

namespace axisgate::uim342 {

class Known : public Part {
public:
    using Part::Part;

    /// Of group 0.
    void learn(const Message& request, std::int64_t value, Turn& t);
    void forget() noexcept;
    /// What a positioning move without rates of its own runs with, and a quick stop brakes with: SP, AC, DC, SD in pulse/s and pulse/s^2.
    /// Times (IC[4] = 1) are converted for the positioning speed. 0: the drive has not told it, or has no ramp there.
    [[nodiscard]] DriveRates rates() const noexcept;
    /// This instruction may have changed one of them, and nothing acknowledged it.
    [[nodiscard]] static bool changes_rates(const Message& request) noexcept;

    struct Ram {  ///< may be lost by a restart that nobody has seen
        std::optional<std::uint32_t> ac, dc, ss, sd;
        std::optional<bool> time_ramps;  ///< IC[4] = 1: AC and DC are ms
        std::array<std::optional<std::uint16_t>, 3> il, tg;
    } ram;
    std::optional<bool> auto_on, absolute_encoder, battery_ok, notifies;
    std::optional<bool> closed_loop;  ///< IC[6]
    std::optional<std::uint32_t> ptp_speed;
    std::optional<std::uint8_t> group;  ///< in force

private:
    void stored(std::uint8_t index, std::int64_t value, Turn& t);
    void misfit(std::string text, Turn& t);
};

}  // namespace axisgate::uim342
