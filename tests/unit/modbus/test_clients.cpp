// Independent clients (libmodbus, mbpoll) with the real server, which runs on its own thread with drives that accept everything. libmodbus
// is loaded at run time, so that only this test needs it.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <modbus/modbus.h>

#include <atomic>
#include <cerrno>
#include <thread>

#include "tests/unit/modbus/net.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using testing::HasSubstr;

/// The used functions of libmodbus, with their own types.
struct Library {
    Library() : handle(::dlopen("libmodbus.so.5", RTLD_NOW | RTLD_LOCAL)) {}
    template <class F>
    F* get(const char* name) {
        return handle ? reinterpret_cast<F*>(::dlsym(handle, name)) : nullptr;
    }
    void* handle;
};
#define AXISGATE_MODBUS(name) decltype(::name)* name = library.get<decltype(::name)>(#name)
struct Api {
    Library library;
    AXISGATE_MODBUS(modbus_new_tcp);
    AXISGATE_MODBUS(modbus_connect);
    AXISGATE_MODBUS(modbus_close);
    AXISGATE_MODBUS(modbus_free);
    AXISGATE_MODBUS(modbus_set_slave);
    AXISGATE_MODBUS(modbus_strerror);
    AXISGATE_MODBUS(modbus_read_bits);
    AXISGATE_MODBUS(modbus_read_input_bits);
    AXISGATE_MODBUS(modbus_read_registers);
    AXISGATE_MODBUS(modbus_read_input_registers);
    AXISGATE_MODBUS(modbus_write_bit);
    AXISGATE_MODBUS(modbus_write_register);
    AXISGATE_MODBUS(modbus_write_registers);
    AXISGATE_MODBUS(modbus_mask_write_register);
    AXISGATE_MODBUS(modbus_write_and_read_registers);
    AXISGATE_MODBUS(modbus_report_slave_id);
};
#undef AXISGATE_MODBUS

/// The running server and its drives.
struct Running {
    Running() {
        for (std::uint16_t n = 1; n <= 8; ++n) {
            net.port.edit(n <= 4 ? net.axes[n] : net.port.add_axis(n, &test::catalogue()), [&](AxisPicture& p) {
                p.statusword = 0x0250;
                p.mode_display = -3;
                p.position = n == 1 ? 0x01020304 : -2;
                p.flags = 0x0031;
            });
        }
        thread = std::thread([this] {
            while (!stop) {
                net.io.restart();
                net.io.run_one_for(std::chrono::milliseconds(10));
                while (!net.port.commands.empty())
                    answer();
            }
        });
    }
    ~Running() {
        stop = true;
        thread.join();
    }
    void answer() {
        const auto& body = net.port.commands.front().body;
        const auto* d = std::get_if<ProcessData>(&body);
        if (d && d->mode == 99) {
            net.port.refuse(Reason::out_of_range);
        } else if (std::holds_alternative<ReadParameter>(body)) {
            net.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{0x01020304}});
        } else {
            net.port.answer();
        }
    }
    test::Net net;
    std::atomic<bool> stop{false};
    std::thread thread;
};

struct LibmodbusTest : testing::Test {
    void SetUp() override {
        ASSERT_TRUE(api.library.handle) << "install libmodbus5: " << ::dlerror();
        context = api.modbus_new_tcp("127.0.0.1", running.net.tcp_port);
        ASSERT_EQ(api.modbus_connect(context), 0) << api.modbus_strerror(errno);
    }
    void TearDown() override {
        if (!context) return;
        api.modbus_close(context);
        api.modbus_free(context);
    }
    Running running;
    Api api;
    modbus_t* context = nullptr;
};

TEST_F(LibmodbusTest, Reads) {
    std::uint16_t r[125] = {};
    ASSERT_EQ(api.modbus_read_registers(context, 0, 10, r), 10) << api.modbus_strerror(errno);
    EXPECT_EQ(r[0], 0x0250);
    EXPECT_EQ(r[1], 0xFFFD);
    EXPECT_EQ(MODBUS_GET_INT32_FROM_INT16(r, 2), 0x01020304);
    ASSERT_EQ(api.modbus_read_input_registers(context, 64, 4, r), 4);
    EXPECT_EQ(MODBUS_GET_INT32_FROM_INT16(r, 2), -2);
    ASSERT_EQ(api.modbus_read_registers(context, 0, 125, r), 125);
    EXPECT_EQ(r[64], 0x0250);
    std::uint8_t bits[512] = {};
    ASSERT_EQ(api.modbus_read_bits(context, 0, 32, bits), 32);
    EXPECT_THAT(std::vector<int>(bits, bits + 8), testing::ElementsAre(1, 0, 0, 0, 1, 1, 0, 0));
    EXPECT_EQ(bits[16 + 4], 1);
    EXPECT_EQ(bits[16 + 5], 0);
    ASSERT_EQ(api.modbus_read_input_bits(context, 0, 512, bits), 512);
    EXPECT_EQ(bits[448], 1) << "the first bit of axis 8";
}

