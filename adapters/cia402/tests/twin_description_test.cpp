// The simulated CiA 402 drive made of a maker's file: its values where the file has any, the model's where it is silent.
#include <fmt/core.h>

#include <fstream>

#include "adapters/cia402/tests/twin_bench.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using namespace std::chrono_literals;
using canopen::Abort;
using canopen::Address;

TEST(Cia402Twin, KeepsItsOwnValuesWhereADescriptionIsSilentAndMovesByThem) {
    std::ifstream in(AXISGATE_SOURCE_DIR "/adapters/cia402/tests/eds/plain.eds");
    std::string text, row;
    int silent = 0;
    while (std::getline(in, row)) {
        const bool value = row.starts_with("DefaultValue=") || row.starts_with("LowLimit=") || row.starts_with("HighLimit=");
        silent += value;
        text += (value ? row.substr(0, row.find('=') + 1) : row) + "\n";
    }
    ASSERT_GT(silent, 50) << "the file";
    std::vector<canopen::FileFault> faults, notes;
    const auto eds = canopen::read_eds(text, faults, notes);
    ASSERT_TRUE(eds) << (faults.empty() ? "" : faults[0].text);
    Bench b({}, &*eds);
    EXPECT_EQ(b.read(0x1018, 1), *eds->vendor_number) << "the identity is the file's";
    EXPECT_EQ(b.read(0x1018, 2), *eds->product_number);
    Bench usual;
    for (const std::uint16_t index :
         {std::uint16_t{0x6081}, std::uint16_t{0x6083}, std::uint16_t{0x6502}, std::uint16_t{0x6065}, std::uint16_t{0x6067}})
        EXPECT_EQ(b.read(index), usual.read(index)) << fmt::format("{:04X}h", index);
    b.enable(1);
    ASSERT_EQ(b.write(0x6081, 0, 20'000, 4), Abort::none);
    ASSERT_EQ(b.write(0x6083, 0, 200'000, 4), Abort::none);
    ASSERT_EQ(b.write(0x6084, 0, 200'000, 4), Abort::none);
    ASSERT_EQ(b.write(0x607A, 0, 2'000, 4), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0x1F, 2), Abort::none);
    b.pass(300ms);
    EXPECT_EQ(b.read(0x6064), 2'000);
}

TEST(Cia402Twin, IsBuiltFromADescriptionAndSaysWhatItDoesNotModel) {
    const std::string text =
        "[FileInfo]\nFileName=a.eds\n[DeviceInfo]\nVendorNumber=0x99\n[MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n"
        "[1000]\nParameterName=Device type\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0x00020192\nPDOMapping=0\n"
        "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2100\n"
        "[2100]\nParameterName=Gain\nObjectType=0x7\nDataType=0x0006\nAccessType=rw\nDefaultValue=12\nHighLimit=100\nPDOMapping=0\n"
        "[OptionalObjects]\nSupportedObjects=1\n1=0x6081\n"
        "[6081]\nParameterName=Profile velocity\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\nDefaultValue=4321\nPDOMapping=1\n";
    std::vector<canopen::FileFault> faults, notes;
    const auto eds = canopen::read_eds(text, faults, notes);
    ASSERT_TRUE(eds) << (faults.empty() ? "" : faults[0].text);
    Bench b({}, &*eds);
    EXPECT_EQ(b.read(0x2100), 12);
    EXPECT_EQ(b.write(0x2100, 0, 101, 2), Abort::too_high);
    EXPECT_EQ(b.write(0x2100, 0, 99, 2), Abort::none);
    EXPECT_EQ(b.read(0x6081), 4321);
    for (const auto& item : b.twin->hand())
        if (item.name == "unmodelled") EXPECT_EQ(item.value, Value{std::int64_t{1}});
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
