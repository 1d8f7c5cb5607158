// Compares the register map in the door's README with the table of the program.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

#include "gateway/registers/register_map.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;

TEST(ModbusReadme, PrintsTheRegisterMapAsItIs) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/gateway/doors/modbus/README.md");
    ASSERT_TRUE(file) << "gateway/doors/modbus/README.md is missing";
    std::vector<std::string> printed;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("| ") && line[2] >= '0' && line[2] <= '9')
            printed.push_back(line);
        else if (!printed.empty())
            break;  // the following tables are others
    }
    std::vector<std::string> expected;
    for (const auto& row : standard_registers()) {
        expected.push_back("| " + std::to_string(row.offset) + " | " + std::to_string(40001 + row.offset) + " | " +
                           std::string(name_of(row.type)) + " | " + (row.writable ? "RW" : "R") + " | " + std::string(row.name) + " |");
    }
    EXPECT_EQ(printed, expected);
}

/// The rows "| number | word | ..." of the table below the line that begins with `head`.
std::vector<std::string> reasons_in(const std::string& path, std::string_view head) {
    std::ifstream file(path);
    std::vector<std::string> found;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        line.erase(0, line.find_first_not_of(' '));
        if (line.starts_with(head)) {
            inside = true;
            continue;
        }
        if (!inside || line.starts_with("|---")) continue;
        if (!line.starts_with("| ")) break;
        found.push_back(line.substr(2, line.find(" |", line.find(" | ") + 3) - 2));
    }
    return found;
}

TEST(ModbusReadme, ReasonsAreThoseOfTheProgram) {
    std::vector<std::string> expected;
    for (int n = 0; n <= static_cast<int>(Reason::internal); ++n)
        expected.push_back(std::to_string(n) + " | " + std::string(name_of(static_cast<Reason>(n))));
    EXPECT_EQ(reasons_in(AXISGATE_SOURCE_DIR "/gateway/doors/modbus/README.md", "| Number | Reason | Exception |"), expected);
    EXPECT_EQ(reasons_in(AXISGATE_SOURCE_DIR "/schema/openapi.yaml", "| Number | Reason | Exception | What it means |"), expected);
}

}  // namespace
}  // namespace axisgate::modbus
