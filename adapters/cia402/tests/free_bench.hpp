// The bench of the simulated drive with a drive that makes use of its freedoms, by their names in the page.
#pragma once

#include <sstream>
#include <utility>

#include "adapters/cia402/tests/twin_bench.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::cia402_drive::twin::test {

inline const Catalogue& page() {
    static const Catalogue c = [] {
        std::vector<std::string> faults;
        std::ifstream in(AXISGATE_SOURCE_DIR "/schema/families/cia402.json");
        std::stringstream text;
        text << in.rdbuf();
        auto read = Catalogue::parse(text.str(), faults);
        if (!read) std::abort();
        return std::move(*read);
    }();
    return c;
}

struct FreeBench : Bench {
    using Frames = std::vector<std::pair<Instant, std::uint32_t>>;

    /// `values`: what differs from the drive of the manual.
    explicit FreeBench(const FreedomValues& values = {}, Options options = {}) : Bench(made(values, std::move(options))) {}
    static std::unique_ptr<Twin> made(const FreedomValues& values, Options options = {}) {
        TwinSetup setup;
        setup.address = "5";
        setup.kind = LineKind::can;
        setup.options = std::move(options);
        setup.freedoms = specimen_values(page(), "0");
        for (const auto& [name, value] : values) {
            EXPECT_EQ(check_freedom(page(), name, std::to_string(value)), "");
            setup.freedoms[name] = value;
        }
        setup.seed = 7;
        return with_common_freedoms(make_twin(setup, nullptr, page().freedoms()), setup);
    }

    std::string be(const std::string& freedom, std::int64_t value) { return twin->set_hand(freedom, Value{value}, now, out); }
    void nmt(canopen::NmtCommand command) { send(canopen::nmt_frame(command, node)); }
    /// In steps, so that each frame of the twin is at its instant.
    void run(Duration d) {
        using namespace std::chrono_literals;
        for (const Instant end = now + d; now < end;)
            pass(std::min<Duration>(1ms, end - now));
    }
    [[nodiscard]] std::vector<std::uint32_t> ids() const {
        std::vector<std::uint32_t> list;
        for (const auto& tx : out.frames)
            list.push_back(tx.frame.id);
        return list;
    }
    [[nodiscard]] double place() { return twin->mechanics(1, now).position; }
    [[nodiscard]] unsigned fault() { return static_cast<unsigned>(read(0x603F)) & 0xFFFFu; }

    void move_to(std::int64_t target) {
        ASSERT_EQ(write(0x607A, 0, target, 4), canopen::Abort::none);
        word(0x0F);
        word(0x1F);
    }
    /// Mode 8 with the target by RPDO 2 at each SYNC.
    void begin_stream() {
        ASSERT_EQ(write(0x1401, 2, 1, 1), canopen::Abort::none);
        ASSERT_EQ(write(0x1401, 1, 0x305, 4), canopen::Abort::none);
        nmt(canopen::NmtCommand::start);
        enable(8);
    }
    void sync() { send(canopen::data_frame(canopen::sync_id, {})); }
    void lead(std::int64_t target) {
        std::array<std::uint8_t, 4> bytes{};
        canopen::put_low_first(static_cast<std::uint64_t>(target), bytes);
        send(canopen::data_frame(0x305, bytes));
    }
};

}  // namespace axisgate::cia402_drive::twin::test
