// The ports of a machine that is made of folders: which are listed, and under which names.
#include "gateway/lines/host_ports.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace axisgate {
namespace {
namespace fs = std::filesystem;

class HostPortsTest : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(root); }
    void TearDown() override { fs::remove_all(root); }
    void file(const std::string& path, const std::string& text) const {
        fs::create_directories((root / path).parent_path());
        std::ofstream(root / path) << text << "\n";
    }
    void link(const std::string& path, const fs::path& to) const {
        fs::create_directories((root / path).parent_path());
        fs::create_symlink(to, root / path);
    }
    fs::path root = fs::temp_directory_path() / ("axisgate-host-ports-" + std::to_string(::getpid()));
};

TEST_F(HostPortsTest, aMachineWithoutAnyHasNone) { EXPECT_TRUE(host_ports(root).empty()); }

TEST_F(HostPortsTest, canInterfacesAreToldByTheirTypeAndWhetherTheyAreUp) {
    file("sys/class/net/eth0/type", "1");
    file("sys/class/net/can1/type", "280");
    file("sys/class/net/can1/flags", "0x40080");
    file("sys/class/net/vcan0/type", "280");
    file("sys/class/net/vcan0/flags", "0x400c1");
    fs::create_directories(root / "sys/bus/drivers/mcp251x");
    fs::create_directories(root / "sys/devices/spi0");
    link("sys/devices/spi0/driver", root / "sys/bus/drivers/mcp251x");
    link("sys/class/net/can1/device", root / "sys/devices/spi0");
    const auto list = host_ports(root);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0], (SystemPort{SystemPort::Kind::can, "can1", "", "mcp251x", false}));
    EXPECT_EQ(list[1], (SystemPort{SystemPort::Kind::can, "vcan0", "", "virtual", true}));
}

TEST_F(HostPortsTest, anAdapterIsToldByTheNameThatStaysAndByItsMaker) {
    file("sys/devices/usb1/1-1/product", "FT232R USB UART");
    file("sys/devices/usb1/1-1/manufacturer", "FTDI");
    fs::create_directories(root / "sys/devices/usb1/1-1/1-1:1.0/ttyUSB0");
    link("sys/class/tty/ttyUSB0/device", root / "sys/devices/usb1/1-1/1-1:1.0/ttyUSB0");
    link("dev/serial/by-id/usb-FTDI_FT232R-if00-port0", "../../ttyUSB0");
    fs::create_directories(root / "sys/class/tty/tty1");  // a console, without a device
    file("sys/class/tty/ttyS3/type", "0");                // a place for a port that does not exist
    fs::create_directories(root / "sys/class/tty/ttyS3/device");
    file("sys/class/tty/ttyS0/type", "4");
    fs::create_directories(root / "sys/class/tty/ttyS0/device");
    const auto list = host_ports(root);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0], (SystemPort{SystemPort::Kind::serial, "ttyS0", "/dev/ttyS0", "", true}));
    EXPECT_EQ(list[1], (SystemPort{SystemPort::Kind::serial, "ttyUSB0", "/dev/serial/by-id/usb-FTDI_FT232R-if00-port0",
                                   "FTDI FT232R USB UART", true}));
}

TEST_F(HostPortsTest, whatADeviceCallsItselfIsBoundedAndPlainText) {
    file("sys/devices/usb1/1-1/product", std::string(5000, 'x') + "\x01\xFF");
    fs::create_directories(root / "sys/devices/usb1/1-1/ttyACM0");
    link("sys/class/tty/ttyACM0/device", root / "sys/devices/usb1/1-1/ttyACM0");
    file("sys/devices/usb1/1-2/product", "A\x1B[31mB\x7F");
    fs::create_directories(root / "sys/devices/usb1/1-2/ttyACM1");
    link("sys/class/tty/ttyACM1/device", root / "sys/devices/usb1/1-2/ttyACM1");
    const auto list = host_ports(root);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].text, std::string(128, 'x'));
    EXPECT_EQ(list[1].text, "A[31mB");
    for (int i = 0; i < 400; ++i)
        fs::create_directories(root / "sys/class/tty" / ("ttyX" + std::to_string(i)) / "device");
    EXPECT_EQ(host_ports(root).size(), most_host_ports);
}

}  // namespace
}  // namespace axisgate
