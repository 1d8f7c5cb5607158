// The decoder of CANopen captures: objects by name, PDOs by the mapping in the capture, and frames that are not CANopen. Frames are written
// as candump prints them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "adapters/cia402/decoder.hpp"

namespace axisgate::cia402_drive::test {
namespace {

struct Capture : testing::Test {
    Catalogue page = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/cia402.json");
        std::stringstream text;
        text << f.rdbuf();
        std::vector<std::string> faults;
        auto c = Catalogue::parse(text.str(), faults);
        EXPECT_TRUE(c) << (faults.empty() ? "" : faults[0]);
        return std::move(*c);
    }();
    CanDecoder decoder{page};
    std::string reported(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
        const std::vector<std::uint8_t> data(bytes);
        const auto lines = decoder.on_frame(canopen::data_frame(id, data), std::nullopt);
        EXPECT_EQ(lines.size(), 1u);
        return lines.empty() ? "" : lines[0];
    }
};

TEST_F(Capture, NamesObjectsServicesAndCodes) {
    EXPECT_EQ(reported(0x605, {0x40, 0x64, 0x60, 0, 0, 0, 0, 0}), "node 5: read 6064h:00 position_actual_value?");
    EXPECT_EQ(reported(0x585, {0x43, 0x64, 0x60, 0, 0x24, 0xFA, 0xFF, 0xFF}), "node 5: read 6064h:00 position_actual_value = -1500");
    EXPECT_EQ(reported(0x605, {0x2B, 0x40, 0x60, 0, 0x0F, 0, 0, 0}), "node 5: write 6040h:00 controlword = 15");
    EXPECT_EQ(reported(0x585, {0x60, 0x40, 0x60, 0, 0, 0, 0, 0}), "node 5: written 6040h:00 controlword");
    EXPECT_EQ(reported(0x585, {0x80, 0x00, 0x55, 0, 0, 0, 0x02, 0x06}).find("node 5: refusal of 5500h:00: the object does not exist"), 0u);
    EXPECT_EQ(reported(0x000, {1, 5}), "NMT: start node 5");
    EXPECT_EQ(reported(0x080, {}), "SYNC");
    EXPECT_EQ(reported(0x705, {5}), "node 5: operational");
    EXPECT_NE(reported(0x085, {0x11, 0x86, 0x11, 0, 0, 0, 0, 0}).find("node 5: EMCY 8611h"), std::string::npos);
    EXPECT_NE(decoder.on_frame(Frame::can_extended(0x12345, {}), std::nullopt).at(0).find("unknown"), std::string::npos);
}

TEST_F(Capture, ReadsPdosByTheMappingThatItSaw) {
    const std::initializer_list<std::uint8_t> tpdo{0x37, 0x06, 0xE8, 0x03, 0, 0, 8};
    EXPECT_EQ(reported(0x185, tpdo), "node 5: TPDO 1: 37 06 E8 03 00 00 08 (mapping not seen)");
    for (const auto& w : canopen::writes_of(status_pdo(5))) {
        std::array<std::uint8_t, 4> value{};
        std::copy(w.bytes.begin(), w.bytes.end(), value.begin());
        const auto command = static_cast<std::uint8_t>(0x23 | (4 - w.bytes.size()) << 2);
        (void)reported(0x605, {command, static_cast<std::uint8_t>(w.address.index), static_cast<std::uint8_t>(w.address.index >> 8),
                               w.address.sub, value[0], value[1], value[2], value[3]});
    }
    EXPECT_EQ(reported(0x185, tpdo), "node 5: TPDO 1: statusword = 1591, position_actual_value = 1000, modes_of_operation_display = 8");
    EXPECT_EQ(reported(0x186, tpdo), "node 6: TPDO 1: 37 06 E8 03 00 00 08 (mapping not seen)") << "another node's is its own";
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
