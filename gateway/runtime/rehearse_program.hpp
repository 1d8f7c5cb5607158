// Runs a program of its own, such as the program of a PLC, against a specimen: a gateway in virtual time with simulated drives, a Modbus
// and an EtherNet/IP door on this computer, and the program as a child process that commands it. The time of the gateway passes
// `time_scale` times as fast as that of the computer, and more slowly if the computer is too slow for that, so that no drive is ever late
// because of it.
#pragma once

#include <cstddef>
#include <string>

#include "gateway/registers/register_image.hpp"
#include "gateway/services/recipes/recipe_rehearsal.hpp"

namespace axisgate {

struct ProgramRehearsalWish {
    std::string command;                         ///< for /bin/sh
    double time_scale = 10;                      ///< 0.1 to 1000
    Duration limit = std::chrono::seconds(600);  ///< of virtual time; the program is ended then
    Site site{};                                 ///< with the specimens as options of its drives
    SiteMemory memory{};
    Duration lease = std::chrono::seconds(30);
    registers::RegisterImage::Settings registers{};
};

/// The program has AXISGATE_MODBUS and AXISGATE_ENIP (ADDRESS:PORT), AXISGATE_TIME_SCALE and AXISGATE_SPECIMEN in its environment, and
/// begins when the drives are online. It has passed if its exit code is 0. The last line that it printed is the reason otherwise, and its
/// last line that begins with "step: " names the step; of its output at most `kept_output` bytes are kept.
[[nodiscard]] RehearsedSpecimen rehearse_program(const Families& families, const ProgramRehearsalWish& wish, const std::string& specimen);

inline constexpr std::size_t kept_output = 16 * 1024;

}  // namespace axisgate