TEST_F(LibmodbusTest, Writes) {
    EXPECT_EQ(api.modbus_write_register(context, 32, 0x000F), 1) << api.modbus_strerror(errno);
    const std::uint16_t target[2] = {0x0102, 0x0304};
    EXPECT_EQ(api.modbus_write_registers(context, 34, 2, target), 2);
    EXPECT_EQ(api.modbus_mask_write_register(context, 32, 0xFFEF, 0x0010), 1);
    std::uint16_t r[4] = {};
    ASSERT_EQ(api.modbus_read_registers(context, 32, 4, r), 4);
    EXPECT_THAT(r, testing::ElementsAre(0x001F, 0, 0x0102, 0x0304));
    const std::uint16_t more[2] = {0xFFFF, 0xFFFE};
    ASSERT_EQ(api.modbus_write_and_read_registers(context, 34, 2, more, 32, 4, r), 4);
    EXPECT_THAT(r, testing::ElementsAre(0x001F, 0, 0xFFFF, 0xFFFE));
}

TEST_F(LibmodbusTest, Exceptions) {
    std::uint16_t r[125];
    EXPECT_EQ(api.modbus_read_registers(context, 8 * 64, 1, r), -1);
    EXPECT_EQ(errno, EMBXGPATH);
    EXPECT_EQ(api.modbus_read_registers(context, 65535, 2, r), -1);
    EXPECT_EQ(errno, EMBXILADD);
    EXPECT_EQ(api.modbus_write_register(context, 0, 1), -1);
    EXPECT_EQ(errno, EMBXILADD);
    EXPECT_EQ(api.modbus_write_register(context, 34, 1), -1);
    EXPECT_EQ(errno, EMBXILVAL);
    EXPECT_EQ(api.modbus_write_register(context, 33, 99), -1) << "the engine refused";
    EXPECT_EQ(errno, EMBXILVAL);
    EXPECT_EQ(api.modbus_write_bit(context, 0, 1), -1);
    EXPECT_EQ(errno, EMBXILADD);
    api.modbus_set_slave(context, 3);
    EXPECT_EQ(api.modbus_read_registers(context, 0, 1, r), -1);
    EXPECT_EQ(errno, EMBXGPATH);
    api.modbus_set_slave(context, 255);
    EXPECT_EQ(api.modbus_read_registers(context, 0, 1, r), 1);
}

TEST_F(LibmodbusTest, Identification) {
    std::uint8_t id[64] = {};
    const int n = api.modbus_report_slave_id(context, sizeof id, id);
    ASSERT_GT(n, 9) << api.modbus_strerror(errno);
    EXPECT_EQ(id[0], 255) << "the unit that it asks by itself";
    EXPECT_EQ(id[1], 0xFF);
    EXPECT_EQ(std::string(id + 2, id + 10), "axisgate");
}

TEST_F(LibmodbusTest, ParameterChannel) {
    const std::uint16_t start[3] = {0, 0, 1};
    ASSERT_EQ(api.modbus_write_registers(context, 48, 3, start), 3);
    std::uint16_t r[7] = {};
    for (int i = 0; i < 100 && r[3] != 2; ++i)
        ASSERT_EQ(api.modbus_read_registers(context, 48, 7, r), 7);
    EXPECT_THAT(r, testing::ElementsAre(0, 0, 1, 2, 0x0102, 0x0304, 0));
}

std::string run(const std::string& command) {
    std::string out;
    FILE* p = ::popen((command + " 2>&1").c_str(), "r");
    char buffer[512];
    while (p && std::fgets(buffer, sizeof buffer, p))
        out += buffer;
    const int status = p ? ::pclose(p) : -1;
    return out + "exit " + std::to_string(WIFEXITED(status) ? WEXITSTATUS(status) : -1);
}

struct MbpollTest : testing::Test {
    std::string mbpoll(const std::string& arguments, const std::string& values = "") {
        return run("mbpoll -m tcp -1 -p " + std::to_string(running.net.tcp_port) + " " + arguments + " 127.0.0.1 " + values);
    }
    Running running;
};

TEST_F(MbpollTest, ReadsAndWrites) {
    ASSERT_THAT(run("mbpoll -V"), HasSubstr("exit 0")) << "install mbpoll";
    EXPECT_THAT(mbpoll("-0 -r 0 -c 2 -t 4:hex"), testing::AllOf(HasSubstr("0x0250"), HasSubstr("0xFFFD"), HasSubstr("exit 0")));
    EXPECT_THAT(mbpoll("-r 3 -c 1 -t 4:int -B"), HasSubstr("16909060")) << "0x01020304, counted from 1";
    EXPECT_THAT(mbpoll("-0 -r 66 -c 1 -t 3:int -B"), HasSubstr("-2"));
    EXPECT_THAT(mbpoll("-0 -r 0 -c 8 -t 1"), HasSubstr("exit 0"));
    EXPECT_THAT(mbpoll("-0 -r 34 -t 4:int -B", "-- -70000"), testing::AllOf(HasSubstr("Written 1 reference"), HasSubstr("exit 0")));
    EXPECT_THAT(mbpoll("-0 -r 34 -t 4:int -B -c 1"), HasSubstr("-70000"));
    EXPECT_THAT(mbpoll("-0 -r 0 -t 4", "7"), HasSubstr("Illegal data address"));
    EXPECT_THAT(mbpoll("-0 -r 34 -t 4", "7"), HasSubstr("Illegal data value"));
    EXPECT_THAT(mbpoll("-a 9 -0 -r 0 -c 1"), HasSubstr("Gateway path unavailable"));
}

}  // namespace
}  // namespace axisgate::modbus
