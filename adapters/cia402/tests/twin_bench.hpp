// One simulated CiA 402 drive without an adapter: the test sends SDO, PDO and NMT frames itself and lets time pass. It uses the bus only,
// except for the simulated hand and the mechanics.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "adapters/cia402/twin/twin.hpp"
#include "gateway/protocols/canopen/message.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/protocols/canopen/pdo.hpp"
#include "gateway/protocols/canopen/sdo.hpp"

namespace axisgate::cia402_drive::twin::test {

struct Bench {
    using Options = std::map<std::string, std::string>;
    std::unique_ptr<Twin> twin;
    Out out;
    Instant now = at_ns(1'000'000'000);
    std::uint8_t node = 5;

    explicit Bench(Options options = {}, const canopen::Eds* eds = nullptr, NonVolatile memory = {}) {
        TwinSetup setup;
        setup.address = "5";
        setup.kind = LineKind::can;
        setup.options = std::move(options);
        twin = make_twin(setup, eds);
        twin->power_on(memory, now, out);
    }
    /// The twin of another family at node 5 that behaves the same on the bus.
    explicit Bench(std::unique_ptr<Twin> other) : twin(std::move(other)) { twin->power_on({}, now, out); }
    void pass(Duration d) {
        now += d;
        twin->on_deadline(now, out);
    }
    void send(const Frame& f) { twin->on_frame(f, now, out); }
    /// The last answer of the SDO server.
    Frame sdo(std::uint8_t command, canopen::Address a, std::uint32_t value = 0) {
        out.clear();
        send(canopen::sdo_frame(0x600u + node, command, a, value));
        for (const auto& tx : out.frames)
            if (tx.frame.id == 0x580u + node) return tx.frame;
        ADD_FAILURE() << "no answer about " << canopen::to_text(a);
        return canopen::sdo_frame(0, 0, a);
    }
    canopen::Abort write(std::uint16_t index, std::uint8_t sub, std::int64_t v, int size) {
        const Frame f = sdo(static_cast<std::uint8_t>(0x23 | (4 - size) << 2), {index, sub}, static_cast<std::uint32_t>(v));
        return f.storage[0] == 0x80 ? static_cast<canopen::Abort>(canopen::value_of(f)) : canopen::Abort::none;
    }
    std::int64_t read(std::uint16_t index, std::uint8_t sub = 0) {
        const Frame f = sdo(0x40, {index, sub});
        EXPECT_NE(f.storage[0], 0x80) << std::hex << index << ": " << canopen::value_of(f);
        const int size = 4 - (f.storage[0] >> 2 & 3);
        return canopen::as_signed(canopen::value_of(f), static_cast<std::uint8_t>(8 * size));
    }
    [[nodiscard]] unsigned status() { return static_cast<unsigned>(read(0x6041)) & 0xFFFFu; }
    void word(unsigned cw) { ASSERT_EQ(write(0x6040, 0, cw, 2), canopen::Abort::none); }
    void enable(int mode) {
        ASSERT_EQ(write(0x6060, 0, mode, 1), canopen::Abort::none);
        for (const unsigned cw : {6u, 7u, 0xFu})
            word(cw);
        ASSERT_EQ(status() & 0x6Fu, 0x27u);
    }
    /// "605#4000100000000000".
    static Frame frame_of(const std::string& text) {
        std::vector<std::uint8_t> bytes;
        for (std::size_t i = 4; i + 1 < text.size(); i += 2)
            bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
        return canopen::data_frame(static_cast<std::uint32_t>(std::stoul(text.substr(0, 3), nullptr, 16)), bytes);
    }
    /// Sends the requests of a family's vectors and compares the answers. Returns the number of answers.
    std::size_t answers_of_vectors(const std::string& family) {
        std::ifstream f(AXISGATE_SOURCE_DIR "/adapters/" + family + "/vectors.txt");
        std::string line, name;
        std::size_t answers = 0, at = 0;
        while (std::getline(f, line)) {
            if (line.starts_with("case ")) name = line;
            if (line.starts_with("> ")) {
                out.clear();
                at = 0;
                send(frame_of(line.substr(2)));
            }
            if (!line.starts_with("< ")) continue;
            EXPECT_LT(at, out.frames.size()) << name;
            if (at >= out.frames.size()) return answers;
            EXPECT_EQ(to_text(out.frames[at++].frame), to_text(frame_of(line.substr(2)))) << name;
            ++answers;
        }
        return answers;
    }
    [[nodiscard]] std::size_t count(std::uint32_t id) const {
        return static_cast<std::size_t>(
            std::count_if(out.frames.begin(), out.frames.end(), [&](const auto& tx) { return tx.frame.id == id; }));
    }
};

}  // namespace axisgate::cia402_drive::twin::test
