// For the tests of the twin's freedoms: the family's page, setups that differ from specimen 0 in what a test names, and a line on which
// bytes have instants (Bench of twin_bench.hpp takes whole acknowledgements alone).
#pragma once

#include <fstream>
#include <set>
#include <sstream>

#include "adapters/pacontrol/tests/twin_bench.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::pacontrol::twin::test {

inline const Catalogue& freedoms_page() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/pacontrol.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}

/// Specimen 0 but for these, which the page has to permit.
inline TwinSetup specimen_with(const FreedomValues& given, int axes = 2, std::map<std::string, std::string> options = {}) {
    TwinSetup s = setup(axes, std::move(options));
    s.freedoms = specimen_values(freedoms_page(), "0");
    s.seed = 7;
    for (const auto& [name, value] : given) {
        EXPECT_EQ(check_freedom(freedoms_page(), name, std::to_string(value)), "");
        s.freedoms[name] = value;
    }
    return s;
}

/// The twin with the common freedoms around it, as the gateway makes it.
class Wire {
public:
    explicit Wire(const TwinSetup& s) {
        twin_ = with_common_freedoms(make_twin(freedoms_page(), s), s);
        Out out;
        twin_->power_on({}, now, out);
        take(out);
    }

    struct Byte {
        Instant at;
        std::uint8_t value;
    };
    Instant now = time_zero + 1s;
    std::vector<Byte> bytes;  ///< everything that was sent, in order

    void send(const Bytes& b) {
        for_each_run(b, [&](const Frame& f) {
            Out out;
            twin_->on_frame(f, now, out);
            take(out);
        });
    }
    void ask(std::string_view text) { send(frame(text)); }
    void pass(Duration d) {
        for (const Instant end = now + d; now < end;) {
            now = std::min(end, std::max(now, twin_->deadline()));
            Out out;
            twin_->on_deadline(now, out);
            take(out);
        }
    }
    [[nodiscard]] std::string sent() const {
        std::string s;
        for (const Byte& b : bytes)
            s.push_back(static_cast<char>(b.value));
        return s;
    }
    /// Acknowledgements that ended: the instant of each last byte.
    [[nodiscard]] std::vector<Instant> ends() const {
        std::vector<Instant> all;
        for (const Byte& b : bytes) {
            if (b.value == 4) all.push_back(b.at);
        }
        return all;
    }
    [[nodiscard]] Twin& twin() { return *twin_; }

private:
    void take(const Out& out) {
        for (const auto& tx : out.frames) {
            for (const std::uint8_t value : tx.frame.data())
                bytes.push_back({tx.frame.at, value});
        }
    }
    std::unique_ptr<Twin> twin_;
};

}  // namespace axisgate::pacontrol::twin::test
