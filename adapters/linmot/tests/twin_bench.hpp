// A simulated drive without an adapter: the test sends telegrams, in virtual time. It can bring the drive to operation enabled.
#pragma once

#include <gtest/gtest.h>

#include "adapters/linmot/tests/page.hpp"
#include "adapters/linmot/tests/vectors.hpp"
#include "adapters/linmot/twin/device.hpp"
#include "adapters/linmot/twin/twin.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::linmot::test {
using namespace std::chrono_literals;

/// A drive behind its wire.
struct Bench {
    using Options = std::map<std::string, std::string>;
    Options options;
    std::unique_ptr<Twin> twin;
    Instant now = at_ns(1'000'000'000);
    std::uint8_t count = 0;

    explicit Bench(Options with = {}) : options(std::move(with)) {
        TwinSetup s;
        s.address = "17";
        s.options = options;
        s.freedoms = freedoms_of(page(), options);
        s.seed = 1;
        twin = with_common_freedoms(linmot::twin::make_twin(page(), s), s);
        Out out;
        twin->power_on({}, now, out);
    }
    /// Not with freedoms that are common to all families: the drive is behind another twin then.
    twin::Device& device() { return static_cast<twin::Device&>(*twin); }
    twin::Drive& drive() { return device().drive(); }

    void run(Duration d) {
        const Instant end = now + d;
        Out out;
        while (twin->deadline() <= end) {
            now = std::max(now, twin->deadline());
            twin->on_deadline(now, out);
        }
        now = end;
        twin->on_deadline(now, out);
        for (const auto& f : out.frames)
            late.insert(late.end(), f.frame.data().begin(), f.frame.data().end());
    }
    std::vector<std::uint8_t> late;  ///< sent by the drive while time passed

    std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& bytes) {
        Out out;
        twin->on_frame(Frame::run(bytes), now, out);
        std::vector<std::uint8_t> all;
        for (const auto& f : out.frames)
            all.insert(all.end(), f.frame.data().begin(), f.frame.data().end());
        return all;
    }
    std::vector<std::uint8_t> ask(const char* hex) { return ask(bytes_of(hex)); }
    /// sub, main, data
    std::vector<std::uint8_t> tell(std::vector<std::uint8_t> body) {
        std::vector<std::uint8_t> t{1, 17, static_cast<std::uint8_t>(body.size() + 1), 2};
        t.insert(t.end(), body.begin(), body.end());
        t.push_back(4);
        return ask(t);
    }
    void control(std::uint16_t word) { (void)tell({0, 1, static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8)}); }
    static void put(std::vector<std::uint8_t>& v, std::int64_t value, int n) {
        for (int i = 0; i < n; ++i)
            v.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> 8 * i));
    }
    /// A motion command with the next count, by the catalogue's layout.
    void motion(std::string_view id, const std::vector<std::int64_t>& values = {}) {
        const auto* c = page().command(id);
        ASSERT_TRUE(c) << id;
        const auto header = std::stoul(std::string(c->id.substr(0, 3)), nullptr, 16) << 4;
        count = static_cast<std::uint8_t>((count + 1) & 15);
        std::vector<std::uint8_t> body{0, 2};
        put(body, static_cast<std::int64_t>(header | count), 2);
        for (std::size_t i = 0; i < c->arguments.size(); ++i) {
            const auto type = c->arguments[i].type;
            put(body, i < values.size() ? values[i] : 0, type == ValueType::i16 || type == ValueType::u16 ? 2 : 4);
        }
        (void)tell(body);
    }
    void enable() {
        control(0x3E);
        control(0x3F);
        run(400ms);
        ASSERT_EQ(state(), 8);
    }
    [[nodiscard]] int state() { return drive().state_var() >> 8; }
    [[nodiscard]] int sub() { return drive().state_var() & 0xFF; }
    [[nodiscard]] double position() { return drive().actual(); }
    [[nodiscard]] double demand() { return drive().demand(); }
    std::string hand(const std::string& name, const Value& value) {
        Out out;
        return twin->set_hand(name, value, now, out);
    }
};

}  // namespace axisgate::linmot::test
