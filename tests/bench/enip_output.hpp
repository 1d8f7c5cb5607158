// Output benchmark: from a datagram with an output assembly to the frame that it causes on the drive's line.
// In: the program's path. Out: the distribution beside its limit; false if the limit is not kept. Never more than one change at a time.
#pragma once

#include <string>

namespace axisgate::bench {

[[nodiscard]] bool output_to_frame(const std::string& program_path, int count);

}  // namespace axisgate::bench
