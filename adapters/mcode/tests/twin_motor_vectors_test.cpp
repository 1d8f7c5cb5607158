// Plays vectors.txt against the whole twin: language, motor and link together.
// In: transcripts, sample programs and byte cases of the reference. Out: one test per case.
// The head of vectors.txt explains the form.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "adapters/mcode/twin/device.hpp"

namespace axisgate::mcode::twin::test {
namespace {

using std::chrono::milliseconds;

struct Case {
    std::string kind;
    std::string name;
    std::vector<std::string> lines;
};

std::vector<Case> cases() {
    std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/adapters/mcode/vectors.txt");
    std::vector<Case> all;
    std::string line;
    bool open = false;
    while (std::getline(file, line)) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words(line);
        std::string first, second;
        words >> first >> second;
        if (first == "transcript" || first == "program" || first == "bytes") {
            all.push_back({first, second, {}});
            open = true;
        } else if (first == "checksum") {
            open = false;
        } else if (open) {
            all.back().lines.push_back(line);
        }
    }
    return all;
}

class Player {
public:
    explicit Player(const Case& c) : case_(c) {}

    void play() {
        power({});
        for (const std::string& line : case_.lines) {
            SCOPED_TRACE(line);
            const std::size_t space = line.find(' ');
            const std::string key = line.substr(0, space);
            std::string rest = space == std::string::npos ? "" : line.substr(space + 1);
            // Printed without its blank in one listing [L7052]; the language needs it.
            if (key == "|" && rest == "PG1") rest = "PG 1";
            if (key == "product") {
                power(rest);
            } else if (key == ">" || key == "|") {
                settle_line();
                if (case_.kind == "bytes") {
                    send(bytes(rest));
                } else {
                    send(rest + "\r");
                    asked_ = true;
                    take(rest);
                }
            } else if (key == "|!") {
                settle_line();
                const std::size_t gap = rest.find(' ');
                send(rest.substr(gap + 1) + "\r");
                asked_ = true;
                take(rest.substr(gap + 1));
                failed(rest.substr(0, gap));
            } else if (key == "<") {
                if (case_.kind == "bytes") {
                    pass(milliseconds(20));
                    EXPECT_EQ(hex(sent_), rest == "none" ? "" : rest);
                    sent_.clear();
                } else {
                    EXPECT_EQ(next_data(), rest);
                }
            } else if (key == "<~") {
                const std::string got = next_data();
                EXPECT_TRUE(std::regex_match(got, std::regex(rest))) << got;
            } else if (key == "error") {
                failed(rest);
            } else if (key == "wait") {
                pass(milliseconds(std::stoll(rest)));
                take("");
            } else if (key == "byte") {
                settle_line();
                send(bytes(rest));
                pass(milliseconds(5));
                take("");
            } else if (key == "hand") {
                settle_line();
                const std::size_t gap = rest.find(' ');
                hand(rest.substr(0, gap), Value{std::stod(rest.substr(gap + 1))});
            } else if (key == "active") {
                settle_line();
                hand("active_inputs", Value{std::int64_t{std::stoll(rest)}});
            } else if (key == "level") {
                settle_line();
                hand("inputs", Value{std::int64_t{std::stoll(rest)}});
            } else if (key == "link") {
                std::istringstream in(rest);
                int em = 0, py = 0, ck = 0;
                in >> em >> py >> ck;
                link(em, py, ck);
            } else if (key != "erratum") {
                ADD_FAILURE() << "unknown line";
            }
            if (::testing::Test::HasFailure()) return;
        }
        settle_line();
    }

private:
    void power(const std::string& product) {
        DeviceSetup d;
        MechanismSetup m;
        d.product = m.product = product == "LMM" ? lmm : product == "LMDO" ? lmdo : lmdc;
        device_ = std::make_unique<Device>(d, make_mechanism(m));
        now_ += std::chrono::seconds(1);
        device_->power_on({}, now_, out_);
        collect();
        hand("active_inputs", Value{std::int64_t{0}});
    }
    void link(int em, int py, int ck) {
        if (py != 0) send("DN=\"a\"\r");
        send("EM=" + std::to_string(em) + "\r");
        if (ck != 0) send("CK=" + std::to_string(ck) + "\r");
        const std::string party = "PY=1";
        if (py != 0) {
            int sum = 0;
            for (const char c : party)
                sum += c;
            send(ck != 0 ? party + static_cast<char>((-sum & 0x7F) | 0x80) + "\r" : party + "\r");
            send("\n");
        }
        sent_.clear();
    }
    void send(std::string_view text) {
        Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        f.at = now_;
        device_->on_frame(f, now_, out_);
        collect();
        pass(milliseconds(5));
    }
    void pass(Duration d) {
        const Instant end = now_ + d;
        while (device_->deadline() <= end) {
            now_ = std::max(now_, device_->deadline());
            device_->on_deadline(now_, out_);
            collect();
        }
        now_ = end;
    }
    void hand(const std::string& name, const Value& v) {
        EXPECT_EQ(device_->set_hand(name, v, now_, out_), "");
        collect();
    }
    void collect() {
        for (const auto& tx : out_.frames)
            sent_.append(reinterpret_cast<const char*>(tx.frame.storage.data()), tx.frame.size);
        out_.clear();
    }
    /// What came becomes lines of data; echo and prompt are taken off.
    void take(const std::string& echo) {
        std::string text;
        text.swap(sent_);
        std::vector<std::string> lines;
        std::string line;
        for (const char c : text) {
            if (c == '\r') continue;
            if (c == '\n') {
                lines.push_back(line);
                line.clear();
            } else {
                line += c;
            }
        }
        if (line == ">" || line == "?") {
            prompt_ = line[0];
            line.clear();
        } else if (!line.empty()) {
            data_.push_back(line);
        }
        for (std::string& l : lines) {
            // Output of a program may stand behind a prompt.
            if (!l.empty() && (l[0] == '>' || l[0] == '?')) {
                prompt_ = l[0];
                l.erase(0, 1);
            }
            if (!echo_taken_ && asked_ && l == echo) {
                echo_taken_ = true;
                continue;
            }
            if (!l.empty()) data_.push_back(l);
        }
        echo_taken_ = false;
    }
    std::string next_data() {
        if (data_.empty()) return "(nothing came)";
        const std::string first = data_.front();
        data_.erase(data_.begin());
        return first;
    }
    void failed(const std::string& code) {
        EXPECT_EQ(prompt_, '?');
        asked_ = false;
        send("PR ER\r");
        asked_ = true;
        take("PR ER");
        asked_ = false;
        EXPECT_EQ(next_data(), code);
        EXPECT_EQ(prompt_, '>');
    }
    void settle_line() {
        if (case_.kind == "bytes") return;
        take("");
        if (asked_) EXPECT_EQ(prompt_, '>');
        asked_ = false;
        EXPECT_EQ(data_, std::vector<std::string>{});
    }
    static std::string bytes(const std::string& pairs) {
        std::istringstream in(pairs);
        std::string out, pair;
        while (in >> pair)
            out += static_cast<char>(std::strtol(pair.c_str(), nullptr, 16));
        return out;
    }
    static std::string hex(const std::string& s) {
        std::string out;
        for (const char c : s) {
            char pair[4];
            std::snprintf(pair, sizeof pair, "%02X", static_cast<unsigned char>(c));
            out += (out.empty() ? "" : " ") + std::string(pair);
        }
        return out;
    }

    const Case& case_;
    std::unique_ptr<Device> device_;
    Instant now_{};
    Out out_;
    std::string sent_;
    std::vector<std::string> data_;
    char prompt_ = '>';
    bool asked_ = false;
    bool echo_taken_ = false;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.kind << ' ' << c.name; }

class McodeVectors : public ::testing::TestWithParam<Case> {};

TEST_P(McodeVectors, Play) { Player(GetParam()).play(); }

INSTANTIATE_TEST_SUITE_P(All, McodeVectors, ::testing::ValuesIn(cases()),
                         [](const auto& row) { return row.param.kind + "_" + row.param.name; });

}  // namespace
}  // namespace axisgate::mcode::twin::test
