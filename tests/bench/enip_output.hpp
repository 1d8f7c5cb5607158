// The output benchmark measures the time from a datagram with an output assembly to the frame that it causes on the drive's line. It prints
// the distribution and its limit, and returns whether the limit is kept. There is one change at a time.
#pragma once

#include <string>

namespace axisgate::bench {

[[nodiscard]] bool output_to_frame(const std::string& program_path, int count);

}  // namespace axisgate::bench
