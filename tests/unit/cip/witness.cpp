// Packets become a capture file with the headers of IP, TCP and UDP; tshark reads it once, when all tests of the program have ended.
#include "tests/unit/cip/witness.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <tuple>

namespace axisgate::cip::bench {
namespace {

/// A capture file of bare IP packets: magic 0xA1B2C3D4, version 2.4, link type 101.
class Capture final : public ::testing::Environment {
public:
    struct Side {
        std::uint32_t address;
        std::uint16_t port;
        auto operator<=>(const Side&) const = default;
    };

    void udp(Side from, Side to, View bytes) {
        Bytes head;
        put_ports(head, from, to);
        big(head, static_cast<std::uint32_t>(8 + bytes.size()), 2);
        big(head, 0, 2);
        packet(17, from, to, head, bytes);
    }
    void tcp(Side from, Side to, View bytes) {
        auto& sent = sent_[{from, to}];
        Bytes head;
        put_ports(head, from, to);
        big(head, 1 + sent, 4);
        big(head, 1 + sent_[{to, from}], 4);
        big(head, 0x5018, 2);  // 20 bytes of head, PSH and ACK
        big(head, 0xFFFF, 2);
        big(head, 0, 4);
        sent += static_cast<std::uint32_t>(bytes.size());
        packet(6, from, to, head, bytes);
    }

    void TearDown() override {
        if (packets_ == 0) return;
        std::string folder = (std::filesystem::temp_directory_path() / "axisgate-witness-XXXXXX").string();
        ASSERT_NE(::mkdtemp(folder.data()), nullptr);
        const std::string file = folder + "/cip.pcap";
        std::ofstream(file, std::ios::binary)
            .write(reinterpret_cast<const char*>(file_.data()), static_cast<std::streamsize>(file_.size()));
        // Two messages are left out. An answer is shown with the path of its request, and a warning appears if that is wrong on purpose.
        // And an Unconnected_Send without a route is answered only with the size of the rest of the path, where this dissector expects
        // more.
        const std::string command =
            "HOME=" + folder + " tshark -r " + file +
            " -Y '(tcp.srcport == 44818 || udp.srcport == 44818 || udp.srcport == 2222) && (_ws.malformed || ((enip || cip || cipcm || "
            "cipio) && _ws.expert.severity >= 0x600000)) && !(_ws.expert.message == \"Unsupported Segment Type\" && !_ws.malformed) && "
            "!(tcp.payload contains d2:00:01:01)' -T fields -e frame.number -e _ws.expert.message -e tcp.payload -e udp.payload 2>&1; "
            "echo \"ended $?\"";
        std::string reported;
        if (FILE* pipe = ::popen(command.c_str(), "r")) {
            std::array<char, 4096> part;
            for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
                reported.append(part.data(), n);
            (void)::pclose(pipe);
        }
        // If started by root it prints this on a line of its own.
        if (reported.starts_with("Running as user")) reported.erase(0, reported.find('\n') + 1);
        EXPECT_EQ(reported, "ended 0\n") << packets_ << " packets of the tests; the capture is kept at " << file;
        if (reported == "ended 0\n") std::filesystem::remove_all(folder);
    }

private:
    static void big(Bytes& to, std::uint32_t v, int bytes) {
        while (bytes-- > 0)
            to.push_back(static_cast<std::uint8_t>(v >> 8 * bytes));
    }
    static void put_ports(Bytes& to, Side a, Side b) {
        big(to, a.port, 2);
        big(to, b.port, 2);
    }
    void packet(std::uint8_t protocol, Side from, Side to, View head, View bytes) {
        if (packets_ == 0) {
            for (const std::uint32_t v : {0xA1B2C3D4u, 0x00020004u, 0u, 0u, 262'144u, 101u})
                big(file_, v, 4);
        }
        const auto size = static_cast<std::uint32_t>(20 + head.size() + bytes.size());
        ++packets_;
        for (const std::uint32_t v : {packets_ / 1000, packets_ % 1000 * 1000, size, size})
            big(file_, v, 4);
        big(file_, 0x4500'0000 | size, 4);
        big(file_, 0, 4);
        big(file_, 0x4000'0000 | std::uint32_t{protocol} << 16, 4);
        big(file_, from.address, 4);
        big(file_, to.address, 4);
        put_bytes(file_, head);
        put_bytes(file_, bytes);
    }
    Bytes file_;
    std::uint32_t packets_ = 0;
    std::map<std::tuple<Side, Side>, std::uint32_t> sent_;
};

Capture& capture() {
    static auto* const one = static_cast<Capture*>(::testing::AddGlobalTestEnvironment(new Capture));
    return *one;
}
[[maybe_unused]] const Capture& made_before_the_tests = capture();
}  // namespace

Witness::Witness() {
    static std::uint32_t devices = 0;
    number_ = ++devices;
}

void Witness::note(Port port, std::uint64_t session, Endpoint other, View bytes, bool to_device) {
    if (bytes.empty() || bytes.size() > 65'000) return;
    const bool group = other.address >> 28 == 0xE;
    const Capture::Side device{0x0A00'00C8 | number_ << 8, static_cast<std::uint16_t>(port == Port::implicit ? 2222 : 44818)};
    Capture::Side side{group ? other.address : 0x0A00'0000 | number_ << 8 | (other.address & 0x3F), other.port};
    if (port == Port::stream) side.port = static_cast<std::uint16_t>(40'000 + session % 20'000);
    const auto& from = to_device ? side : device;
    const auto& to = to_device ? device : side;
    if (port == Port::stream)
        capture().tcp(from, to, bytes);
    else
        capture().udp(from, to, bytes);
}

}  // namespace axisgate::cip::bench
