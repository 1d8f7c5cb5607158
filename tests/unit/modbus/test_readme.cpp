// The door's README prints the register map: it is compared with the table that the program uses.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

#include "gateway/doors/modbus/register_map.hpp"

namespace axisgate::modbus {
namespace {

TEST(ModbusReadme, PrintsTheRegisterMapAsItIs) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/gateway/doors/modbus/README.md");
    ASSERT_TRUE(file) << "gateway/doors/modbus/README.md is missing";
    std::vector<std::string> printed;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("| ") && line[2] >= '0' && line[2] <= '9') printed.push_back(line);
    }
    std::vector<std::string> expected;
    for (const auto& row : standard_registers()) {
        constexpr std::array types{"u16", "i16", "u32", "i32"};
        expected.push_back("| " + std::to_string(row.offset) + " | " + std::to_string(40001 + row.offset) + " | " +
                           types[static_cast<std::size_t>(row.type)] + " | " + (row.writable ? "RW" : "R") + " | " + std::string(row.name) +
                           " |");
    }
    EXPECT_EQ(printed, expected);
}

}  // namespace
}  // namespace axisgate::modbus
