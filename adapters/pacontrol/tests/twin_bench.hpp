// Bench for twin tests: one control on its serial port in virtual time, spoken to with the text between STX and ETX.
// In: texts such as "1900;5;0;0". Out: texts such as "0;1;1;0;0;1"; every reply's framing and check are verified here, by hand.
// Shares no packing code with the twin or the adapter.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/pacontrol/twin/device.hpp"
#include "adapters/pacontrol/twin/twin.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::pacontrol::twin::test {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

inline Bytes hex(std::string_view text) {
    Bytes bytes;
    std::istringstream in{std::string(text)};
    std::string word;
    while (in >> word)
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    return bytes;
}

/// A request frame with this check, or the right one.
inline Bytes frame(std::string_view text, std::string_view check = {}) {
    int x = 0;
    for (const char c : text)
        x ^= c;
    Bytes b{1, 2};
    b.insert(b.end(), text.begin(), text.end());
    b.push_back(3);
    const std::string digits = check.empty() ? std::to_string(x) : std::string(check);
    b.insert(b.end(), digits.begin(), digits.end());
    b.push_back(4);
    return b;
}

inline TwinSetup setup(int axes = 4, std::map<std::string, std::string> options = {}) {
    TwinSetup s;
    s.address = "com1";
    s.axes = axes;
    s.bit_rate = 9600;
    s.options = std::move(options);
    return s;
}

/// Fields of a reply.
struct Fields {
    int quit = -1, end = -1, status = -1, error = -1, type = -1;
    double data = 0;
    std::string text;
};

class Bench {
public:
    explicit Bench(const TwinSetup& s = setup(), const NonVolatile& memory = {}) {
        static const Catalogue catalogue;
        twin_ = make_twin(catalogue, s);
        Out out;
        twin_->power_on(memory, now, out);
        take(out);
    }

    Instant now = time_zero + 1s;
    std::vector<Bytes> raw;  ///< every reply as it was sent
    std::vector<Instant> when;

    Twin& twin() { return *twin_; }
    Control& control() { return static_cast<Device&>(*twin_).control(); }

    /// Bytes to the control; the texts of what it answered at once.
    std::vector<std::string> bytes(const Bytes& b) {
        const std::size_t before = texts_.size();
        for_each_run(b, [&](const Frame& f) {
            Out out;
            twin_->on_frame(f, now, out);
            take(out);
        });
        return {texts_.begin() + static_cast<std::ptrdiff_t>(before), texts_.end()};
    }
    std::string one(const std::vector<std::string>& texts, std::string_view what) {
        EXPECT_EQ(texts.size(), 1u) << what << " -> " << testing::PrintToString(texts);
        return texts.empty() ? "" : texts.back();
    }
    /// The one answer to a request, waited for up to 10 ms.
    std::string ask(std::string_view text) {
        const std::size_t before = texts_.size();
        bytes(frame(text));
        if (texts_.size() == before) pass(10ms);
        EXPECT_EQ(texts_.size(), before + 1) << text;
        return texts_.back();
    }
    std::string poll() { return one(bytes({4}), "poll"); }
    Fields get(std::string_view text) { return fields(ask(text)); }
    Fields get_poll() { return fields(poll()); }
    int quit(std::string_view text) { return get(text).quit; }
    double value(std::string_view text) { return get(text).data; }
    int status() { return static_cast<int>(value("190B;0;0;0")); }
    double position(int n) { return value("190C;" + std::to_string(n) + ";1;0"); }
    int axis_status(int n) { return static_cast<int>(value("1910;" + std::to_string(n) + ";0;0")); }
    void good(std::string_view text) { EXPECT_EQ(quit(text), 0) << text; }
    void online() {
        good("0603;0;0;0");
        ASSERT_EQ(status(), 31);
    }
    void home() {
        good("0A81;0;0;0");
        for (int i = 0; i < 200 && status() != 1; ++i)
            pass(50ms);
        ASSERT_EQ(status(), 1);
    }
    /// Until axis n stands.
    void stand(int n) {
        for (int i = 0; i < 4000 && control().axis(n).running(); ++i)
            pass(50ms);
        ASSERT_FALSE(control().axis(n).running());
    }

    void pass(Duration d) {
        const Instant end = now + d;
        for (int i = 0; i < 100000 && twin_->deadline() <= end; ++i) {
            EXPECT_GE(twin_->deadline(), now);
            now = std::max(now, twin_->deadline());
            Out out;
            twin_->on_deadline(now, out);
            take(out);
        }
        now = end;
        Out out;
        twin_->on_deadline(now, out);
        take(out);
    }
    void hand(const std::string& name, const Value& value) {
        Out out;
        EXPECT_EQ(twin_->set_hand(name, value, now, out), "") << name;
        take(out);
    }
    std::string refused(const std::string& name, const Value& value) {
        Out out;
        const std::string fault = twin_->set_hand(name, value, now, out);
        EXPECT_NE(fault, "") << name;
        take(out);
        return fault;
    }

    static Fields fields(const std::string& text) {
        Fields f;
        f.text = text;
        std::istringstream in(text);
        char c = 0;
        in >> f.quit >> c >> f.end >> c >> f.status >> c >> f.error >> c >> f.type >> c >> f.data;
        EXPECT_FALSE(in.fail()) << text;
        return f;
    }

private:
    void take(const Out& out) {
        EXPECT_TRUE(out.samples.empty() && out.results.empty() && out.feedback.empty());
        for (const auto& tx : out.frames) {
            const auto b = tx.frame.data();
            raw.emplace_back(b.begin(), b.end());
            when.push_back(tx.frame.at);
            // SOH STX text ETX check EOT; check = XOR of text and ETX.
            EXPECT_TRUE(b.size() > 6 && b[0] == 1 && b[1] == 2 && b.back() == 4);
            std::string text, check;
            std::size_t i = 2;
            int x = 3;
            for (; i < b.size() && b[i] != 3; ++i) {
                text.push_back(static_cast<char>(b[i]));
                x ^= b[i];
            }
            for (++i; i + 1 < b.size(); ++i)
                check.push_back(static_cast<char>(b[i]));
            if (check_replies) EXPECT_EQ(check, std::to_string(x)) << text;
            texts_.push_back(text);
        }
    }

public:
    bool check_replies = true;

private:
    std::unique_ptr<Twin> twin_;
    std::vector<std::string> texts_;
};

}  // namespace axisgate::pacontrol::twin::test
