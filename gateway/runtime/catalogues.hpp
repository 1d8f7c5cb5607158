// Reads the embedded page of every family. The catalogues live as long as the process; the disk is not read.
#pragma once

#include <string>
#include <vector>

#include "gateway/registers/profiles/language.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// All families with their catalogues; faults name the file. Read once, kept for the life of the process.
[[nodiscard]] Families load_families(std::vector<std::string>& faults);
/// The pages of the languages of register profiles; one with a fault is left out.
[[nodiscard]] registers::Languages load_languages(std::vector<std::string>& faults);

}  // namespace axisgate
