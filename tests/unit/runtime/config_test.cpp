// The file, the environment and --set; every fault has its place.
#include "gateway/runtime/config.hpp"
#include "gateway/runtime/config_host.hpp"
#include "gateway/runtime/door_dds.hpp"
#include "gateway/runtime/door_enip.hpp"
#include "gateway/runtime/door_http.hpp"
#include "gateway/runtime/door_modbus.hpp"

#include <gtest/gtest.h>

#include "gateway/services/parameters/memory_file.hpp"

namespace axisgate {
namespace {

TEST(Config, DefaultsAreLoopback) {
    std::vector<ConfigFault> faults;
    const Config c = read_config({}, faults);
    EXPECT_TRUE(faults.empty());
    EXPECT_EQ(c.of<HttpSettings>().bind, "127.0.0.1:8080");
    EXPECT_EQ(c.of<ModbusSettings>().bind, "127.0.0.1:1502");
    EXPECT_EQ(c.map_gaps, MapGaps::zero);
    EXPECT_EQ(c.data_dir, "./var");
    EXPECT_FALSE(c.of<DdsSettings>().enabled);
    EXPECT_EQ(c.spin_us, 0);
    EXPECT_FALSE(c.recorder_trend_disk_mb) << "what nobody has written keeps marked axes alone";
}

TEST(Config, SetBeatsEnvironmentBeatsFile) {
    ConfigSources s;
    s.file_name = "f.toml";
    s.file_text =
        "[modbus]\nbind = \"127.0.0.1:1\"\nidle_timeout_s = 7\ngaps = \"refuse\"\n[log]\nfile = \"/dev/x\"\n[http]\nallowed_hosts = "
        "[\"a\", \"b\"]\n";
    s.environment = {"AXISGATE_MODBUS_BIND=127.0.0.1:2", "AXISGATE_LOG_FILE=/dev/y", "AXISGATE_SOMETHING_ELSE=1", "PATH=/bin"};
    s.overrides = {"modbus.bind=127.0.0.1:3", "http.bind=off"};
    std::vector<ConfigFault> faults;
    const Config c = read_config(s, faults);
    EXPECT_TRUE(faults.empty()) << faults[0].text;
    EXPECT_EQ(c.of<ModbusSettings>().bind, "127.0.0.1:3");
    EXPECT_EQ(c.of<ModbusSettings>().idle_timeout_s, 7);
    EXPECT_EQ(c.map_gaps, MapGaps::refuse);
    EXPECT_EQ(c.log_file, "/dev/y");
    EXPECT_EQ(c.of<HttpSettings>().bind, "");
    EXPECT_EQ(c.of<HttpSettings>().allowed_hosts, (std::vector<std::string>{"a", "b"}));
}

TEST(Config, ListsAreWrittenAsInTheFileOrWithCommasAlone) {
    const auto with = [](std::vector<std::string> overrides, std::vector<std::string> environment = {}) {
        ConfigSources s;
        s.overrides = std::move(overrides);
        s.environment = std::move(environment);
        std::vector<ConfigFault> faults;
        const Config c = read_config(s, faults);
        EXPECT_TRUE(faults.empty()) << faults[0].text << ": " << faults[0].remedy;
        return c;
    };
    using List = std::vector<std::string>;
    for (const auto* text : {R"(["127.0.0.2", "fd00::/8"])", R"( [ '127.0.0.2','fd00::/8' , ] )", "[127.0.0.2,fd00::/8]",
                             "127.0.0.2, fd00::/8", "127.0.0.2,fd00::/8"}) {
        EXPECT_EQ(with({std::string("modbus.allow=") + text}).of<ModbusSettings>().allow, (List{"127.0.0.2", "fd00::/8"})) << text;
        EXPECT_EQ(with({}, {std::string("AXISGATE_MODBUS_ALLOW=") + text}).of<ModbusSettings>().allow, (List{"127.0.0.2", "fd00::/8"}))
            << text;
    }
    EXPECT_EQ(with({"modbus.functions=[3,6, 16]"}).of<ModbusSettings>().functions, (List{"3", "6", "16"}));
    EXPECT_EQ(with({"modbus.functions=[]"}).of<ModbusSettings>().functions, List{});
    EXPECT_EQ(with({R"(http.allowed_hosts=["a", "b.example"])"}).of<HttpSettings>().allowed_hosts, (List{"a", "b.example"}));
    EXPECT_EQ(with({"http.allowed_hosts=[::1],[::2]"}).of<HttpSettings>().allowed_hosts, (List{"[::1]", "[::2]"}))
        << "brackets of addresses are no list";
    for (const auto* bad : {"modbus.functions=[3,six]", R"(modbus.allow=["127.0.0.2)", R"(modbus.allow=["127.0.0.2", "x])",
                            "modbus.functions=[[3]]", "http.allowed_hosts=http://a", "http.allowed_hosts=a:80", "http.allowed_hosts=a,b/c",
                            "http.allowed_hosts=a b", "lines.pty_dir=var", "lines.pty_dir="}) {
        ConfigSources s;
        s.overrides = {bad};
        std::vector<ConfigFault> faults;
        (void)read_config(s, faults);
        EXPECT_EQ(faults.size(), 1u) << bad;
    }
}

TEST(Config, EveryFaultAtOnceWithLineAndRemedy) {
    ConfigSources s;
    s.file_name = "f.toml";
    s.file_text = "[http]\nbind = 5\nnonsense = 1\n[log]\nlevel = \"loud\"\n[what]\nx = 1\n[runtime]\nspin_us = 1001\n";
    s.overrides = {"nothing", "http.nothing=1", "runtime.hot_cpu=x"};
    std::vector<ConfigFault> faults;
    (void)read_config(s, faults);
    std::vector<std::string> places;
    for (const auto& f : faults) {
        places.push_back(f.place);
        EXPECT_FALSE(f.remedy.empty()) << f.text;
    }
    for (const auto* p :
         {"f.toml:2", "f.toml:3", "f.toml:5", "f.toml:6", "f.toml:9", "--set nothing", "--set http.nothing", "--set runtime.hot_cpu"}) {
        EXPECT_NE(std::find(places.begin(), places.end(), p), places.end()) << p;
    }
    EXPECT_EQ(faults.size(), 8u);
    s.file_text = "[http\nbind";
    faults.clear();
    (void)read_config(s, faults);
    ASSERT_FALSE(faults.empty());
    EXPECT_EQ(faults[0].place, "f.toml:1");
}

TEST(Config, WhatIsNoNameAndWhatIsWrittenAsAnotherKindIsAFault) {
    ConfigSources s;
    s.file_name = "f.toml";
    s.file_text = "[data]\ndir = 7\n[log]\nfile = 3\n[modbus_rtu]\nport = 5\n[dds]\npartition = \"a*\"\n[http]\nallowed_hosts = 4\n";
    s.environment = {"AXISGATE_MODBUS_RTU_PORT=udp:h:1"};
    std::vector<ConfigFault> faults;
    (void)read_config(s, faults);
    std::vector<std::string> places;
    for (const auto& f : faults) {
        places.push_back(f.place);
        EXPECT_FALSE(f.remedy.empty()) << f.text;
    }
    for (const auto* p : {"f.toml:2", "f.toml:4", "f.toml:6", "f.toml:8", "f.toml:10", "AXISGATE_MODBUS_RTU_PORT"})
        EXPECT_NE(std::find(places.begin(), places.end(), p), places.end()) << p;
    EXPECT_EQ(faults.size(), 6u);
    s.file_text = "[dds]\nenabled = true\n";
    s.environment.clear();
    s.overrides = {"dds.enabled=false", "data.dir=7"};
    faults.clear();
    const Config overridden = read_config(s, faults);
    EXPECT_EQ(overridden.data_dir, "7") << "on the command line all is text";
    EXPECT_FALSE(overridden.of<DdsSettings>().enabled) << "what is overridden does not count";
    EXPECT_TRUE(faults.empty());
}

TEST(Config, TheSerialPortOfModbusRtuIsAPathOrALine) {
    const auto port_of = [](std::vector<std::string> overrides, std::size_t wrong = 0) {
        ConfigSources s;
        s.overrides = std::move(overrides);
        std::vector<ConfigFault> faults;
        const Config c = read_config(s, faults);
        EXPECT_EQ(faults.size(), wrong) << (faults.empty() ? s.overrides[0] : faults[0].text);
        return rtu_port(c);
    };
    EXPECT_FALSE(port_of({"modbus_rtu.port=off"}).used);
    RtuPort p = port_of({"modbus_rtu.port=/dev/ttyUSB0"});
    EXPECT_TRUE(p.used);
    EXPECT_EQ(p.name, "/dev/ttyUSB0");
    EXPECT_EQ(to_text(p.uri), "serial:/dev/ttyUSB0?baud=19200&format=8E1") << "the specification's defaults";
    p = port_of({"modbus_rtu.port=serial:/dev/ttyS1?baud=38400&rs485=1", "modbus_rtu.baud=9600", "modbus_rtu.format=8N2"});
    EXPECT_EQ(p.name, "/dev/ttyS1");
    EXPECT_EQ(p.baud, 38400u);
    EXPECT_EQ(to_text(p.format), "8N2");
    p = port_of({"modbus_rtu.port=tcp:192.0.2.9:4001", "modbus_rtu.baud=57600"});
    EXPECT_EQ(p.name, "tcp:192.0.2.9:4001");
    EXPECT_EQ(p.baud, 57600u) << "behind the network stands a wire with a rate";
    p = port_of({"modbus_rtu.port=pty:/tmp/x?baud=4800&format=8N1"});
    EXPECT_EQ(p.name, "pty:/tmp/x");
    EXPECT_EQ(p.baud, 4800u);
    for (const auto* bad : {"can:can0", "twin", "udp:h:1", "ttyUSB0", "serial:/dev/ttyS1?format=7E1", "serial:/dev/ttyS1?what=1"})
        EXPECT_FALSE(port_of({std::string("modbus_rtu.port=") + bad}, 1).fault.empty()) << bad;
    for (const auto* bad :
         {"modbus_rtu.unit=0", "modbus_rtu.unit=248", "modbus_rtu.baud=10", "modbus_rtu.format=7E1", "modbus_rtu.format=9N1"})
        (void)port_of({bad}, 1);
}

TEST(Config, ADoorBeyondThisMachineWithoutNamesIsWarnedOf) {
    for (const auto* bind : {"0.0.0.0:8080", "[::]:8080", "192.0.2.7:80"}) {
        Config c;
        c.of<HttpSettings>().bind = bind;
        c.of<HttpSettings>().tls_cert = "cert.pem";
        const auto reported = check_host(c);
        ASSERT_EQ(reported.size(), 1u) << bind;
        EXPECT_EQ(reported[0].place, "http.allowed_hosts");
        EXPECT_TRUE(reported[0].warning);
        c.of<HttpSettings>().allowed_hosts = {"axisgate.example"};
        EXPECT_TRUE(check_host(c).empty()) << bind;
    }
    for (const auto* bind : {"127.0.0.1:8080", "127.9.9.9:1", "[::1]:8080", "localhost:8080", ""}) {
        Config c;
        c.of<HttpSettings>().bind = bind;
        EXPECT_TRUE(check_host(c).empty()) << bind;
    }
}

TEST(Config, HostAndPort) {
    EXPECT_EQ(parse_host_port("127.0.0.1:80")->port, 80);
    EXPECT_EQ(parse_host_port("[::1]:80")->host, "::1");
    for (const auto* bad : {"", ":80", "x", "x:", "x:y", "x:65536", "::1:80", "[]:1", "[::1]80"})
        EXPECT_FALSE(parse_host_port(bad)) << bad;
}

TEST(MemoryFile, ATwinThatStandsTwiceIsRefused) {
    std::map<std::string, NonVolatile> memories;
    EXPECT_EQ(memories_from_json("{\"5\": {\"AC\": 1},\n\"5\": {\"AC\": 2}}", memories),
              "the member \"5\" stands twice in the memory of twins, in line 2 (/5): keep one of them");
    EXPECT_TRUE(memories.empty());
}

TEST(MemoryFile, KeepsTypes) {
    std::map<std::string, NonVolatile> m{
        {"5", {{"AC", Value{std::int64_t{5000}}}, {"on", Value{true}}, {"f", Value{1.5}}, {"t", Value{std::string("x")}}}}};
    std::map<std::string, NonVolatile> back;
    EXPECT_EQ(memories_from_json(memories_to_json(m), back), "");
    EXPECT_EQ(back, m);
    EXPECT_NE(memories_from_json("[1]", back), "");
    EXPECT_NE(memories_from_json("{\"5\": 1}", back), "");
    EXPECT_EQ(memories_from_json(" \n", back), "");
}

TEST(Config, LettersBeyondAsciiStandInQuotesAndCommentsAlone) {
    const auto faults_of = [](std::string text) {
        ConfigSources s;
        s.file_name = "f.toml";
        s.file_text = std::move(text);
        std::vector<ConfigFault> faults;
        (void)read_config(s, faults);
        return faults;
    };
    EXPECT_TRUE(faults_of("# schön\n[data]\ndir = \"/tmp/möbel \\\" ä\"\n[log]\nfile = '/tmp/ü'  # é\n").empty());
    EXPECT_TRUE(faults_of("\xEF\xBB\xBF[data]\ndir = \"x\"\n").empty());
    for (const char* text : {"[data]\nd\xC3\xA4r = \"x\"\n", "[data]\ndir = \"x\" \xEF\xBB\xAF\n", "[data]\n\xEF\xBB\xAF",
                             "[data]\ndir = \"open\n\xEF\xBB\xAF", "[data]\ner r = 0.0v.[*:10\"1\xEF\xBB\xBD\n",
                             "[data]\ndir = \"open \xEF\xBB\xBD\n", "[data]\ndir = 2.~8{''''{''\xEF\xBB\xAF''\n"}) {
        const auto faults = faults_of(text);
        ASSERT_EQ(faults.size(), 1u) << text;
        EXPECT_NE(faults[0].text.find("ASCII"), std::string::npos) << faults[0].text;
    }
}

TEST(Config, CheckNamesWhatIsOpenThatShouldNotBe) {
    const auto places = [](const Config& c) {
        std::set<std::string> out;
        for (const auto& f : check_host(c)) {
            EXPECT_TRUE(f.warning) << f.place << ": it starts all the same";
            EXPECT_FALSE(f.remedy.empty());
            out.insert(f.place);
        }
        return out;
    };
    Config c;
    EXPECT_EQ(places(c), std::set<std::string>{}) << "as it comes, it is reached from this machine alone";
    c.of<HttpSettings>().bind = "0.0.0.0:8080";
    c.of<HttpSettings>().allowed_hosts = {"axisgate.example"};
    EXPECT_EQ(places(c), (std::set<std::string>{"http.tls_cert", "users.local_role"}));
    c.users_local_role = "none";
    EXPECT_EQ(places(c), (std::set<std::string>{"http.tls_cert"}));
    c.users_local_role = "engineer";
    c.of<HttpSettings>().tls_cert = "cert.pem";
    EXPECT_EQ(places(c), std::set<std::string>{});
    c = {};
    c.of<ModbusSettings>().bind = "192.0.2.7:502";
    EXPECT_EQ(places(c), (std::set<std::string>{"modbus.allow"}));
    c.of<ModbusSettings>().allow = {"192.0.2.0/24"};
    c.of<EnipSettings>().bind = "*:44818";
    EXPECT_EQ(places(c), (std::set<std::string>{"enip.bind"}));
    c = {};
    c.of<DdsSettings>().enabled = true;
    EXPECT_EQ(places(c), std::set<std::string>{}) << "on the loopback interface";
    c.of<DdsSettings>().interface_name = "eth0";
    EXPECT_EQ(places(c), (std::set<std::string>{"dds.security"}));
    c.of<DdsSettings>().security = "/etc/axisgate/dds";
    EXPECT_EQ(places(c), std::set<std::string>{});
}

}  // namespace
}  // namespace axisgate
