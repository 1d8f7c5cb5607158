// Catalogues: reads the embedded page of every family that was built in.
// In: the assets. Out: Families, whose catalogues live as long as the process. Never looks at the disk.
#pragma once

#include <string>
#include <vector>

#include "gateway/registers/profiles/language.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// All families with their catalogues; faults name the file. Read once, kept for the life of the process.
[[nodiscard]] Families load_families(std::vector<std::string>& faults);
/// The pages of the languages that profiles of registers speak; one with a fault is left out.
[[nodiscard]] registers::Languages load_languages(std::vector<std::string>& faults);

}  // namespace axisgate
