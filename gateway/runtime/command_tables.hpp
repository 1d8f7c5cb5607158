// Shared by the commands of the program that print tables or name a family.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

using TableRow = std::vector<std::string>;
/// Columns as wide as their widest cell, two blanks between them; standard output.
void print_table(const TableRow& head, const std::vector<TableRow>& rows);
/// RFC 4180.
void print_csv(const TableRow& head, const std::vector<TableRow>& rows);

/// All families of the program; empty after complaints about a page that cannot be read.
[[nodiscard]] std::optional<Families> families_or_complain();
/// Empty after a complaint that lists the families.
[[nodiscard]] std::optional<FamilyEntry> family_or_complain(const Families& families, const std::string& name);

}  // namespace axisgate
