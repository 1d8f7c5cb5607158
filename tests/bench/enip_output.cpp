// The output benchmark: one thread is scanner and drive at once and notes the time before the datagram is sent and the time at which the
// frame was received. It never sleeps, and has a processor for itself.
#include "tests/bench/enip_output.hpp"

#include <filesystem>
#include <random>

#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"
#include "tests/bench/enip_originator.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {
constexpr double p99_us = 200;
constexpr std::uint32_t rpi_us = 10'000;

std::uint16_t free_udp_port() {
    const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in s = at(Address{});
    socklen_t n = sizeof s;
    if (fd < 0 || ::bind(fd, reinterpret_cast<sockaddr*>(&s), n) != 0) give_up("no UDP port");
    (void)::getsockname(fd, reinterpret_cast<sockaddr*>(&s), &n);
    ::close(fd);
    return ntohs(s.sin_port);
}

/// Registers 32 to 43 of the axis: velocity mode.
Bytes output_of(std::uint16_t word, std::int32_t speed) {
    Bytes b;
    put(b, word, 2);
    put(b, 3, 2);
    for (const std::uint32_t v : {0u, 3200u, 32000u, 32000u, static_cast<std::uint32_t>(speed)})
        put(b, v, 4);
    b.resize(32);
    return b;
}

struct Folder {
    Folder() {
        if (!::mkdtemp(path.data())) give_up("no temporary folder");
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::string path = "/tmp/axisgate-bench-XXXXXX";
};
}  // namespace

bool output_to_frame(const std::string& program_path, int count) {
    cpu_set_t all, others, own;
    ::sched_getaffinity(0, sizeof all, &all);
    others = all;
    CPU_ZERO(&own);
    const auto processors = static_cast<unsigned>(::sysconf(_SC_NPROCESSORS_ONLN));
    if (processors > 1) CPU_CLR(processors - 1, &others);
    std::vector<std::string> faults;
    const Family* family = find_family("uim342");
    const auto catalogue = Catalogue::parse(asset("schema/families/uim342.json"), faults);
    if (!family || !catalogue) give_up("the family uim342 is not there");
    const Folder folder;
    Drive drive({family, &*catalogue});
    const std::uint16_t io_port = free_udp_port();
    Program program(program_path, folder.path,
                    R"({"lines":[{"name":"l","uri":"tcp:127.0.0.1:)" + std::to_string(drive.port()) +
                        R"(","family":"uim342"}],"drives":[{"name":"d","line":"l","address":5,"presence":"device"}],)"
                        R"("axes":[{"name":"a","drive":"d","number":1}]})",
                    others, {"http.bind=off", "modbus.bind=off", "enip.bind=127.0.0.1:0", "enip.io_port=" + std::to_string(io_port)});
    if (processors > 1) {
        CPU_SET(processors - 1, &own);
        (void)::sched_setaffinity(0, sizeof own, &own);
    }
    std::bitset<128> everything;
    everything.set();
    std::int64_t end = clock_ns() + 10'000'000'000;
    while (!program.ready()) {
        (void)drive.pump(everything);
        if (clock_ns() > end) give_up("getting ready takes too long");
    }
    Address device, io;
    device.port = program.port("enip");
    io.port = io_port;
    Session session(device);
    Implicit udp(io);
    const std::uint32_t owner = session.open(1, 151, 101, rpi_us, rpi_us, 38, 5, udp.port());
    std::uint32_t sequence = 0;
    Implicit::Arrival image;
    const auto for_a_while = [&](std::int64_t ns, const std::bitset<128>& expected) {
        for (const std::int64_t until = clock_ns() + ns; clock_ns() < until;) {
            (void)drive.pump(expected);
            while (udp.receive(image, 0)) {
            }
        }
    };
    // The sequence of a scanner that starts a drive: the state in the input determines the next control word.
    std::uint16_t word = 0;
    std::int32_t speed = 0;
    end = clock_ns() + 10'000'000'000;
    while (speed == 0 || number(image.input.data() + 8, 4) == 0) {
        if (clock_ns() > end) give_up("the axis does not move");
        udp.send(owner, ++sequence, output_of(word, speed));
        for_a_while(5'000'000, everything);
        const std::uint32_t state = number(image.input.data(), 2) & 0x6F;
        word = state == 0x27 || state == 0x23 ? 0x0F : state == 0x21 ? 0x07 : (state & 0x4F) == 0x40 ? 0x06 : 0;
        if (state == 0x27) speed = 500;
    }
    // The gateway's own questions: any other frame was caused by a datagram.
    drive.functions.reset();
    for (int i = 0; i < 100; ++i) {
        udp.send(owner, ++sequence, output_of(word, speed));
        for_a_while(10'000'000, everything);
    }
    const std::bitset<128> polls = drive.functions;
    std::mt19937 random(1);
    Distribution frame;
    int missed = 0;
    for (int i = 0; i < count + 50; ++i) {
        const Bytes changed = output_of(word, 1000 + i % 1000);
        const std::int64_t begun = clock_ns();
        udp.send(owner, ++sequence, changed);
        std::int64_t seen = 0;
        while (seen == 0 && clock_ns() - begun < 1'000'000'000)
            seen = drive.pump(polls);
        if (seen == 0) {
            ++missed;
        } else if (i >= 50) {
            frame.us.push_back(static_cast<double>(seen - begun) * 1e-3);
        }
        for_a_while(1'000'000 + static_cast<std::int64_t>(random() % 2'000'000), polls);
    }
    if (missed != 0 || frame.us.empty()) give_up(std::to_string(missed) + " datagrams caused no frame");
    Distribution bare = relay(count / 4, processors > 1 ? 0 : -1, 500'000);
    (void)::sched_setaffinity(0, sizeof all, &all);
    const bool kept = say("output to frame, p99", frame.at(0.99) / p99_us, "<=", 1, "axisgate", frame.at(0.99), "limit", p99_us, "us");
    std::printf("    %-34s axisgate %.0f / %.0f / %.0f us, bare TCP relay %.0f / %.0f / %.0f us, %zu datagrams\n", "median / 99 / 99.9 %",
                frame.at(0.5), frame.at(0.99), frame.at(0.999), bare.at(0.5), bare.at(0.99), bare.at(0.999), frame.us.size());
    return kept;
}

}  // namespace axisgate::bench
