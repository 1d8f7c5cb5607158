// Wire: one whole drive, motor included, in virtual time, reached as a host reaches it.
// In: bytes, the tester's hand, time. Out: bytes, and how often the drive was called.
// Never looks inside the drive: what it cannot ask on the wire it does not know.
#pragma once

#include "adapters/mcode/tests/twin_bench.hpp"

namespace axisgate::mcode::twin::test {

class Wire {
public:
    explicit Wire(std::uint8_t product = lmdc, char name = '!', const NonVolatile& memory = {}, int frame_size = 23,
                  bool ethernet = false) {
        DeviceSetup setup;
        setup.ethernet = ethernet;
        setup.product = product;
        setup.name = name;
        setup.bit_rate = 9600;
        device = std::make_unique<Device>(setup, make_mechanism({product, frame_size}));
        device->power_on(memory, now, out_);
        collect();
    }
    /// Bytes as they are, then everything that is due within `wait`. What the drive sent, as `shown` writes it.
    std::string bytes(std::string_view b, Duration wait = milliseconds(5)) {
        sent.clear();
        Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(b.data()), b.size()});
        f.at = now;
        device->on_frame(f, now, out_);
        collect();
        pass(wait);
        return shown(sent);
    }
    /// One line in single mode with EM = 0: its data alone.
    std::string ask(const std::string& line, Duration wait = milliseconds(5)) {
        (void)bytes(line + "\r", wait);
        std::string rest = sent.substr(std::min(line.size() + 2, sent.size()));
        if (!rest.empty()) {
            prompt = rest.back();
            rest.pop_back();
        }
        while (rest.ends_with('\n') || rest.ends_with('\r'))
            rest.pop_back();
        return rest;
    }
    std::int64_t number(const std::string& word) {
        const std::string s = ask("PR " + word, milliseconds(1));
        char* end = nullptr;
        const long long v = std::strtoll(s.c_str(), &end, 10);
        EXPECT_TRUE(end != s.c_str() && *end == '\0') << word << ": " << s;
        return v;
    }
    /// The code that a line raises; 0 if none. Reading it clears it.
    int error_of(const std::string& line) {
        (void)ask("ER=0");
        (void)ask(line);
        return static_cast<int>(number("ER"));
    }
    void lines(const std::vector<std::string>& all) {
        for (const auto& l : all) {
            (void)ask(l);
            EXPECT_EQ(prompt, '>') << l << ": error " << ask("PR ER");
        }
    }
    void program(const std::vector<std::string>& all) {
        lines({"PG 1"});
        lines(all);
        lines({"PG"});
    }
    void hand(const std::string& name, const Value& v) {
        EXPECT_EQ(device->set_hand(name, v, now, out_), "") << name;
        collect();
    }
    void pass(Duration d) {
        const Instant end = now + d;
        while (device->deadline() <= end) {
            ASSERT_LT(++calls, 5'000'000) << "deadlines do not end";
            now = std::max(now, device->deadline());
            device->on_deadline(now, out_);
            collect();
        }
        now = end;
    }

    Instant now = Instant{} + std::chrono::seconds(1);
    std::unique_ptr<Device> device;
    std::string sent;
    char prompt = '\0';
    long calls = 0;

private:
    void collect() {
        for (const auto& tx : out_.frames)
            sent.append(reinterpret_cast<const char*>(tx.frame.storage.data()), tx.frame.size);
        out_.clear();
    }
    Out out_;
};

}  // namespace axisgate::mcode::twin::test
